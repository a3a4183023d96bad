#include "bench/cli/generate_shards.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/configuration/shard_file.h>
#include <sixdof/configuration/shard_merge.h>
#include <sixdof/generation/shard_generator.h>
#include "bench/cli/generation_progress.h"
#include "bench/common/interrupt.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using Clock = std::chrono::steady_clock;

std::string seconds_since(Clock::time_point start) {
  return as_clock(std::chrono::duration<double>(Clock::now() - start).count());
}

Generated generate_one(const GenerationWork& work, ShardNumber shard, GenerationProgress& progress) {
  const RunOptions run{.threads = work.threads,
                       .progress = [&](std::uint64_t done, std::uint64_t /*total*/) { progress.show(done); },
                       .cancelled = InterruptGuard::requested};
  Generated values = generate_shard(work.job, work.set, shard, work.generator, work.a, work.b, run);
  progress.shard_done();
  return values;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadFile(folder.string(), "cannot be made: " + error.message());
}

/// Whether the file is the shard and undamaged. @throws BadArgument if it is of another job
bool is_valid(const GenerationWork& work, ShardNumber shard, const std::filesystem::path& path) {
  try {
    const ShardFile file(path);
    if (const std::string difference = file.job().difference(work.job); !difference.empty()) {
      throw BadArgument(fmt::format("{}: of another job: {}", path.string(), difference));
    }
    if (file.number() != shard) {
      throw BadArgument(fmt::format("{}: is shard {} of {}", path.string(), file.number().number, file.number().count));
    }
    file.check_values();
    return true;
  } catch (const BadFile& e) {
    print_message("sixdof", fmt::format("made again: {}", e.what()));
    return false;
  }
}

/// The shards that are asked for and not there, or damaged.
std::vector<ShardNumber> missing_shards(const GenerationWork& work, const ShardRequest& request) {
  std::vector<ShardNumber> missing;
  for (std::size_t number = 1; number <= request.count; ++number) {
    const ShardNumber shard{.number = number, .count = request.count};
    if (request.only != 0 && number != request.only) continue;
    const auto path = request.folder / shard_file_name(shard);
    if (request.resume) remove_stale_partials(path);
    const bool there = std::filesystem::exists(path);
    if (there && !request.resume) {
      throw BadFile(path.string(), "is there already (--resume keeps valid shards)");
    }
    if (!there || !is_valid(work, shard, path)) missing.push_back(shard);
  }
  return missing;
}

}  // namespace

void generate_set(const GenerationWork& work, const std::filesystem::path& output) {
  const InterruptGuard interruptible;
  const AtomicFile writable(output);  // Fails before the work begins if the folder is missing or not writable.
  const auto start = Clock::now();
  constexpr ShardNumber k_whole{};
  Generated values;
  {
    GenerationProgress progress(work.job, work.set, {&k_whole, 1}, work.progress);
    values = generate_one(work, k_whole, progress);
  }
  const auto take = [&](ShardNumber, BucketKey key) {
    const auto of_key = [](const Bucket& bucket) { return bucket.summary.key; };
    return std::move(*std::ranges::find(values.buckets, key, of_key));
  };
  RunOptions run;
  run.cancelled = InterruptGuard::requested;
  assemble_set(output, work.job, work.set, k_whole.count, take, run);
  std::size_t configurations = 0;
  for (const BucketSummary& bucket : work.job.buckets) {
    configurations += work.set.grid_of(bucket.key.kind).configurations();
  }
  fmt::print("{}: {} configurations of {} with {} in {} ({} measurements, distances by {} {})\n", output.string(),
             configurations, work.a.name(), work.b.name(), seconds_since(start), values.measurements, work.job.oracle,
             work.job.oracle_version);
}

void generate_shards(const GenerationWork& work, const ShardRequest& request) {
  check_shard_number({.number = request.only == 0 ? 1 : request.only, .count = request.count}, work.set, work.job);
  const InterruptGuard interruptible;
  make_folder(request.folder);
  const AtomicFile writable(request.folder / shard_file_name({.number = 1, .count = request.count}));
  const auto start = Clock::now();
  const std::vector<ShardNumber> missing = missing_shards(work, request);
  GenerationProgress progress(work.job, work.set, missing, work.progress);
  for (const ShardNumber shard : missing) {
    const Generated values = generate_one(work, shard, progress);
    InterruptGuard::check();
    write_shard(request.folder / shard_file_name(shard), work.job, work.set, shard, values.buckets);
  }
  const std::size_t asked = request.only == 0 ? request.count : 1;
  fmt::print("{}: {} of {} shards of {} with {} made in {}, {} kept; merge all {}: sixdof merge {} -o SET\n",
             request.folder.string(), missing.size(), asked, work.a.name(), work.b.name(), seconds_since(start),
             asked - missing.size(), request.count, request.folder.string());
}

}  // namespace sixdof::cli
