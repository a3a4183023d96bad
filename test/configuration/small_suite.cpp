#include "small_suite.h"

#include <unistd.h>

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include <sixdof/algorithm/fcl/fcl.h>
#include <sixdof/base/atomic_file.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/generation/volume_generator.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof::test {
namespace {

/// In units of A's diagonal: far below the tolerance of the harness, far above rounding.
constexpr double k_tolerance = 1e-10;
constexpr int k_most_steps = 300;

/// The first translation from outside at which B has the distance `target`, by conservative advancement. NaN if that
/// does not converge (a grazing ray).
double solve(Query& query, const Mesh& a, const Mesh& b, const Eigen::Vector3d& u, const Eigen::Vector4d& q,
             double target) {
  double s = a.diagonal() + b.diagonal();
  for (int step = 0; step < k_most_steps; ++step) {
    const double remaining = query.distance(ConfigurationRay(a, b, q, u).pose(s)).value.distance - target;
    if (std::abs(remaining) <= k_tolerance * a.diagonal()) return s;
    s -= remaining;
    if (s < 0.0) break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void make_set(const std::filesystem::path& file, const std::string& name_a, const std::string& name_b) {
  const Mesh a = load_model(name_a);
  const Mesh b = load_model(name_b);
  SetDescription description{
      .generator_version = "test", .a = MeshIdentity::of(a), .b = MeshIdentity::of(b), .grid = make_grid("90")};
  const Grid grid = description.grid;
  ConfigurationSetWriter writer(file, std::move(description));
  const auto algorithm = make_fcl_obbrss_algorithm();
  const auto query = algorithm->prepare(a, b, algorithm->settings());
  const auto write = [&](BucketKey key, double nominal, double target, auto translation_of) {
    std::vector<double> translations;
    for (const auto& q : grid.rotations) {
      for (const auto& u : grid.directions) translations.push_back(translation_of(u, q));
    }
    writer.write({.key = key,
                  .nominal = nominal,
                  .target = target,
                  .tolerance = k_tolerance * a.diagonal(),
                  .largest_residual = k_tolerance * a.diagonal(),
                  .oracle = "fcl-obbrss",
                  .oracle_version = algorithm->traits().version},
                 translations);
  };
  // Bucket 0 is solved for a distance just outside contact.
  const double contact = 2 * k_tolerance * a.diagonal();
  const double apart = 0.05 * a.diagonal();
  write({BucketKind::distance, 0}, 0.0, contact,
        [&](const auto& u, const auto& q) { return solve(*query, a, b, u, q, contact); });
  write({BucketKind::distance, 5}, apart, apart,
        [&](const auto& u, const auto& q) { return solve(*query, a, b, u, q, apart); });
  const std::vector<double> volumes{3};
  const Generated overlapping = generate_volumes(*make_ray_cast(), a, b, grid, volumes);
  for (const Bucket& bucket : overlapping.buckets) writer.write(bucket.summary, bucket.translations);
  writer.commit();
}

}  // namespace

const std::vector<std::string>& SmallSuite::buckets() {
  static const std::vector<std::string> list = {"distance/00", "distance/05", "volume/03"};
  return list;
}

void SmallSuite::make(const std::filesystem::path& directory) {
  nlohmann::json sets = nlohmann::json::array();
  const auto add = [&](const std::string& pair, const std::string& a, const std::string& b) {
    make_set(directory / (pair + ".h5"), a, b);
    sets.push_back({{"pair", pair}, {"file", pair + ".h5"}, {"buckets", buckets()}});
    sets.back()["a"]["name"] = a;
    sets.back()["b"]["name"] = b;
  };
  add("torus-1k", "torus-1k", "torus-1k");
  add("torus-1k-cone-1k", "torus-1k", "cone-1k");
  write_file_atomically(directory / "manifest.json", nlohmann::json{{"sets", sets}}.dump(2));
}

SuiteCopy::SuiteCopy(const std::filesystem::path& original) {
  static int counter = 0;
  directory_ = std::filesystem::temp_directory_path() /
               ("sixdof-suite-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
  std::filesystem::create_directory(directory_);
  std::filesystem::copy(original, directory_, std::filesystem::copy_options::recursive);
}

SuiteCopy::~SuiteCopy() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

}  // namespace sixdof::test
