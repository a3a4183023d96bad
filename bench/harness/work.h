#pragma once

#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/base/error.h>
#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// The mean of Query::work() over the queries of a row.
class MeanWork {
 public:
  /// @throws Error if a later query names other units than the first
  void add(const std::vector<Work>& work) {
    if (queries_ == 0) {
      for (const Work& each : work) sums_.push_back({.unit = each.unit});
    }
    if (work.size() != sums_.size()) throw Error("Query::work() names other units than at the first query");
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      sums_[i].tested += work[i].tested;
      sums_[i].total += work[i].total;
    }
    ++queries_;
  }

  /// For every unit, e.g. points: counters points_tested and points_total per query, and ns_per_points, the time of the
  /// timed loop per tested element. One iteration of the loop is one query.
  void report(benchmark::UserCounters& counters) const {
    constexpr double k_ns = 1e-9;
    for (const Work& each : sums_) {
      const double tested = each.tested / static_cast<double>(queries_);
      counters[each.unit + "_tested"] = tested;
      counters[each.unit + "_total"] = each.total / static_cast<double>(queries_);
      if (tested == 0.0) continue;
      counters["ns_per_" + each.unit] = {tested * k_ns,
                                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
    }
  }

 private:
  std::vector<Work> sums_;
  std::size_t queries_ = 0;
};

}  // namespace sixdof::bench
