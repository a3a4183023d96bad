#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace sixdof::cli {

/// One line on stderr that is rewritten in place: "WHAT 1234/5678 (21 %), 3.2k/s, 0:07:31 left". Silent unless stderr
/// is a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::uint64_t done, std::uint64_t total);

 private:
  using Clock = std::chrono::steady_clock;
  const std::string what_;
  const bool terminal_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
  bool shown_ = false;
};

/// Seconds as h:mm:ss.
std::string as_clock(double seconds);

}  // namespace sixdof::cli
