#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace sixdof::bench {

/// "[12/280] 34 s, about 5 min left: NAME" on stderr, rewritten in place; silent unless stderr is a terminal.
class Progress {
 public:
  explicit Progress(std::size_t total);

  /// A row begins.
  void begin(const std::string& name);

  /// The line is wiped, so that a report can be printed.
  void wipe();

 private:
  const bool shown_;
  const std::size_t total_;
  std::size_t begun_ = 0;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// "45 s", "5 min", "2 h 10 min".
std::string in_words(double seconds);

}  // namespace sixdof::bench
