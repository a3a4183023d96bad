#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sixdof::report {

/// A recorded response along a scenario's path with its ideal: a file of `sixdof quality -o` (scenario/evaluation.h).
struct Series {
  std::string path, scenario, law, algorithm, version, settings, shape;
  std::string command = {};  ///< That records it again; empty in files of earlier versions.
  double rate_hz = 0.0;
  using Vectors = std::vector<std::array<double, 3>>;
  Vectors force, torque, ideal_force, ideal_torque;  ///< One row per step, on B in A's frame.
  std::vector<double> penalty, ideal_penalty;        ///< Of each step: a depth or a volume, by the law.
  std::vector<double> time_ns;                       ///< Of each step's query alone.
  double reference_length = 0.0;             ///< Makes torque over force a pure number; 0 in files of earlier versions.
  std::vector<std::array<double, 7>> poses;  ///< X_AB of each step: w, x, y, z, tx, ty, tz.
  std::vector<double> status;                ///< 0 where the step has an answer.

  /// Time-frequency diagrams as they are in the file: rows are times in s, columns frequencies in Hz.
  std::vector<double> times, frequencies;
  std::vector<std::pair<std::string, std::vector<double>>>
      spectra;  ///< "force_signal", "force_residual", "force_x_signal", ...
};

/// @throws BadFile for a file that is none, is damaged, or whose arrays differ in length
Series read_series(const std::filesystem::path& path);

}  // namespace sixdof::report
