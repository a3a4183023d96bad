#include <sixdof/configuration/volume_generator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/overlap_march.h>
#include <sixdof/configuration/rotation_sweep.h>
#include <sixdof/configuration/slope_bounds.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

const Mesh& solid_mesh(const Mesh& mesh) {
  if (mesh.solid()) return mesh;
  throw BadMesh(fmt::format("{}: an overlap volume needs a solid: {}", mesh.name(), mesh.why_not_solid()));
}

}  // namespace

/// What all threads share of a pair.
struct detail::VolumePair {
  VolumePair(const Mesh& mesh_a, const Mesh& mesh_b)
      : a(solid_mesh(mesh_a)), b(solid_mesh(mesh_b)), tree_a(a), solid_a(a, tree_a), areas_a(area_vectors(a)) {
    if (a.hash() == b.hash()) return;
    tree_b.emplace(b);
    solid_b.emplace(b, *tree_b);
    areas_b = area_vectors(b);
  }

  const Mesh& a;
  const Mesh& b;
  Tree tree_a;
  Solid solid_a;
  std::vector<Eigen::Vector3d> areas_a;
  // Absent for copies of one mesh.
  std::optional<Tree> tree_b;
  std::optional<Solid> solid_b;
  std::vector<Eigen::Vector3d> areas_b;
};

namespace {

using detail::VolumePair;

class VolumeSolver final : public RaySolver {
 public:
  VolumeSolver(const VolumePair& pair, std::unique_ptr<RaySolver> touching)
      : pair_(pair),
        touching_(std::move(touching)),
        query_(pair.solid_a, pair.solid_b ? *pair.solid_b : pair.solid_a),
        touching_aim_(distance_bucket(pair.a, 0).aim) {}

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(pair_.a, pair_.b, rotation);
    touching_->set_rotation(rotation);
  }

  void solve(const Eigen::Vector3d& direction, std::span<const double> aims, std::span<double> travel,
             std::span<double> residuals) override {
    ray_.direction = direction;
    std::ranges::fill(travel, std::numeric_limits<double>::quiet_NaN());
    std::ranges::fill(residuals, 0.0);
    double contact = 0.0, contact_residual = 0.0;
    touching_->solve(direction, {&touching_aim_, 1}, {&contact, 1}, {&contact_residual, 1});
    if (std::isnan(contact)) return;  // Surfaces that never touch enclose nothing together: B comes from outside.
    std::size_t k = 0;
    for (; k < aims.size() && aims[k] == 0.0; ++k) travel[k] = contact;
    // Nothing overlaps by more than the smaller body.
    const double most = std::min(pair_.a.volume(), pair_.b.volume());
    if (k == aims.size() || aims[k] > most) return;

    const ReachTable& reach_a = reach_of_a(direction);
    const ReachTable reach_b(pair_.b, pair_.solid_b ? pair_.areas_b : pair_.areas_a, -(ray_.R.transpose() * direction));
    const auto measure = [&](double s) {
      const Overlap overlap = query_.evaluate(ray_.pose(s));
      return OverlapSample{.s = s, .volume = overlap.volume, .slope = -overlap.area.dot(direction)};
    };
    OverlapMarch march(
        measure, [&](double s) { return SlopeBounds::at(reach_a, reach_b, reach_a.front() + reach_b.front() - s); },
        contact,
        {.resolution = k_first_overlap_resolution * std::min(pair_.a.diagonal(), pair_.b.diagonal()),
         .tolerance = k_volume_tolerance * pair_.a.volume()});
    for (; k < aims.size() && aims[k] <= most; ++k) {
      const std::optional<OverlapSample> hit = march.advance(aims[k]);
      if (!hit) break;
      travel[k] = hit->s;
      residuals[k] = std::abs(hit->volume - aims[k]);
    }
    measurements_ += static_cast<std::uint64_t>(march.measurements());
  }

  std::uint64_t measurements() const override { return measurements_; }

 private:
  /// Directions come again with every rotation.
  const ReachTable& reach_of_a(const Eigen::Vector3d& u) {
    const auto [place, fresh] = reach_of_a_.try_emplace({u.x(), u.y(), u.z()});
    if (fresh) place->second = ReachTable(pair_.a, pair_.areas_a, u);
    return place->second;
  }

  const VolumePair& pair_;
  std::unique_ptr<RaySolver> touching_;
  OverlapQuery query_;
  double touching_aim_;
  ConfigurationRay ray_;
  std::map<std::array<double, 3>, ReachTable> reach_of_a_;
  std::uint64_t measurements_ = 0;
};

}  // namespace

VolumeGenerator::VolumeGenerator(const DistanceGenerator& touching, const Mesh& a, const Mesh& b)
    : touching_(touching), oracle_version_(SIXDOF_VERSION), pair_(std::make_unique<const VolumePair>(a, b)) {}

VolumeGenerator::~VolumeGenerator() = default;

std::unique_ptr<RaySolver> VolumeGenerator::prepare() const {
  return std::make_unique<VolumeSolver>(*pair_, touching_.prepare(pair_->a, pair_->b));
}

BucketSummary volume_bucket(const Mesh& a, int percent) {
  if (percent < 0 || percent > BucketKey::k_max_percent) {
    throw BadArgument(fmt::format("volume {} %: not in 0 .. {}", percent, BucketKey::k_max_percent));
  }
  BucketSummary bucket;
  bucket.key = {BucketKind::volume, percent};
  bucket.target = a.volume() * static_cast<double>(percent) / 100.0;
  bucket.aim = bucket.target;
  bucket.tolerance = k_volume_tolerance * a.volume();
  return bucket;
}

Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const int> percents, const GenerateOptions& options) {
  Generated result;
  for (const int percent : percents) result.buckets.push_back({.summary = volume_bucket(a, percent), .travel = {}});
  // From contact inwards: a ray meets them in this order.
  detail::order_buckets(result.buckets, false, detail::rotations_asked(grid, options) * grid.directions.size());
  const VolumeGenerator generator(touching, a, b);
  result.measurements = detail::sweep_rotations([&] { return generator.prepare(); }, grid, result.buckets, options);
  for (GeneratedBucket& bucket : result.buckets) {
    const bool contact = bucket.summary.key.percent == 0;
    bucket.summary.oracle = contact ? touching.oracle_name() : generator.oracle_name();
    bucket.summary.oracle_version = contact ? touching.oracle_version() : generator.oracle_version();
  }
  std::ranges::sort(result.buckets, {}, [&](const GeneratedBucket& bucket) {
    return std::ranges::find(percents, bucket.summary.key.percent) - percents.begin();
  });
  return result;
}

}  // namespace sixdof
