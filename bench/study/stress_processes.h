#pragma once

#include <functional>
#include <vector>

#include "bench/study/stress.h"

/// Runs each cell in a process of its own, so that a library that aborts, never returns or takes all memory ends only
/// its own cell.

namespace sixdof::study {

struct StressPlan {
  std::vector<const Algorithm*> algorithms;
  std::vector<const stability::Family*> families;
  StressEffort effort;
  bool at_defaults = false;  ///< Another cell for each algorithm that has_finer_defaults().
  std::uint64_t seed = 1;
  double timeout_s = 60.0;                 ///< Longest wall time of one query or one preparation.
  double memory_bytes = 4e9;               ///< Of data, for each process.
  std::size_t processes = 2;               ///< At once.
  std::vector<std::string> external = {};  ///< "NAME=COMMAND", which the processes need as well.
};

/// All cells, by family, then by algorithm. All but times, and verdicts that depend on them, is determined by the seed.
/// A cell whose process ends has the case and the pose that it was asked last, and the verdict crashed, hung or out of
/// memory.
///
/// The processes run this program again, which has to begin with run_stress_cell_if_asked() (stress_worker.h).
/// @param progress is called often, with how many cells are done; what it throws ends all processes
/// @throws Error if no process can be made
std::vector<StressCell> run_stress(const StressPlan& plan,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace sixdof::study
