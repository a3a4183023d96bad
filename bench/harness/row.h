#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/query/registry.h>
#include <sixdof/results/outliers.h>
#include <sixdof/results/row_fields.h>
#include "bench/harness/pair_cache.h"

namespace sixdof::bench {

/// What all rows use. Everything that it refers to outlives the rows.
struct Resources {
  const Registry& registry;
  const SetCatalogue& catalogue;
  std::map<std::string, Settings> settings;  ///< Of every algorithm, by name.
  /// What the user sets of every algorithm, by its name: "NAME=VALUE" each.
  std::map<std::string, std::vector<std::string>> assignments;
  PairCache& cache;
  std::uint64_t seed = 1;  ///< Of orders and of rays.

  const Settings& settings_of(const Algorithm& algorithm) const { return settings.at(algorithm.traits().name); }
};

/// The part of the run's time, and of a bucket's sample, that a row may use.
struct Share {
  double seconds = std::numeric_limits<double>::infinity();  ///< Wall time of the whole row.
  /// How many configurations of a bucket's sample the row asks: the first ones, however long they take. The same for
  /// all rows that are compared (sample_plan.h).
  std::size_t configurations = std::numeric_limits<std::size_t>::max();
};

/// One benchmark. Making a row costs nothing: its name comes from registry and catalogue alone; sets, meshes and
/// prepared queries are fetched from the cache inside `run`.
struct PlannedRow {
  std::string name;  ///< API: "distance/algorithm:fcl-rss/pair:elephant/distance:05".
  /// Google Benchmark calls it several times, until it has found the number of iterations. What has to be done only
  /// once is kept between the calls. An exception ends the row, not the program.
  std::function<void(benchmark::State&, const Share&)> run;
  results::RowFields fields;  ///< What the name says, for readers of the result file.
  benchmark::TimeUnit unit = benchmark::kNanosecond;
  /// Of rows on a bucket's sample: wall time in seconds that the row needs per configuration, estimated from a few; 0
  /// if none of them has an answer. The argument is the time of the whole row; the estimate takes a small part of it.
  /// It may throw what `run` throws.
  std::function<double(double)> trial = {};
  /// Of rows on a bucket's sample: where the last call of `run` found the worst answers and times.
  std::function<results::Outliers()> outliers = {};
  /// Google Benchmark calls `run` once per repetition. `run` decides itself how often to ask, and sets the wall time of
  /// every iteration.
  bool one_round = false;
  /// `run` sets the wall time of its iterations and the processor time (k_processor_inside), since the algorithm runs
  /// in a process of its own.
  bool manual_time = false;
};

}  // namespace sixdof::bench
