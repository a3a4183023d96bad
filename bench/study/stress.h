#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include <sixdof/stability/families.h>
#include <sixdof/stability/search.h>

/// Which algorithm breaks when numbers get hard, where, and how badly: families of hard cases against algorithms.

namespace sixdof::study {

/// How much a cell is tried.
struct StressEffort {
  std::size_t samples = 4;           ///< Generated cases per family.
  std::size_t declared_samples = 2;  ///< The same for algorithms that declare a resolution: they prepare for long.
  std::size_t generations = 2;       ///< Of each of the two searches.
  std::size_t children = 2;          ///< Of a generation.

  static StressEffort quick() { return {}; }
  static StressEffort full() { return {.samples = 40, .declared_samples = 16, .generations = 6, .children = 6}; }
};

struct StressPlan {
  std::vector<const Algorithm*> algorithms;
  std::vector<const stability::Family*> families;
  StressEffort effort;
  std::uint64_t seed = 1;
};

/// An algorithm on a family.
struct StressCell {
  const stability::Family* family = nullptr;
  const Algorithm* algorithm = nullptr;
  Settings settings;  ///< coarse_settings() of the algorithm.
  std::size_t cases = 0;
  std::size_t unsupported = 0;  ///< Cases that it declares it does not answer.
  stability::Case member;       ///< The worst case,
  stability::Finding worst;     ///< and what is wrong with it.
  stability::Case slow_member;  ///< The case with the slowest query.
  std::size_t slow_shot = 0;
  double slowest_seconds = 0.0;  ///< Processor time.
};

/// All cells, by family, then by algorithm. Deterministic by seed but for times.
/// @param progress is told how many cells of how many are done, from one thread at a time
std::vector<StressCell> run_stress(const StressPlan& plan,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress);

/// The command that asks the same again, one line: numbers with all digits, settings that differ from the defaults.
/// @param folder gets the two meshes as OFF files named by content, if it is not empty; else their names only
std::string reproduction(const stability::Shot& shot, const Algorithm& algorithm, const Settings& settings,
                         const std::filesystem::path& folder);

}  // namespace sixdof::study
