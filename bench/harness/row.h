#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include <benchmark/benchmark.h>

#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/query/registry.h>
#include "bench/common/row_fields.h"
#include "bench/harness/pair_cache.h"

namespace sixdof::bench {

/// What rows are made from and work with. Everything that it refers to outlives the rows.
struct Resources {
  const Registry& registry;
  const SetCatalogue& catalogue;
  std::map<std::string, Settings> settings;  ///< Of every algorithm, by name.
  PairCache& cache;
  std::uint64_t seed = 1;  ///< Of orders and of rays.

  const Settings& settings_of(const Algorithm& algorithm) const { return settings.at(algorithm.traits().name); }
};

/// One benchmark. Making a row costs nothing: its name comes from registry and catalogue alone; sets, meshes and
/// prepared queries are fetched from the cache inside `run`.
struct Row {
  std::string name;  ///< API: "distance/algorithm:fcl-rss/pair:elephant/distance:05".
  /// Google Benchmark calls it several times, until it has found the number of iterations; it keeps for itself what
  /// needs to be done once. An exception ends the row, not the program. The number is the wall time in seconds that
  /// the whole row may take, infinity without a limit.
  std::function<void(benchmark::State&, double)> run;
  RowFields fields;  ///< What the name says, for readers of the result file.
  benchmark::TimeUnit unit = benchmark::kNanosecond;
};

}  // namespace sixdof::bench
