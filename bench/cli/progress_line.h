#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace sixdof::cli {

/// One line on stderr that is rewritten in place. Where stderr is no terminal it is silent, or, if asked, one line
/// every ten seconds.
class StatusLine {
 public:
  /// @param always show it where stderr is no terminal, too
  explicit StatusLine(bool always = false);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether a line shown now would be printed: it is not more often than is of use.
  bool due() const;
  void show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  const bool terminal_, visible_;
  Clock::time_point last_{};
  bool shown_ = false;
};

/// "WHAT 1234/5678 (21 %), 3200.0/s, 0:07:31 left" as a StatusLine.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what, bool always = false);

  void show(std::uint64_t done, std::uint64_t total);

 private:
  using Clock = std::chrono::steady_clock;
  StatusLine line_;
  const std::string what_;
  const Clock::time_point start_ = Clock::now();
};

/// Seconds as h:mm:ss.
std::string as_clock(double seconds);

}  // namespace sixdof::cli
