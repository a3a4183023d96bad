#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include <sixdof/stability/families.h>
#include <sixdof/stability/judge.h>

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

/// Which case of a family: one of its field cases, or that of some genes.
struct CaseId {
  static constexpr std::size_t k_generated = std::numeric_limits<std::size_t>::max();
  std::size_t field = k_generated;
  stability::Genes genes{};
};

stability::Case make_case(const stability::Family& family, const CaseId& id);

/// What an algorithm is asked with.
enum class StressSettings {
  coarsest,  ///< coarse_settings(): of one that does not approximate the defaults.
  defaults
};

Settings settings_of(const Algorithm& algorithm, StressSettings which);

/// Whether an algorithm is asked at its defaults, too: it approximates, and is asked at its coarsest settings
/// otherwise.
bool has_finer_defaults(const Algorithm& algorithm);

/// An algorithm on a family.
struct StressCell {
  const stability::Family* family = nullptr;
  const Algorithm* algorithm = nullptr;
  StressSettings which = StressSettings::coarsest;
  std::string settings;  ///< "name=value,name=value" of settings_of().
  std::size_t cases = 0;
  std::size_t unsupported = 0;  ///< Cases that it declares it does not answer.
  CaseId id;                    ///< The worst case,
  stability::Finding worst;     ///< and what is wrong with it.
  CaseId slow_id;               ///< The case with the slowest query.
  std::size_t slow_shot = 0;
  double slowest_seconds = 0.0;  ///< Processor time.

  /// "vps", or "vps at defaults".
  std::string name() const;
};

/// Is told what is asked next, so that it is known if the process ends there.
struct StressWatch {
  std::function<void(const CaseId&)> begins_case;
  std::function<void()> prepares;
  std::function<void(const Pose& X_AB)> asks;
};

/// One cell, in this process. Deterministic by seed but for times. Nothing is searched for at defaults, where bodies
/// are prepared for long.
StressCell run_cell(const stability::Family& family, const Algorithm& algorithm, StressSettings which,
                    const StressEffort& effort, std::uint64_t seed, const StressWatch& watch);

/// The command that asks a case's shot again, one line: numbers with all digits, settings that differ from the
/// defaults; a pose that is none by its twelve numbers. Of a generator: the same ray, turned to an axis, with targets
/// to a thousandth of a percent.
/// @param folder gets the two meshes as OFF files named by content
std::string reproduction(const stability::Case& member, std::size_t shot, const Algorithm& algorithm,
                         const Settings& settings, const std::filesystem::path& folder);

}  // namespace sixdof::study
