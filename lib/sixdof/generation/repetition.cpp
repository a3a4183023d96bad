#include <sixdof/generation/repetition.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/generation/volume_generator.h>

namespace sixdof {
namespace {

bool same_bits(double x, double y) {
  return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (std::isnan(x) && std::isnan(y));
}

/// Infinite where one of both is unreachable.
double change(const ChangedValue& value) {
  const double difference = std::abs(value.stored - value.made);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

/// First indices of distinct rotations, ascending.
std::vector<std::uint32_t> draw_rotations(const Grid& grid, const RepetitionSample& sample) {
  std::vector<std::uint32_t> all = DistinctRotations(grid.rotations).first;
  if (sample.rotations == 0 || sample.rotations >= all.size()) return all;
  // Fisher-Yates on the first ones. The bias of the modulo is at most the number of rotations / 2^64.
  std::mt19937_64 random(sample.seed);
  for (std::size_t i = 0; i < sample.rotations; ++i) std::swap(all[i], all[i + random() % (all.size() - i)]);
  all.resize(sample.rotations);
  std::ranges::sort(all);
  return all;
}

bool same_grid(const Grid& stored) {
  const Grid made = make_grid(stored.spec);
  return made.sampler == stored.sampler && made.directions == stored.directions && made.rotations == stored.rotations;
}

void compare_summaries(const BucketSummary& stored, const BucketSummary& made, std::vector<std::string>& differences) {
  const auto compare = [&](const char* what, const auto& before, const auto& now) {
    if (before != now) differences.push_back(fmt::format("{}: {} {}, now {}", stored.key.name(), what, before, now));
  };
  compare("nominal", stored.nominal, made.nominal);
  compare("target", stored.target, made.target);
  compare("tolerance", stored.tolerance, made.tolerance);
  compare("oracle", stored.oracle, made.oracle);
  compare("oracle version", stored.oracle_version, made.oracle_version);
}

BucketRepetition compare_rows(const std::vector<double>& stored, const Bucket& made,
                              std::span<const std::uint32_t> rotations, std::size_t directions) {
  BucketRepetition result{.key = made.summary.key, .values = rotations.size() * directions};
  for (std::size_t row = 0; row < rotations.size(); ++row) {
    for (std::uint32_t u = 0; u < directions; ++u) {
      const ChangedValue value{.rotation = rotations[row],
                               .direction = u,
                               .stored = stored[rotations[row] * directions + u],
                               .made = made.translations[row * directions + u]};
      if (same_bits(value.stored, value.made)) continue;
      if (result.changed++ == 0 || change(value) > change(result.largest)) result.largest = value;
    }
  }
  return result;
}

}  // namespace

std::uint64_t Repetition::values() const {
  return std::accumulate(buckets.begin(), buckets.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const BucketRepetition& bucket) { return sum + bucket.values; });
}

std::uint64_t Repetition::changed() const {
  return std::accumulate(buckets.begin(), buckets.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const BucketRepetition& bucket) { return sum + bucket.changed; });
}

std::string distance_oracle(const ConfigurationSet& set) {
  for (const BucketSummary& bucket : set.buckets()) {
    if (bucket.key.kind == BucketKind::distance || bucket.key.percent == 0.0) return bucket.oracle;
  }
  return {};
}

Repetition make_again(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const DistanceGenerator& generator,
                      const RepetitionSample& sample, const RunOptions& run) {
  set.check_meshes(a, b);
  const std::string oracle = distance_oracle(set);
  if (!oracle.empty() && oracle != generator.oracle_name()) {
    throw BadArgument(
        fmt::format("{}: made with {}, not with {}", set.path().string(), oracle, generator.oracle_name()));
  }
  Repetition result;
  std::uint64_t done_before = 0;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    std::vector<double> percents;
    for (const BucketSummary& bucket : set.buckets()) {
      if (bucket.key.kind == kind) percents.push_back(bucket.key.percent);
    }
    if (percents.empty()) continue;
    const Grid& grid = set.grid(kind);
    if (!same_grid(grid)) {
      result.differences.push_back(
          fmt::format("{}s: grid {} has other directions or rotations now", to_string(kind), grid.spec));
    }
    const std::vector<std::uint32_t> rotations = draw_rotations(grid, sample);
    RunOptions part_run = run;
    if (run.progress) {
      part_run.progress = [&](std::uint64_t done, std::uint64_t total) {
        run.progress(done_before + done, done_before + total);
      };
    }
    const auto generate = kind == BucketKind::distance ? generate_distances : generate_volumes;
    const Generated made = generate(generator, a, b, grid, percents, part_run, rotations);
    for (const Bucket& bucket : made.buckets) {
      compare_summaries(set.summary(bucket.summary.key), bucket.summary, result.differences);
      result.buckets.push_back(compare_rows(set.read(bucket.summary.key), bucket, rotations, grid.directions.size()));
    }
    done_before += percents.size() * rotations.size() * grid.directions.size();
  }
  return result;
}

}  // namespace sixdof
