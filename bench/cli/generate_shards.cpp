#include "bench/cli/generate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/configuration/shard_file.h>
#include <sixdof/generation/shard_generator.h>
#include "bench/common/interrupt.h"
#include "bench/common/pair_warnings.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array k_kinds{BucketKind::distance, BucketKind::volume};

std::size_t index(BucketKind kind) { return static_cast<std::size_t>(kind); }

/// The status line of a run that makes shards: configurations of each kind, their rate, and the time left. Distances
/// and volumes have rates of their own.
class GenerationProgress {
 public:
  /// @param shards those that will be made, in this order
  GenerationProgress(const GenerationWork& work, std::span<const ShardNumber> shards) : line_(work.progress) {
    for (const BucketKind kind : k_kinds) {
      const auto buckets = static_cast<std::uint64_t>(
          std::ranges::count(work.job.buckets, kind, [](const BucketSummary& bucket) { return bucket.key.kind; }));
      const Grid& grid = work.set.grid_of(kind);
      const DistinctRotations distinct(grid.rotations);
      for (const ShardNumber shard : shards) {
        kinds_[index(kind)].of_shard.push_back(buckets * rotations_of(shard, distinct).size() * grid.directions.size());
        kinds_[index(kind)].total += kinds_[index(kind)].of_shard.back();
      }
    }
  }

  /// @param done configurations of the current shard, distances before volumes
  void show(std::uint64_t done) {
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

  void shard_done() {
    ++shard_;
    done_in_shard_ = 0;
  }

 private:
  /// Configurations of one kind of bucket.
  struct Kind {
    std::vector<std::uint64_t> of_shard;
    std::uint64_t total = 0;
    std::uint64_t done = 0;
    double seconds = 0.0;
  };

  StatusLine line_;
  std::array<Kind, 2> kinds_;  ///< By BucketKind.
  std::size_t shard_ = 0;
  std::uint64_t done_in_shard_ = 0;
  Clock::time_point last_ = Clock::now();
};

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
std::vector<ShardNumber> missing_shards(const GenerationWork& work, const std::filesystem::path& folder,
                                        ShardNumber shards, bool resume) {
  std::vector<ShardNumber> missing;
  for (std::size_t number = 1; number <= shards.count; ++number) {
    const ShardNumber shard{.number = number, .count = shards.count};
    if (shards.number != 0 && number != shards.number) continue;
    const auto path = folder / shard_file_name(shard);
    if (resume) remove_stale_partials(path);
    const bool there = std::filesystem::exists(path);
    if (there && !resume) {
      throw BadFile(path.string(), "is there already (--resume keeps valid shards)");
    }
    if (!there || !is_valid(work, shard, path)) missing.push_back(shard);
  }
  return missing;
}

}  // namespace

void generate_set(const GenerationWork& work, const std::filesystem::path& output) {
  check_writable(output);
  const auto start = Clock::now();
  constexpr ShardNumber k_whole{};
  Generated values;
  {
    GenerationProgress progress(work, {&k_whole, 1});
    values = generate_one(work, k_whole, progress);
  }
  const auto take = [&](ShardNumber, BucketKey key) {
    const auto of_key = [](const Bucket& bucket) { return bucket.summary.key; };
    return std::move(*std::ranges::find(values.buckets, key, of_key));
  };
  assemble_set(output, work.job, work.set, k_whole.count, take, {.cancelled = InterruptGuard::requested});
  warn_of_unreached("sixdof", ConfigurationSet(output));
  std::size_t configurations = 0;
  for (const BucketSummary& bucket : work.job.buckets) {
    configurations += work.set.grid_of(bucket.key.kind).configurations();
  }
  fmt::print("{}: {} configurations of {} with {} in {} ({} measurements, distances by {} {})\n", output.string(),
             configurations, work.a.name(), work.b.name(), seconds_since(start), values.measurements, work.job.oracle,
             work.job.oracle_version);
}

void generate_shards(const GenerationWork& work, const std::filesystem::path& folder, ShardNumber shards, bool resume) {
  check_shard_number({.number = shards.number == 0 ? 1 : shards.number, .count = shards.count}, work.set, work.job);
  make_folder(folder);
  check_writable(folder / shard_file_name({.number = 1, .count = shards.count}));
  const auto start = Clock::now();
  const std::vector<ShardNumber> missing = missing_shards(work, folder, shards, resume);
  GenerationProgress progress(work, missing);
  for (const ShardNumber shard : missing) {
    const Generated values = generate_one(work, shard, progress);
    InterruptGuard::check();
    write_shard(folder / shard_file_name(shard), work.job, work.set, shard, values.buckets);
  }
  const std::size_t asked = shards.number == 0 ? shards.count : 1;
  fmt::print("{}: {} of {} shards of {} with {} made in {}, {} kept; merge all {}: {} {} -o SET\n", folder.string(),
             missing.size(), asked, work.a.name(), work.b.name(), seconds_since(start), asked - missing.size(),
             shards.count, own_command("sixdof merge"), shell_quoted(folder.string()));
}

}  // namespace sixdof::cli
