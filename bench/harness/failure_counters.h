#pragma once

#include <string>

#include <benchmark/benchmark.h>

#include "bench/harness/guarded_query.h"

namespace sixdof::bench {

/// Counters `crashed`, `timed_out` and `out_of_memory`, each where there are such configurations.
inline void count_statuses(benchmark::UserCounters& counters, const Failures& failures) {
  for (const Status status : k_counted_statuses) {
    const std::size_t count = failures.count(status);
    if (count > 0) counters[std::string(to_string(status))].value += static_cast<double>(count);
  }
}

}  // namespace sixdof::bench
