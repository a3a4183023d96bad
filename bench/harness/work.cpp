#include "bench/harness/work.h"

#include <sixdof/base/error.h>

namespace sixdof::bench {

void MeanWork::add(const std::vector<Work>& work) {
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

std::vector<Work> MeanWork::mean() const {
  std::vector<Work> mean = sums_;
  for (Work& each : mean) {
    each.tested /= static_cast<double>(queries_);
    each.total /= static_cast<double>(queries_);
  }
  return mean;
}

void MeanWork::report(benchmark::UserCounters& counters) const {
  constexpr double k_ns = 1e-9;
  for (const Work& each : mean()) {
    counters[each.unit + "_tested"] = each.tested;
    counters[each.unit + "_total"] = each.total;
    if (each.tested == 0.0) continue;
    counters["ns_per_" + each.unit] = {each.tested * k_ns,
                                       benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
  }
}

}  // namespace sixdof::bench
