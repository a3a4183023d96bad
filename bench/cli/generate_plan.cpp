#include "bench/cli/generate_plan.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/interrupt.h"
#include "bench/cli/progress_line.h"
#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_sample.h>

namespace sixdof::cli {
namespace {

constexpr double k_mebibyte = 1024.0 * 1024.0;

/// The largest memory that this process has had so far, in bytes.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// What one kind of bucket asks for, and what it was found to cost.
struct Kind {
  BucketKind kind;
  std::vector<double> targets;  ///< In the order in which a ray meets them.
  std::size_t directions = 0, rotations = 0, distinct = 0;
  double prepare_s = 0.0;     ///< Wall time.
  double solver_bytes = 0.0;  ///< Of each further thread.
  WorkCost cost;

  double configurations() const { return static_cast<double>(distinct * directions * targets.size()); }
  double cpu_s() const { return cost.total_s(distinct, directions); }
};

Kind describe(const GenerationWork& work, BucketKind which) {
  const Grid& grid = work.set.grid_of(which);
  Kind kind{.kind = which,
            .targets = {},
            .directions = grid.directions.size(),
            .rotations = grid.rotations.size(),
            .distinct = DistinctRotations(grid.rotations).first.size(),
            .cost = {}};
  for (const BucketSummary& bucket : buckets_in_order(work.job, which)) kind.targets.push_back(bucket.target);
  return kind;
}

/// Fills in what the kind costs.
void measure(const GenerationWork& work, const EstimateRequest& request, double seconds, Kind& kind) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::optional<VolumeGenerator> volumes;
  if (kind.kind == BucketKind::volume) volumes.emplace(work.generator, work.a, work.b);
  const auto prepare = [&] { return volumes ? volumes->prepare() : work.generator.prepare(work.a, work.b); };
  const auto solver = prepare();
  kind.prepare_s = std::chrono::duration<double>(Clock::now() - start).count();
  kind.cost = sample_work(*solver, work.set.grid_of(kind.kind), kind.targets, seconds, request.seed,
                          [] { return InterruptGuard::requested(); });
  // A second solver, warmed up by one ray, is what every thread beyond the first adds.
  const double before = peak_bytes();
  const auto second = prepare();
  sample_work(*second, work.set.grid_of(kind.kind), kind.targets, 0.0, request.seed);
  kind.solver_bytes = std::max(0.0, peak_bytes() - before);
}

void print_line(const char* what, const std::string& text) { fmt::print("{:<26} {}\n", what, text); }

}  // namespace

std::vector<BucketSummary> buckets_in_order(const GenerationJob& job, BucketKind kind) {
  std::vector<BucketSummary> buckets;
  for (const BucketSummary& bucket : job.buckets) {
    if (bucket.key.kind == kind) buckets.push_back(bucket);
  }
  if (kind == BucketKind::distance) std::ranges::reverse(buckets);
  return buckets;
}

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

void print_estimate(const GenerationWork& work, const EstimateRequest& request) {
  const InterruptGuard interruptible;
  std::vector<Kind> kinds;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (work.job.has(kind)) kinds.push_back(describe(work, kind));
  }
  for (Kind& kind : kinds) measure(work, request, request.seconds / static_cast<double>(kinds.size()), kind);

  double cpu_s = 0.0, prepare_s = 0.0, solver_bytes = 0.0, rows_bytes = 0.0, bucket_bytes = 0.0;
  for (const Kind& kind : kinds) {
    cpu_s += kind.cpu_s();
    prepare_s += kind.prepare_s;
    solver_bytes = std::max(solver_bytes, kind.solver_bytes);
    rows_bytes += sizeof(double) * kind.configurations();
    bucket_bytes = std::max(bucket_bytes, static_cast<double>(sizeof(double) * kind.rotations * kind.directions));
    print_line(fmt::format("{}s", to_string(kind.kind)).c_str(),
               fmt::format("{:.2f} us per configuration +- {:.0f} % ({} rays sampled, seed {}): {:.3f} CPU-hours",
                           1e6 * kind.cpu_s() / kind.configurations(),
                           100.0 * kind.cost.ray_standard_error_s / kind.cost.ray_s, kind.cost.rays, request.seed,
                           kind.cpu_s() / 3600.0));
  }
  const unsigned threads = work.threads != 0 ? work.threads : std::max(1u, std::thread::hardware_concurrency());
  const double shards = static_cast<double>(std::max<std::size_t>(1, request.shards));
  const double shard_s = prepare_s + cpu_s / shards / threads;
  print_line("time", fmt::format("{} with {} threads{}", as_clock(prepare_s * shards + cpu_s / threads), threads,
                                 request.shards == 0 ? "" : ", all shards in turn"));
  if (request.shards != 0) {
    print_line("time of one shard", fmt::format("{:.1f} s, of which {:.2f} s preparation", shard_s, prepare_s));
  }
  // In one piece, rows stay in memory until the buckets are put together.
  const double values = request.shards == 0 ? rows_bytes + bucket_bytes : rows_bytes / shards;
  print_line("memory of a process",
             fmt::format("{:.0f} MiB, of which values {:.0f} MiB",
                         (peak_bytes() + (threads - 1) * solver_bytes + values) / k_mebibyte, values / k_mebibyte));
  if (request.shards != 0) {
    print_line("files", fmt::format("{} shards of {:.1f} MiB before compression", request.shards, values / k_mebibyte));
  }
}

}  // namespace sixdof::cli
