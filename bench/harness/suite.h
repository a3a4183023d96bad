#pragma once

#include <functional>
#include <map>
#include <string>

#include <benchmark/benchmark.h>

#include <sixdof/query/registry.h>
#include "bench/harness/options.h"
#include "bench/harness/progress.h"
#include "bench/harness/stock.h"
#include <sixdof/configuration/set_catalogue.h>

namespace sixdof::bench {

/// What a family of rows (bench/rows/) registers itself with, and what its rows work with when they run.
///
/// Registering must cost nothing: names come from the registry and the catalogue alone; sets, meshes and structures are
/// fetched from stock() inside the row.
class Suite {
 public:
  using Row = std::function<void(benchmark::State&)>;

  /// @throws BadArgument for settings of an algorithm or parameter that does not exist
  Suite(const Options& options, const Registry& registry, const SetCatalogue& catalogue);

  /// Registers a row. The library calls `row` several times until it has found the number of iterations; it keeps for
  /// itself what needs to be done once. Exceptions end the row, not the program; only Interrupted flies on, through the
  /// library, and ends the run with the rows that are finished.
  benchmark::internal::Benchmark* add(const std::string& name, Row row);

  const Options& options() const { return options_; }
  const Registry& registry() const { return registry_; }
  const SetCatalogue& catalogue() const { return catalogue_; }
  Stock& stock() { return stock_; }
  /// Of one algorithm: its defaults and what the command line says.
  const Settings& settings(const Algorithm& algorithm) const { return settings_.at(algorithm.traits().name); }

  /// Names of all rows.
  const std::vector<std::string>& names() const { return names_; }

  /// To be called before running: how many rows will run.
  void expect_rows(std::size_t count);

  /// Wall time in seconds that the current row may take: its share of what is left of the budget; infinite without one.
  double row_budget_s() const;

 private:
  void run(const std::string& name, const Row& row, benchmark::State& state);

  const Options& options_;
  const Registry& registry_;
  const SetCatalogue& catalogue_;
  Stock stock_;
  std::map<std::string, Settings> settings_;
  std::vector<std::string> names_;
  std::string current_;
  std::size_t expected_ = 0;
  std::size_t begun_ = 0;
  std::unique_ptr<Progress> progress_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace sixdof::bench
