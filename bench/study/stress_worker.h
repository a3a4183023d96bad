#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/study/stress.h"

/// The program that runs one cell of a stress for another process (stress_processes.h), and what the two exchange: the
/// cell as an argument of the command line, what the program is at in shared memory, and the result as one line on
/// standard output.

namespace sixdof::study {

/// What a cell's program is at.
struct StressBeacon {
  std::atomic<std::uint64_t> beats;  ///< Counts the cases, preparations and queries begun.
  CaseId id;
  std::array<double, 12> pose;  ///< That is asked; see pose_numbers().
};

/// R by columns, t.
std::array<double, 12> pose_numbers(const Pose& X_AB);

/// A beacon in memory that programs share. A cell's program finds it as descriptor 3.
class SharedBeacon {
 public:
  /// @param descriptor of at least sizeof(StressBeacon) bytes, which it does not take over @throws Error
  explicit SharedBeacon(int descriptor);
  ~SharedBeacon();
  SharedBeacon(const SharedBeacon&) = delete;
  SharedBeacon& operator=(const SharedBeacon&) = delete;

  StressBeacon& operator*() const { return *beacon_; }
  StressBeacon* operator->() const { return beacon_; }

 private:
  StressBeacon* beacon_ = nullptr;
};

/// The command line by which this program runs a cell (its family, algorithm and choice of settings) in another process
/// of itself.
/// @param external of --external
std::vector<std::string> stress_cell_command(const StressCell& cell, const StressEffort& effort, std::uint64_t seed,
                                             const std::vector<std::string>& external);

using FindAlgorithm =
    std::function<const Algorithm&(const std::string& name, const std::vector<std::string>& external)>;

/// Runs the cell if the command line is stress_cell_command(). @returns the exit code; nothing for another command line
std::optional<int> run_stress_cell_if_asked(int argc, const char* const* argv, const FindAlgorithm& find);

/// What the program has written; family, algorithm and choice of settings stay. @throws nlohmann::json::exception
void read_result(std::string_view line, StressCell& cell);

}  // namespace sixdof::study
