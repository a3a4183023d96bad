#include "bench/harness/coarse_set.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/generation/volume_generator.h>
#include "bench/common/interrupt.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"

namespace sixdof::bench {
namespace {

namespace fs = std::filesystem;

/// Uniform rotations and directions: no two configurations are equal, as they are on small grids of Euler angles.
constexpr const char* k_distance_grid = "so3:64:16";
/// As many, so that a p99.9 over the volumes has its 2,000 configurations; fewer for large meshes, whose volumes take
/// milliseconds each.
constexpr const char* k_volume_grid = "so3:64:16";
constexpr const char* k_large_volume_grid = "so3:32:8";
constexpr std::size_t k_large_triangles = 400'000;  ///< Of both.
constexpr double k_distances[] = {0, 1, 5, 10, 20};
constexpr double k_volumes[] = {1, 5, 10};  ///< In percent of the smaller body.

const char* volume_grid(const Mesh& a, const Mesh& b) {
  return a.triangles().size() + b.triangles().size() > k_large_triangles ? k_large_volume_grid : k_volume_grid;
}

bool are_solids(const Mesh& a, const Mesh& b) { return a.solid() && b.solid(); }

/// The volumes in percent of A, in which buckets are named, with six significant digits.
std::vector<double> volume_percents(const Mesh& a, const Mesh& b) {
  std::vector<double> percents;
  const double smaller = std::min(1.0, b.volume() / a.volume());
  for (const double percent : k_volumes) percents.push_back(std::stod(fmt::format("{:.6g}", percent * smaller)));
  return percents;
}

/// Everything that the content of the set depends on.
std::string cache_key(const DistanceGenerator& generator, const Mesh& a, const Mesh& b) {
  return fmt::format(
      "sixdof {}, {} {}, {} with {}, distances {} on {}, volumes {} on {}", SIXDOF_VERSION, generator.oracle_name(),
      generator.oracle_version(), a.hash(), b.hash(), fmt::join(k_distances, ","), k_distance_grid,
      are_solids(a, b) ? fmt::format("{}", fmt::join(volume_percents(a, b), ",")) : "none", volume_grid(a, b));
}

/// A new folder that nobody else can read or write.
fs::path private_folder() {
  std::string name = (fs::temp_directory_path() / "sixdof-coarse-set-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw BadFile(name, fmt::format("cannot be made: {}", std::strerror(errno)));
  }
  return name;
}

void remove_folder_of(const fs::path& file) {
  std::error_code ignored;
  fs::remove_all(file.parent_path(), ignored);
}

/// Whether the file is the whole set, with every value undamaged.
bool is_whole(const fs::path& file, const Mesh& a, const Mesh& b) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  try {
    const ConfigurationSet set(file);
    set.check_meshes(a, b);
    for (const BucketKey key : CoarseSet::buckets(a, b)) static_cast<void>(set.read(key));
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Says so if the pair has no volumes.
bool has_volumes(const Mesh& a, const Mesh& b, std::string_view program) {
  for (const Mesh* mesh : {&a, &b}) {
    if (mesh->solid()) continue;
    print_message(program, fmt::format("no volumes: {} is no solid ({})", mesh->name(), mesh->why_not_solid()));
    return false;
  }
  return true;
}

void make(const fs::path& file, const DistanceGenerator& generator, const Mesh& a, const Mesh& b,
          const SetDescription& description, std::string_view program) {
  ConfigurationSetWriter writer(file, description);
  const auto sweep = [&](BucketKind kind, const auto& generate, std::span<const double> percents) {
    ProgressLine line(fmt::format("coarse set, {}s", to_string(kind)));
    const Generated made =
        generate(generator, a, b, description.grid_of(kind), percents,
                 RunOptions{.progress = [&](std::uint64_t done, std::uint64_t total) { line.show(done, total); },
                            .cancelled = InterruptGuard::requested},
                 {});
    for (const Bucket& bucket : made.buckets) writer.write(bucket.summary, bucket.translations);
  };
  sweep(BucketKind::distance, generate_distances, k_distances);
  if (description.volume_grid) {
    try {
      sweep(BucketKind::volume, generate_volumes, volume_percents(a, b));
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& e) {  // e.g. of surfaces that intersect themselves
      print_message(program, fmt::format("no volumes: {}", e.what()));
    }
  }
  writer.commit();
}

}  // namespace

std::vector<BucketKey> CoarseSet::buckets(const Mesh& a, const Mesh& b) {
  std::vector<BucketKey> keys;
  for (const double percent : k_distances) keys.push_back({BucketKind::distance, percent});
  if (!are_solids(a, b)) return keys;
  for (const double percent : volume_percents(a, b)) keys.push_back({BucketKind::volume, percent});
  return keys;
}

CoarseSet::CoarseSet(const Mesh& a, const MeshIdentity& a_identity, const Mesh& b, const MeshIdentity& b_identity,
                     std::string_view program) {
  const std::unique_ptr<DistanceGenerator> generator = make_ray_cast();
  SetDescription description{
      .generator_version = SIXDOF_VERSION, .a = a_identity, .b = b_identity, .grid = make_grid(k_distance_grid)};
  if (has_volumes(a, b, program)) description.volume_grid = make_grid(volume_grid(a, b));
  file_ = writable_cache_file("coarse-set", cache_key(*generator, a, b));
  const std::string pair = fmt::format("coarse set of {} with {}", a.name(), b.name());
  if (is_whole(file_, a, b)) {
    print_message(program, fmt::format("{}: {}", pair, file_.string()));
    return;
  }
  temporary_ = file_.empty();
  if (temporary_) file_ = private_folder() / "set.h5";
  const auto start = std::chrono::steady_clock::now();
  try {
    make(file_, *generator, a, b, description, program);
  } catch (...) {
    if (temporary_) remove_folder_of(file_);
    throw;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_message(
      program, fmt::format("{} made in {:.1f} s{}", pair, seconds, temporary_ ? std::string() : ": " + file_.string()));
}

CoarseSet::~CoarseSet() {
  if (temporary_) remove_folder_of(file_);
}

}  // namespace sixdof::bench
