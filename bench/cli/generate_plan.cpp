#include "bench/cli/generate.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_sample.h>
#include "bench/common/interrupt.h"
#include "bench/common/progress_line.h"

namespace sixdof::cli {
namespace {

constexpr double k_mebibyte = 1024.0 * 1024.0;

/// Largest resident memory of this process so far, in bytes.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// The buckets of one kind, and what they were measured to cost.
struct Kind {
  BucketKind kind;
  const Grid& grid;
  std::size_t distinct = DistinctRotations(grid.rotations).first.size();
  std::vector<double> targets = {};  ///< In the order in which a ray meets them.
  double prepare_s = 0.0;            ///< Wall time.
  double solver_bytes = 0.0;         ///< Of each thread beyond the first.
  WorkCost cost = {};

  double configurations() const { return static_cast<double>(distinct * grid.directions.size() * targets.size()); }
  double cpu_s() const { return cost.total_s(distinct, grid.directions.size()); }
};

/// Samples the rays of one kind for `seconds`.
Kind measure(const GenerationWork& work, BucketKind which, double seconds, std::uint64_t seed) {
  Kind kind{.kind = which, .grid = work.set.grid_of(which)};
  for (const BucketSummary& bucket : work.job.buckets) {
    if (bucket.key.kind == which) kind.targets.push_back(bucket.target);
  }
  // The job has them ascending; a ray comes from far.
  if (which == BucketKind::distance) std::ranges::reverse(kind.targets);
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::function<std::unique_ptr<RaySolver>()> prepare = [&] { return work.generator.prepare(work.a, work.b); };
  if (which == BucketKind::volume) prepare = volume_solvers(work.generator, work.a, work.b);
  const auto solver = prepare();
  kind.prepare_s = std::chrono::duration<double>(Clock::now() - start).count();
  kind.cost = sample_work(*solver, kind.grid, kind.targets, seconds, seed, {.cancelled = InterruptGuard::requested});
  // Every further thread adds the memory of a second solver that has solved a ray.
  const double before = peak_bytes();
  const auto second = prepare();
  sample_work(*second, kind.grid, kind.targets, 0.0, seed);
  kind.solver_bytes = std::max(0.0, peak_bytes() - before);
  return kind;
}

void print_line(const std::string& what, const std::string& text) { fmt::print("{:<26} {}\n", what, text); }

void print_cost(const Kind& kind, std::uint64_t seed) {
  const WorkCost& cost = kind.cost;
  print_line(fmt::format("{}s", to_string(kind.kind)),
             fmt::format("{:.2f} us per configuration +- {:.0f} % ({} rays sampled, seed {}): {:.3f} CPU-hours",
                         1e6 * kind.cpu_s() / kind.configurations(), 100.0 * cost.ray_standard_error_s / cost.ray_s,
                         cost.rays, seed, kind.cpu_s() / 3600.0));
  print_line("  CPU time of a ray",
             fmt::format("median {:.1f} us, p99 {:.1f} us, greatest {:.1f} us (rotation {}, direction {})",
                         1e6 * cost.median_ray_s, 1e6 * cost.p99_ray_s, 1e6 * cost.greatest_ray_s,
                         cost.greatest_rotation, cost.greatest_direction));
  print_line("  unreachable", fmt::format("{} of {} configurations sampled", cost.unreachable, cost.configurations));
}

}  // namespace

void print_counts(const SetDescription& set, std::size_t distances, std::size_t volumes) {
  std::size_t all = 0, computed = 0;
  for (const auto& [kind, buckets] : {std::pair(BucketKind::distance, distances), {BucketKind::volume, volumes}}) {
    if (buckets == 0) continue;
    const Grid& grid = set.grid_of(kind);
    const std::size_t distinct = DistinctRotations(grid.rotations).first.size();
    fmt::print("{}s\n", to_string(kind));
    print_line("  grid", fmt::format("{} ({})", grid.spec, grid.sampler));
    print_line("  directions", fmt::format("{}", grid.directions.size()));
    print_line("  rotations", fmt::format("{}, of which {} distinct", grid.rotations.size(), distinct));
    print_line("  configurations", fmt::format("{} in each of {} buckets", grid.configurations(), buckets));
    all += buckets * grid.configurations();
    computed += buckets * grid.directions.size() * distinct;
  }
  print_line("configurations", fmt::format("{}, of which {} computed and the others copied", all, computed));
  print_line("bytes of the set", fmt::format("{} before compression", all * sizeof(double)));
}

void print_estimate(const GenerationWork& work, std::size_t shards, double seconds, std::uint64_t seed) {
  const InterruptGuard interruptible;
  const bool both = work.job.has(BucketKind::distance) && work.job.has(BucketKind::volume);
  std::vector<Kind> kinds;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (work.job.has(kind)) kinds.push_back(measure(work, kind, seconds / (both ? 2.0 : 1.0), seed));
  }
  double cpu_s = 0.0, prepare_s = 0.0, solver_bytes = 0.0, rows_bytes = 0.0, bucket_bytes = 0.0;
  for (const Kind& kind : kinds) {
    cpu_s += kind.cpu_s();
    prepare_s += kind.prepare_s;
    solver_bytes = std::max(solver_bytes, kind.solver_bytes);
    rows_bytes += sizeof(double) * kind.configurations();
    bucket_bytes = std::max(bucket_bytes, static_cast<double>(sizeof(double) * kind.grid.configurations()));
    print_cost(kind, seed);
  }
  const unsigned threads = work.threads != 0 ? work.threads : std::max(1u, std::thread::hardware_concurrency());
  const auto parts = static_cast<double>(std::max<std::size_t>(1, shards));
  const double shard_s = prepare_s + cpu_s / parts / threads;
  print_line("time", fmt::format("{} with {} threads{}", as_clock(prepare_s * parts + cpu_s / threads), threads,
                                 shards == 0 ? "" : ", all shards in sequence"));
  if (shards != 0) {
    print_line("time of one shard", fmt::format("{:.1f} s, of which {:.2f} s preparation", shard_s, prepare_s));
  }
  // Without shards all rows stay in memory until the buckets are put together.
  const double values = shards == 0 ? rows_bytes + bucket_bytes : rows_bytes / parts;
  print_line("memory of a process",
             fmt::format("{:.0f} MiB, of which values {:.0f} MiB",
                         (peak_bytes() + (threads - 1) * solver_bytes + values) / k_mebibyte, values / k_mebibyte));
  if (shards != 0) {
    print_line("files", fmt::format("{} shards of {:.1f} MiB before compression", shards, values / k_mebibyte));
  }
}

}  // namespace sixdof::cli
