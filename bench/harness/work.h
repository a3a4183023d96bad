#pragma once

#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// What the queries of a row looked at, on average.
class MeanWork {
 public:
  /// Of one query; every call names the same units.
  void add(const std::vector<Work>& work);

  /// In the order of Query::work().
  std::vector<Work> mean() const;

  /// For every unit, say points: counters points_visited and points_present per query, and ns_per_points, the timed
  /// loop's time per visited one, where one iteration of it is one query.
  void report(benchmark::UserCounters& counters) const;

 private:
  std::vector<Work> sums_;
  std::size_t queries_ = 0;
};

}  // namespace sixdof::bench
