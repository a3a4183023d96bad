#include <sixdof/generation/work_profile.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <random>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/work_sample.h>

namespace sixdof {
namespace {

constexpr int k_part_bits = std::countr_zero(WorkHistogram::k_parts);

/// Rotations measured again at most, and how often: a time that an interruption made long is not met twice.
constexpr std::size_t k_most_again = 16;
constexpr int k_passes = 3;

/// Axes turned onto axes: entries of a rotation made of sines and cosines of right angles are off by this at most.
constexpr double k_aligned = 1e-12;

bool aligns_axes(const Eigen::Vector4d& rotation) {
  const Eigen::Quaterniond q(rotation[0], rotation[1], rotation[2], rotation[3]);
  return q.toRotationMatrix().cwiseAbs().maxCoeff() > 1.0 - k_aligned;
}

struct Ray {
  double seconds = 0.0;
  std::uint64_t work = 0;
};

/// The rays of one rotation.
struct RotationProfile {
  WorkHistogram work;
  std::uint64_t worst_work = 0;
  ProfilePlace worst;
  std::vector<std::uint64_t> reachable;
  std::vector<Ray> rays;  ///< Of each direction.
};

RotationProfile profile_rotation(RaySolver& solver, const Grid& grid, std::span<const double> targets,
                                 std::uint32_t rotation, const std::function<bool()>& cancelled) {
  RotationProfile profile;
  profile.reachable.resize(targets.size());
  profile.rays.resize(grid.directions.size());
  std::vector<double> translations(targets.size()), residuals(targets.size());
  solver.set_rotation(grid.rotations[rotation]);
  for (std::uint32_t u = 0; u < grid.directions.size(); ++u) {
    if (cancelled && cancelled()) throw Interrupted("interrupted");
    const double start = thread_seconds();
    solver.solve(grid.directions[u], targets, translations, residuals);
    Ray& ray = profile.rays[u];
    ray.seconds = thread_seconds() - start;
    for (std::uint32_t k = 0; k < targets.size(); ++k) {
      const std::uint64_t work = solver.work()[k];
      if (work != 0) profile.work.add(work);
      ray.work += work;
      if (work > profile.worst_work) {
        profile.worst_work = work;
        profile.worst = {rotation, u, k};
      }
      profile.reachable[k] += std::isnan(translations[k]) ? 0 : 1;
    }
  }
  return profile;
}

/// The element that `share` of all do not exceed.
double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

/// Times of all rays, by rotation.
class RayTimes {
 public:
  explicit RayTimes(std::vector<std::vector<Ray>> rays) : rays_(std::move(rays)) {}

  struct Longest {
    double seconds = 0.0;
    std::size_t rotation = 0, direction = 0;
  };
  Longest longest() const {
    Longest longest;
    for (std::size_t r = 0; r < rays_.size(); ++r) {
      for (std::size_t u = 0; u < rays_[r].size(); ++u) {
        if (rays_[r][u].seconds > longest.seconds) longest = {rays_[r][u].seconds, r, u};
      }
    }
    return longest;
  }
  /// The least counts.
  void measured_again(std::size_t rotation, const std::vector<Ray>& again) {
    for (std::size_t u = 0; u < again.size(); ++u) {
      rays_[rotation][u].seconds = std::min(rays_[rotation][u].seconds, again[u].seconds);
    }
  }
  void summarize(WorkProfile& profile) const {
    std::vector<double> seconds, per_unit;
    for (const auto& of_rotation : rays_) {
      for (const Ray& ray : of_rotation) {
        seconds.push_back(ray.seconds);
        if (ray.work != 0) per_unit.push_back(ray.seconds / static_cast<double>(ray.work));
      }
    }
    constexpr double k_nearly_all = 0.999;
    profile.median_ray_s = quantile(seconds, 0.5);
    profile.p999_ray_s = quantile(seconds, k_nearly_all);
    if (per_unit.empty()) return;
    profile.median_unit_s = quantile(per_unit, 0.5);
    profile.least_unit_s = quantile(per_unit, 1.0 - k_nearly_all);
    profile.most_unit_s = quantile(per_unit, k_nearly_all);
  }

