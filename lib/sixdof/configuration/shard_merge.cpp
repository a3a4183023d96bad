#include <sixdof/configuration/shard_merge.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/shard_file.h>

namespace sixdof {
namespace {

/// Collects the problems of the shards of a folder, so that one message names them all.
class Problems {
 public:
  explicit Problems(const std::filesystem::path& folder) : folder_(folder) {}

  void add(std::string words) { list_.push_back(std::move(words)); }
  void throw_if_any() const {
    constexpr std::size_t k_most_lines = 50;
    if (list_.empty()) return;
    std::vector<std::string> lines(list_.begin(),
                                   list_.begin() + static_cast<std::ptrdiff_t>(std::min(k_most_lines, list_.size())));
    if (list_.size() > k_most_lines) lines.push_back(fmt::format("and {} more", list_.size() - k_most_lines));
    throw BadFile(folder_.string(), fmt::format("cannot be merged\n  {}", fmt::join(lines, "\n  ")));
  }

 private:
  const std::filesystem::path& folder_;
  std::vector<std::string> list_;
};

std::vector<std::filesystem::path> shard_paths(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) throw BadFile(folder.string(), "is not a directory");
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard-") && name.ends_with(".h5")) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

/// The valid shards. Checks values too, so that all damaged files are known before the merge begins.
std::vector<ShardFile> read_all(const std::filesystem::path& folder, const RunOptions& run, Problems& problems) {
  std::vector<ShardFile> shards;
  for (const auto& path : shard_paths(folder)) {
    run.check_cancelled();
    try {
      ShardFile shard(path);
      shard.check_values();
      shards.push_back(std::move(shard));
    } catch (const BadFile& e) {
      problems.add(e.what());
    }
  }
  return shards;
}

/// A shard of the job and the number of shards that most files have, so that a stray file is reported and not the rest.
const ShardFile& most_common(const std::vector<ShardFile>& shards) {
  const auto split = [](const ShardFile& shard) { return std::pair(shard.job().hash(), shard.number().count); };
  std::map<std::pair<std::string, std::size_t>, std::size_t> counts;
  for (const ShardFile& shard : shards) ++counts[split(shard)];
  return *std::ranges::max_element(shards, {}, [&](const ShardFile& shard) { return counts[split(shard)]; });
}

/// All shards of a folder, by number, of one job and with every value checked.
std::vector<ShardFile> read_shards(const std::filesystem::path& folder, const RunOptions& run) {
  Problems problems(folder);
  std::vector<ShardFile> shards = read_all(folder, run, problems);
  if (shards.empty()) {
    problems.add("no valid shard in it");
    problems.throw_if_any();
  }
  const ShardFile expected = most_common(shards);
  std::map<std::size_t, ShardFile> by_number;
  for (ShardFile& shard : shards) {
    const auto [number, count] = shard.number();
    if (const std::string difference = shard.job().difference(expected.job()); !difference.empty()) {
      problems.add(
          fmt::format("{}: of another job than {}: {}", shard.path().string(), expected.path().string(), difference));
    } else if (count != expected.number().count || number < 1 || number > count) {
      problems.add(fmt::format("{}: is shard {} of {}, not one of {}", shard.path().string(), number, count,
                               expected.number().count));
    } else if (const auto [known, is_new] = by_number.try_emplace(number, shard); !is_new) {
      problems.add(fmt::format("{}: is shard {} again, which {} is", shard.path().string(), number,
                               known->second.path().string()));
    }
  }
  for (std::size_t number = 1; number <= expected.number().count; ++number) {
    if (by_number.contains(number)) continue;
    const auto path = folder / shard_file_name({.number = number, .count = expected.number().count});
    problems.add(std::filesystem::exists(path)
                     ? fmt::format("shard {} is missing: {} is not what its name says", number, path.string())
                     : path.string() + ": missing");
  }
  problems.throw_if_any();
  std::vector<ShardFile> sorted;
  for (auto& [number, shard] : by_number) sorted.push_back(std::move(shard));
  return sorted;
}

}  // namespace

void assemble_set(const std::filesystem::path& output, const GenerationJob& job, const SetDescription& set,
                  std::size_t shards, const ShardSource& source, const RunOptions& run) {
  ConfigurationSetWriter writer(output, set);
  std::uint64_t done = 0;
  for (const BucketSummary& planned : job.buckets) {
    const Grid& grid = set.grid_of(planned.key.kind);
    const std::size_t directions = grid.directions.size();
    const DistinctRotations distinct(grid.rotations);
    std::vector<double> translations(grid.configurations());
    BucketSummary summary;
    for (std::size_t number = 1; number <= shards; ++number) {
      run.check_cancelled();
      const ShardNumber shard{.number = number, .count = shards};
      Bucket part = source(shard, planned.key);
      const auto rotations = rotations_of(shard, distinct);
      if (part.translations.size() != rotations.size() * directions) {
        throw BadArgument(fmt::format("shard {} of {}, {}: {} values for {} rotations x {} directions", number, shards,
                                      planned.key.name(), part.translations.size(), rotations.size(), directions));
      }
      for (std::size_t i = 0; i < rotations.size(); ++i) {
        std::copy_n(&part.translations[i * directions], directions, &translations[rotations[i] * directions]);
      }
      const double largest = std::max(summary.largest_residual, part.summary.largest_residual);
      summary = std::move(part.summary);
      summary.largest_residual = largest;
      if (run.progress) run.progress(++done, job.buckets.size() * shards);
    }
    distinct.copy_to_repeats(translations, directions);
    writer.write(std::move(summary), translations);
  }
  writer.commit();
}

void merge_shards(const std::filesystem::path& folder, const std::filesystem::path& output, const RunOptions& run) {
  const std::vector<ShardFile> shards = read_shards(folder, run);
  const GenerationJob& job = shards.front().job();
  assemble_set(
      output, job, job.describe(), shards.size(),
      [&](ShardNumber shard, BucketKey key) { return shards[shard.number - 1].read(key); }, run);
}

}  // namespace sixdof
