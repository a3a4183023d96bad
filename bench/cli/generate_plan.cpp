#include "bench/cli/generate.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_sample.h>
#include "bench/common/interrupt.h"
#include "bench/common/progress_line.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;

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

/// The buckets of one kind, before anything is measured.
struct KindCounts {
  BucketKind kind;
  const Grid& grid;
  std::size_t buckets = 0;
  std::size_t distinct = DistinctRotations(grid.rotations).first.size();

  std::size_t configurations() const { return buckets * grid.configurations(); }
  std::size_t computed() const { return buckets * grid.directions.size() * distinct; }
};

/// The size of a set.
struct SetCounts {
  std::vector<KindCounts> kinds;
  std::size_t configurations = 0, computed = 0;

  SetCounts(const SetDescription& set, std::size_t distances, std::size_t volumes) {
    for (const auto& [kind, buckets] : {std::pair(BucketKind::distance, distances), {BucketKind::volume, volumes}}) {
      if (buckets > 0) kinds.push_back({.kind = kind, .grid = set.grid_of(kind), .buckets = buckets});
    }
    for (const KindCounts& each : kinds) {
      configurations += each.configurations();
      computed += each.computed();
    }
  }
  std::size_t bytes() const { return configurations * sizeof(double); }
};

/// What a job takes, from a timed sample. Times are wall times.
struct Effort {
  std::vector<Kind> kinds;
  unsigned threads = 0;
  double total_s = 0.0;    ///< All shards in sequence.
  double shard_s = 0.0;    ///< Of one shard, of which
  double prepare_s = 0.0;  ///< for preparation.
  double bytes = 0.0;      ///< Memory of a process, of which
  double value_bytes = 0.0;
};

/// @param shards 0: a whole set in one process
Effort estimate(const GenerationWork& work, std::size_t shards, double seconds, std::uint64_t seed) {
  Effort result{.threads = work.threads};
  const bool both = work.job.has(BucketKind::distance) && work.job.has(BucketKind::volume);
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (work.job.has(kind)) result.kinds.push_back(measure(work, kind, seconds / (both ? 2.0 : 1.0), seed));
  }
  double cpu_s = 0.0, solver_bytes = 0.0, rows_bytes = 0.0, bucket_bytes = 0.0;
  for (const Kind& kind : result.kinds) {
    cpu_s += kind.cpu_s();
    result.prepare_s += kind.prepare_s;
    solver_bytes = std::max(solver_bytes, kind.solver_bytes);
    rows_bytes += sizeof(double) * kind.configurations();
    bucket_bytes = std::max(bucket_bytes, static_cast<double>(sizeof(double) * kind.grid.configurations()));
  }
  const auto parts = static_cast<double>(std::max<std::size_t>(1, shards));
  result.total_s = result.prepare_s * parts + cpu_s / result.threads;
  result.shard_s = result.prepare_s + cpu_s / parts / result.threads;
  // Without shards all rows stay in memory until the buckets are put together.
  result.value_bytes = shards == 0 ? rows_bytes + bucket_bytes : rows_bytes / parts;
  result.bytes = peak_bytes() + (result.threads - 1) * solver_bytes + result.value_bytes;
  return result;
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

Json as_json(const Kind& kind) {
  const WorkCost& cost = kind.cost;
  return {
      {"kind", to_string(kind.kind)},
      {"cpu_us_per_configuration", 1e6 * kind.cpu_s() / kind.configurations()},
      {"relative_standard_error", cost.ray_standard_error_s / cost.ray_s},
      {"cpu_s", kind.cpu_s()},
      {"ray_cpu_us",
       {{"median", 1e6 * cost.median_ray_s},
        {"p99", 1e6 * cost.p99_ray_s},
        {"greatest", 1e6 * cost.greatest_ray_s},
        {"greatest_rotation", cost.greatest_rotation},
        {"greatest_direction", cost.greatest_direction}}},
      {"sampled", {{"rays", cost.rays}, {"configurations", cost.configurations}, {"unreachable", cost.unreachable}}}};
}

}  // namespace

void print_counts(const SetDescription& set, std::size_t distances, std::size_t volumes) {
  const SetCounts counts(set, distances, volumes);
  for (const auto& [kind, grid, buckets, distinct] : counts.kinds) {
    fmt::print("{}s\n", to_string(kind));
    print_line("  grid", fmt::format("{} ({})", grid.spec, grid.sampler));
    print_line("  directions", fmt::format("{}", grid.directions.size()));
    print_line("  rotations", fmt::format("{}, of which {} distinct", grid.rotations.size(), distinct));
    print_line("  configurations", fmt::format("{} in each of {} buckets", grid.configurations(), buckets));
  }
  print_line("configurations",
             fmt::format("{}, of which {} computed and the others copied", counts.configurations, counts.computed));
  print_line("bytes of the set", fmt::format("{} before compression", counts.bytes()));
}

Json counts_as_json(const SetDescription& set, std::size_t distances, std::size_t volumes) {
  const SetCounts counts(set, distances, volumes);
  Json kinds = Json::array();
  for (const auto& [kind, grid, buckets, distinct] : counts.kinds) {
    kinds.push_back({{"kind", to_string(kind)},
                     {"grid", grid.spec},
                     {"sampler", grid.sampler},
                     {"directions", grid.directions.size()},
                     {"rotations", grid.rotations.size()},
                     {"distinct_rotations", distinct},
                     {"configurations_per_bucket", grid.configurations()},
                     {"buckets", buckets}});
  }
  return {{"kinds", std::move(kinds)},
          {"configurations", counts.configurations},
          {"computed", counts.computed},
          {"bytes", counts.bytes()}};
}

void print_estimate(const GenerationWork& work, std::size_t shards, double seconds, std::uint64_t seed) {
  const Effort needed = estimate(work, shards, seconds, seed);
  for (const Kind& kind : needed.kinds) print_cost(kind, seed);
  print_line("time", fmt::format("{} with {} threads{}", as_clock(needed.total_s), needed.threads,
                                 shards == 0 ? "" : ", all shards in sequence"));
  if (shards != 0) {
    print_line("time of one shard",
               fmt::format("{:.1f} s, of which {:.2f} s preparation", needed.shard_s, needed.prepare_s));
  }
  print_line("memory of a process", fmt::format("{:.0f} MiB, of which values {:.0f} MiB", needed.bytes / k_mebibyte,
                                                needed.value_bytes / k_mebibyte));
  if (shards != 0) {
    print_line("files",
               fmt::format("{} shards of {:.1f} MiB before compression", shards, needed.value_bytes / k_mebibyte));
  }
}

Json estimate_as_json(const GenerationWork& work, std::size_t shards, double seconds, std::uint64_t seed) {
  const Effort needed = estimate(work, shards, seconds, seed);
  Json kinds = Json::array();
  for (const Kind& kind : needed.kinds) kinds.push_back(as_json(kind));
  Json json = {{"kinds", std::move(kinds)},        {"seed", seed},
               {"threads", needed.threads},        {"time_s", needed.total_s},
               {"prepare_s", needed.prepare_s},    {"process_bytes", needed.bytes},
               {"value_bytes", needed.value_bytes}};
  if (shards != 0) json.update({{"shards", shards}, {"shard_time_s", needed.shard_s}});
  return json;
}

}  // namespace sixdof::cli
