#include <sixdof/measure/latency.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <sixdof/base/error.h>

namespace sixdof {

Latency latency(std::span<const double> times_ns) {
  Latency result;
  if (times_ns.empty()) return result;
  std::vector<double> sorted(times_ns.begin(), times_ns.end());
  if (!std::all_of(sorted.begin(), sorted.end(), [](double t) { return std::isfinite(t); })) {
    throw BadArgument("latency: a time is not finite");
  }
  std::sort(sorted.begin(), sorted.end());
  const auto count = static_cast<double>(sorted.size());
  // In permille and integers, because 0.99 * 100 is not 99 in binary.
  const auto quantile = [&](std::size_t permille) { return sorted[(sorted.size() * permille + 999) / 1000 - 1]; };
  result.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  result.p10 = quantile(100);
  result.p25 = quantile(250);
  result.p50 = quantile(500);
  result.p75 = quantile(750);
  result.p90 = quantile(900);
  if (sorted.size() >= k_fewest_for_p99) result.p99 = quantile(990);
  if (sorted.size() >= k_fewest_for_p999) result.p999 = quantile(999);
  result.max = sorted.back();
  const auto first_late = std::upper_bound(sorted.begin(), sorted.end(), k_haptic_deadline_ns);
  result.over_deadline = static_cast<double>(sorted.end() - first_late) / count;
  return result;
}

}  // namespace sixdof
