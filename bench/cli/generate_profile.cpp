#include "bench/cli/generate_profile.h"

#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/cli/generate_plan.h"
#include "bench/cli/interrupt.h"
#include "bench/cli/progress_line.h"
#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_profile.h>

namespace sixdof::cli {
namespace {

void print_line(const char* what, const std::string& text) { fmt::print("  {:<24} {}\n", what, text); }

std::string place(const ProfilePlace& at) {
  return fmt::format("rotation {}, direction {}", at.rotation, at.direction);
}

void print_kind(BucketKind kind, const GenerationWork& work, const ProfileRequest& request) {
  const Grid& grid = work.set.grid_of(kind);
  const std::vector<BucketSummary> buckets = buckets_in_order(work.job, kind);
  std::vector<double> targets;
  for (const BucketSummary& bucket : buckets) targets.push_back(bucket.target);
  const ProfileRotations rotations(grid, request.rotations.value_or(std::numeric_limits<std::size_t>::max()),
                                   request.seed);
  std::optional<VolumeGenerator> volumes;
  if (kind == BucketKind::volume) volumes.emplace(work.generator, work.a, work.b);
  WorkProfile profile;
  {
    ProgressLine line(fmt::format("{} rotations", to_string(kind)), work.progress);
    profile = profile_work([&] { return volumes ? volumes->prepare() : work.generator.prepare(work.a, work.b); }, grid,
                           targets, rotations.indices,
                           {.threads = work.threads,
                            .progress = [&](std::uint64_t done, std::uint64_t total) { line.show(done, total); },
                            .cancelled = [] { return InterruptGuard::requested(); }});
  }
  const std::size_t rays = rotations.indices.size() * grid.directions.size();
  fmt::print("{}s: grid {}, {} directions x {} rotations ({} that turn an axis onto an axis), {} buckets\n",
             to_string(kind), grid.spec, grid.directions.size(), rotations.indices.size(), rotations.aligned,
             buckets.size());
  std::uint64_t reachable = 0;
  std::vector<std::string> unreachable;
  for (std::size_t k = 0; k < buckets.size(); ++k) {
    reachable += profile.reachable[k];
    if (profile.reachable[k] == rays) continue;
    unreachable.push_back(fmt::format("{} {}", buckets[k].key.name(), rays - profile.reachable[k]));
  }
  print_line("configurations", fmt::format("{}, of which {} reachable and {} without work", rays * buckets.size(),
                                           reachable, rays * buckets.size() - profile.work.count()));
  if (!unreachable.empty()) print_line("unreachable", fmt::format("{}", fmt::join(unreachable, ", ")));
  constexpr double k_nearly_all = 0.999;
  print_line("work per configuration",
             fmt::format("median {}, p99.9 {}, worst {}: {:.1f} times the median", profile.work.quantile(0.5),
                         profile.work.quantile(k_nearly_all), profile.worst_work, profile.worst_over_median()));
  print_line("worst", fmt::format("{}, {}", buckets[profile.worst.target].key.name(), place(profile.worst)));
  print_line("CPU time per ray, us",
             fmt::format("median {:.1f}, p99.9 {:.1f}, worst {:.1f}: {:.1f} times the median ({})",
                         1e6 * profile.median_ray_s, 1e6 * profile.p999_ray_s, 1e6 * profile.worst_ray_s,
                         profile.worst_ray_s / profile.median_ray_s, place(profile.worst_ray)));
  print_line("CPU time per work, ns",
             fmt::format("median {:.2f}, of all but 2 in 1000 rays {:.2f} to {:.2f}", 1e9 * profile.median_unit_s,
                         1e9 * profile.least_unit_s, 1e9 * profile.most_unit_s));
}

}  // namespace

void print_profile(const GenerationWork& work, const ProfileRequest& request) {
  const InterruptGuard interruptible;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (work.job.has(kind)) print_kind(kind, work, request);
  }
}

}  // namespace sixdof::cli
