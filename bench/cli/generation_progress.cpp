#include "bench/cli/generation_progress.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace sixdof::cli {
namespace {

constexpr std::array k_kinds{BucketKind::distance, BucketKind::volume};

std::size_t index(BucketKind kind) { return static_cast<std::size_t>(kind); }

}  // namespace

GenerationProgress::GenerationProgress(const GenerationJob& job, const SetDescription& set,
                                       std::span<const ShardNumber> shards, bool always)
    : line_(always) {
  for (const BucketKind kind : k_kinds) {
    const auto buckets = static_cast<std::uint64_t>(
        std::ranges::count(job.buckets, kind, [](const BucketSummary& bucket) { return bucket.key.kind; }));
    const Grid& grid = set.grid_of(kind);
    const DistinctRotations distinct(grid.rotations);
    for (const ShardNumber shard : shards) {
      kinds_[index(kind)].of_shard.push_back(buckets * rotations_of(shard, distinct).size() * grid.directions.size());
      kinds_[index(kind)].total += kinds_[index(kind)].of_shard.back();
    }
  }
}

void GenerationProgress::show(std::uint64_t done) {
  const std::uint64_t step = done - done_in_shard_;
  // A call without a step comes when a kind begins.
  const std::uint64_t configuration = step == 0 ? done : done - 1;
  const bool distance = configuration < kinds_[index(BucketKind::distance)].of_shard[shard_];
  Kind& current = kinds_[index(distance ? BucketKind::distance : BucketKind::volume)];
  const Clock::time_point now = Clock::now();
  current.seconds += std::chrono::duration<double>(now - last_).count();
  current.done += step;
  done_in_shard_ = done;
  last_ = now;
  if (!line_.due()) return;

  std::string text;
  double left = 0.0;
  std::string untimed;
  for (const BucketKind each : k_kinds) {
    const Kind& k = kinds_[index(each)];
    if (k.total == 0) continue;
    text += fmt::format("{}s {}/{} ({} %), ", to_string(each), k.done, k.total, 100 * k.done / k.total);
    if (k.done > 0) {
      left += k.seconds * static_cast<double>(k.total - k.done) / static_cast<double>(k.done);
    } else {
      untimed += fmt::format(" and the {}s", to_string(each));
    }
  }
  if (current.done > 0 && current.seconds > 0.0) {
    text += fmt::format("{:.1f}/s, ", static_cast<double>(current.done) / current.seconds);
  }
  text += left > 0.0 ? fmt::format("{}{} left", as_clock(left), untimed) : "not timed yet";
  line_.show(text);
}

void GenerationProgress::shard_done() {
  ++shard_;
  done_in_shard_ = 0;
}

}  // namespace sixdof::cli
