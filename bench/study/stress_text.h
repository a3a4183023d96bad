#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/process/remote_query.h>
#include "bench/study/stress.h"

namespace sixdof::study {

/// A cell as text and for files.
struct StressLine {
  std::string verdict, metric, worst, member, thread, reproduction, slow_reproduction, words;
  double parameter = 0.0;  ///< Of the worst case.
};

/// @param folder gets the meshes of the reproductions; see reproduction()
/// @param limits of the processes; the command of a case that ended one asks in such a process
StressLine stress_line(const StressCell& cell, const std::filesystem::path& folder, const ProcessLimits& limits);

/// Families down, algorithms across (StressCell::name()), a word per cell: "exact", "within", "-" for declared
/// unsupported, else a red one in capital letters.
std::string stress_matrix(const std::vector<StressCell>& cells);

/// A list of cells: family, algorithm, verdict, cases, worst, unit, reproduction, and what else is known of each.
nlohmann::ordered_json stress_json(const std::vector<StressCell>& cells, const std::vector<StressLine>& lines,
                                   std::uint64_t seed);

}  // namespace sixdof::study
