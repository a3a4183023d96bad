#include <sixdof/configuration/shard_file.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-shard";
constexpr std::uint64_t k_format_version = 2;

/// Hash of everything; the summaries of the buckets contain the hashes of their values.
std::string hash_of(const GenerationJob& job, ShardNumber shard, const std::vector<BucketSummary>& buckets) {
  return detail::hash_of(k_format, k_format_version, job.hash(), std::uint64_t{shard.number},
                         std::uint64_t{shard.count}, buckets);
}

void write_grid(hdf5::File& file, const std::string& group, const GridIdentity& grid) {
  file.make_group(group);
  file.write_attribute(group, "grid", grid.spec);
  file.write_attribute(group, "content_hash", grid.hash);
}

GridIdentity read_grid(const hdf5::File& file, const std::string& group) {
  return {.spec = file.read_string(group, "grid"), .hash = file.read_string(group, "content_hash")};
}

/// The texts of a job by the names of their attributes.
constexpr std::array k_job_attributes{
    std::pair{"program", &GenerationJob::program}, std::pair{"generator_version", &GenerationJob::generator_version},
    std::pair{"oracle", &GenerationJob::oracle}, std::pair{"oracle_version", &GenerationJob::oracle_version}};

/// One message for all problems of the shards of a folder.
[[noreturn]] void refuse(const std::filesystem::path& folder, std::vector<std::string> problems) {
  constexpr std::size_t k_most_lines = 50;
  if (problems.size() > k_most_lines) {
    const std::string more = fmt::format("and {} more", problems.size() - k_most_lines);
    problems.resize(k_most_lines);
    problems.push_back(more);
  }
  throw BadFile(folder.string(), fmt::format("cannot be merged\n  {}", fmt::join(problems, "\n  ")));
}

/// The valid shards. Checks values too, so that all damaged files are known before the merge begins.
std::vector<ShardFile> read_all(const std::filesystem::path& folder, const RunOptions& run,
                                std::vector<std::string>& problems) {
  if (!std::filesystem::is_directory(folder)) throw BadFile(folder.string(), "is not a directory");
  std::set<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard-") && name.ends_with(".h5")) paths.insert(entry.path());
  }
  std::vector<ShardFile> shards;
  for (const auto& path : paths) {
    run.check_cancelled();
    try {
      const ShardFile shard(path);
      shard.check_values();
      shards.push_back(shard);
    } catch (const BadFile& e) {
      problems.emplace_back(e.what());
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

/// All shards of a folder by number, of one job and with every value checked.
std::map<std::size_t, ShardFile> read_shards(const std::filesystem::path& folder, const RunOptions& run) {
  std::vector<std::string> problems;
  const std::vector<ShardFile> shards = read_all(folder, run, problems);
  if (shards.empty()) {
    problems.emplace_back("no valid shard in it");
    refuse(folder, problems);
  }
  const ShardFile& expected = most_common(shards);
  std::map<std::size_t, ShardFile> by_number;
  for (const ShardFile& shard : shards) {
    const auto [number, count] = shard.number();
    const std::string path = shard.path().string();
    if (const std::string difference = shard.job().difference(expected.job()); !difference.empty()) {
      problems.push_back(fmt::format("{}: of another job than {}: {}", path, expected.path().string(), difference));
    } else if (count != expected.number().count || number < 1 || number > count) {
      problems.push_back(
          fmt::format("{}: is shard {} of {}, not one of {}", path, number, count, expected.number().count));
    } else if (const auto [known, is_new] = by_number.try_emplace(number, shard); !is_new) {
      problems.push_back(
          fmt::format("{}: is shard {} again, which {} is", path, number, known->second.path().string()));
    }
  }
  for (std::size_t number = 1; number <= expected.number().count; ++number) {
    if (by_number.contains(number)) continue;
    const auto path = folder / shard_file_name({.number = number, .count = expected.number().count});
    problems.push_back(std::filesystem::exists(path)
                           ? fmt::format("shard {} is missing: {} is not what its name says", number, path.string())
                           : path.string() + ": missing");
  }
  if (!problems.empty()) refuse(folder, problems);
  return by_number;
}

}  // namespace

std::string shard_file_name(ShardNumber shard) {
  return fmt::format("shard-{:04}-of-{:04}.h5", shard.number, shard.count);
}

void write_shard(const std::filesystem::path& path, const GenerationJob& job, const SetDescription& set,
                 ShardNumber shard, std::span<const Bucket> values) {
  AtomicFile atomic(path);
  {
    const hdf5::Session session;
    hdf5::File file = hdf5::File::create(atomic);
    file.write_attribute("/", "format", std::string(k_format));
    file.write_attribute("/", "format_version", k_format_version);
    file.write_attribute("/", "shard", std::uint64_t{shard.number});
    file.write_attribute("/", "shards", std::uint64_t{shard.count});
    file.write_attribute("/", "job", job.hash());
    for (const auto& [name, text] : k_job_attributes) file.write_attribute("/", name, job.*text);
    detail::write_identity(file, "mesh_a", job.a);
    detail::write_identity(file, "mesh_b", job.b);
    write_grid(file, "grid", job.grid);
    if (job.volume_grid) write_grid(file, "volume_grid", *job.volume_grid);
    file.make_group("distance");
    file.make_group("volume");
    std::vector<BucketSummary> buckets;
    for (const auto& [summary, translations] : values) {
      const std::size_t directions = set.grid_of(summary.key.kind).directions.size();
      buckets.push_back(detail::write_bucket(file, summary, translations, directions));
    }
    file.write_attribute("/", "content_hash", hash_of(job, shard, buckets));
    file.close();
  }
  atomic.commit();
}

ShardFile::ShardFile(std::filesystem::path path) : path_(std::move(path)) {
  const hdf5::Session session;
  const hdf5::File file = detail::open_format(path_, k_format, k_format_version, "a shard of a configuration set");
  number_ = {.number = file.read_attribute<std::uint64_t>("/", "shard"),
             .count = file.read_attribute<std::uint64_t>("/", "shards")};
  for (const auto& [name, text] : k_job_attributes) job_.*text = file.read_string("/", name);
  job_.a = detail::read_identity(file, path_, "mesh_a");
  job_.b = detail::read_identity(file, path_, "mesh_b");
  job_.grid = read_grid(file, "grid");
  if (file.exists("volume_grid")) job_.volume_grid = read_grid(file, "volume_grid");
  buckets_ = detail::read_summaries(file, path_);
  for (const BucketSummary& b : buckets_) {
    job_.buckets.push_back({.key = b.key, .nominal = b.nominal, .target = b.target, .tolerance = b.tolerance});
  }
  detail::check_content_hash(file, path_, hash_of(job_, number_, buckets_));
}

Bucket ShardFile::read(BucketKey key) const {
  const auto summary = std::ranges::find(buckets_, key, &BucketSummary::key);
  if (summary == buckets_.end()) throw BadFile(path_.string(), key.name(), "no such bucket");
  return {.summary = *summary, .translations = detail::read_translations(path_, *summary)};
}

void ShardFile::check_values() const {
  for (const BucketSummary& bucket : buckets_) static_cast<void>(read(bucket.key));
}

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
  const std::map<std::size_t, ShardFile> shards = read_shards(folder, run);
  const GenerationJob& job = shards.begin()->second.job();
  const auto read = [&](ShardNumber shard, BucketKey key) { return shards.at(shard.number).read(key); };
  assemble_set(output, job, job.describe(), shards.size(), read, run);
}

}  // namespace sixdof
