#pragma once

#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// The mean of Query::work() over the queries of a row.
class MeanWork {
 public:
  /// @throws Error if a later query names other units than the first
  void add(const std::vector<Work>& work);

  /// In the order of Query::work().
  std::vector<Work> mean() const;

  /// For every unit, e.g. points: counters points_tested and points_total per query, and ns_per_points, the time of the
  /// timed loop per tested element. One iteration of the loop is one query.
  void report(benchmark::UserCounters& counters) const;

 private:
  std::vector<Work> sums_;
  std::size_t queries_ = 0;
};

}  // namespace sixdof::bench
