#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row.h>

/// Which rows have a fault and are not ranked. A row has one if
/// - it could not be run, or some of its configurations failed or were answered wrongly or, where bodies overlap,
///   without a force;
/// - all answers of its algorithm to the same query about the same bodies are at fault in another bucket of the file: a
///   constant "no" is right wherever bodies are apart;
/// - its algorithm approximates, and distances differ from the exact ones, or bodies that are farther apart than its
/// resolution get a force: that is no mistake, and called "approximate";
/// - its algorithm is `null`, which measures the harness.
/// Of a study, where wrong answers are the error that is measured, they are no fault.

namespace sixdof::results {

inline constexpr const char* k_approximate = "approximate";

struct Fault {
  std::string what;         ///< "failed", "wrong", ...: behind the counts, or alone where there are none.
  std::string counter;      ///< Of the row, that counts it; empty where none does.
  std::uint64_t count = 0;  ///< How many configurations,
  std::uint64_t of = 0;     ///< of how many; 0: without counts.

  bool is_total() const { return of > 0 && count == of; }
  bool is_approximation() const { return what == k_approximate; }
};

/// "3 of 640 failed".
std::string to_string(const Fault& fault);

/// "3 of 640 failed, 2 of 637 wrong"; empty for no faults.
std::string to_string(std::span<const Fault> faults);

/// Those that are no approximation.
std::vector<Fault> mistakes(std::span<const Fault> faults);

/// What the row's own counts show. row_groups() (row_group.h) has all faults.
std::vector<Fault> own_faults(const Row& row);

}  // namespace sixdof::results
