#include "bench/harness/work.h"

namespace sixdof::bench {

void MeanWork::add(const std::vector<Work>& work) {
  if (sums_.empty()) {
    for (const Work& each : work) sums_.push_back({.unit = each.unit});
  }
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].visited += work[i].visited;
    sums_[i].present += work[i].present;
  }
  ++queries_;
}

std::vector<Work> MeanWork::mean() const {
  std::vector<Work> mean = sums_;
  for (Work& each : mean) {
    each.visited /= static_cast<double>(queries_);
    each.present /= static_cast<double>(queries_);
  }
  return mean;
}

void MeanWork::report(benchmark::UserCounters& counters) const {
  constexpr double k_ns = 1e-9;
  for (const Work& each : mean()) {
    counters[each.unit + "_visited"] = each.visited;
    counters[each.unit + "_present"] = each.present;
    if (each.visited == 0.0) continue;
    counters["ns_per_" + each.unit] = {each.visited * k_ns,
                                       benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
  }
}

}  // namespace sixdof::bench
