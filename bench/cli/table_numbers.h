#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/configuration/bucket.h>
#include <sixdof/results/fault.h>

/// How `sixdof table` writes numbers, and sums of faults.

namespace sixdof::cli {

/// Three significant digits of a time in microseconds.
inline std::string as_microseconds(double ns) {
  const double us = ns / 1e3;
  const int decimals = us < 0.01 ? 4 : us < 10.0 ? 2 : us < 100.0 ? 1 : 0;
  return fmt::format("{:.{}f}", us, decimals);
}

inline std::string as_percent(double fraction) {
  const double percent = 100.0 * fraction;
  if (percent == 0.0) return "0";
  if (percent < 0.01) return "<0.01";
  return fmt::format("{:.{}f}", percent, percent < 1.0 ? 2 : percent < 100.0 ? 1 : 0);
}

inline std::string as_degrees(double degrees) { return fmt::format("{:.{}f}", degrees, degrees < 10.0 ? 2 : 1); }

inline std::string as_small(double value) { return value == 0.0 ? "0" : fmt::format("{:.1e}", value); }

inline std::string as_count(double value) { return fmt::format("{:.0f}", value); }

inline std::string bucket_text(BucketKey bucket) { return bucket.percent_text() + " %"; }

/// Adds the counts of a fault to those with equal words.
inline void add_fault(std::vector<results::Fault>& sums, const results::Fault& fault) {
  const auto found = std::ranges::find(sums, fault.what, &results::Fault::what);
  if (found == sums.end()) {
    sums.push_back(fault);
  } else {
    found->count += fault.count;
    found->of += fault.of;
  }
}

}  // namespace sixdof::cli