 private:
  std::vector<std::vector<Ray>> rays_;
};

}  // namespace

std::size_t WorkHistogram::bin(std::uint64_t value) {
  if (value < k_parts) return value;
  const int shift = static_cast<int>(std::bit_width(value)) - 1 - k_part_bits;
  return k_parts * static_cast<std::size_t>(shift) + (value >> shift);
}

std::uint64_t WorkHistogram::least_of(std::size_t bin) {
  if (bin < k_parts) return bin;
  const std::size_t shift = bin / k_parts - 1;
  return (k_parts + bin % k_parts) << shift;
}

void WorkHistogram::add(const WorkHistogram& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

std::uint64_t WorkHistogram::count() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counts_) sum += count;
  return sum;
}

std::uint64_t WorkHistogram::quantile(double share) const {
  const double wanted = share * static_cast<double>(count());
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    sum += counts_[i];
    if (counts_[i] != 0 && static_cast<double>(sum) >= wanted) return least_of(i);
  }
  return 0;
}

ProfileRotations::ProfileRotations(const Grid& grid, std::size_t others, std::uint64_t seed) {
  std::vector<std::uint32_t> rest;
  for (const std::uint32_t r : DistinctRotations(grid.rotations).first) {
    (aligns_axes(grid.rotations[r]) ? indices : rest).push_back(r);
  }
  aligned = indices.size();
  // Fisher and Yates, as far as needed. Plain modulo: the same on every standard library; its bias is nothing.
  std::mt19937_64 random(seed);
  others = std::min(others, rest.size());
  for (std::size_t i = 0; i < others; ++i) std::swap(rest[i], rest[i + random() % (rest.size() - i)]);
  indices.insert(indices.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(others));
  std::ranges::sort(indices);
}

WorkProfile profile_work(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                         std::span<const double> targets, std::span<const std::uint32_t> rotations,
                         const ProfileOptions& options) {
  if (rotations.empty() || targets.empty()) throw BadArgument("no configuration to profile");
  WorkProfile profile;
  profile.reachable.resize(targets.size());
  std::vector<std::vector<Ray>> rays(rotations.size());
  std::vector<std::pair<std::uint64_t, ProfilePlace>> worst(rotations.size());
  std::mutex mutex;
  std::uint64_t done = 0;
  parallel::PerThread<std::unique_ptr<RaySolver>> solvers(prepare);
  const auto solve_rotation = [&](std::size_t i) {
    RotationProfile made = profile_rotation(*solvers.local(), grid, targets, rotations[i], options.cancelled);
    rays[i] = std::move(made.rays);
    worst[i] = {made.worst_work, made.worst};
    const std::scoped_lock lock(mutex);
    profile.work.add(made.work);
    for (std::size_t k = 0; k < targets.size(); ++k) profile.reachable[k] += made.reachable[k];
    if (options.progress) options.progress(++done, rotations.size());
  };
  parallel::with_threads(options.threads, [&] { parallel::for_each(rotations.size(), solve_rotation); });
  for (const auto& [work, place] : worst) {
    if (work <= profile.worst_work) continue;
    profile.worst_work = work;
    profile.worst = place;
  }

  RayTimes times(std::move(rays));
  std::set<std::size_t> again;
  RayTimes::Longest longest = times.longest();
  const auto solver = prepare();
  while (again.size() < k_most_again && again.insert(longest.rotation).second) {
    for (int pass = 0; pass < k_passes; ++pass) {
      times.measured_again(longest.rotation,
                           profile_rotation(*solver, grid, targets, rotations[longest.rotation], options.cancelled).rays);
    }
    longest = times.longest();
  }
  profile.worst_ray_s = longest.seconds;
  profile.worst_ray = {rotations[longest.rotation], static_cast<std::uint32_t>(longest.direction), 0};
  times.summarize(profile);
  return profile;
}

}  // namespace sixdof
