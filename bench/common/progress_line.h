#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace sixdof {

/// One line on stderr that is rewritten in place and cut to the current width of the terminal. Where stderr is not a
/// terminal, or the terminal cannot rewrite a line (TERM=dumb), nothing is printed or, with `always`, one line every
/// ten seconds.
class StatusLine {
 public:
  /// @param always print also where stderr is not such a terminal
  explicit StatusLine(bool always = false);
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether show() would print now: nothing is shown yet, or long enough ago.
  bool due() const;
  void show(std::string_view text);

  /// Removes the line from the terminal, so that other output can be printed. The next show() prints at once.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  const bool terminal_, visible_;
  Clock::time_point last_{};
  bool shown_ = false;
};

/// "WHAT 1234/5678 (21 %), 3200.0/s, 0:07:31 left: DETAIL" as a StatusLine.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what, bool always = false) : line_(always), what_(std::move(what)) {}

  void show(std::uint64_t done, std::uint64_t total, std::string_view detail = {});
  void clear() { line_.clear(); }

 private:
  using Clock = std::chrono::steady_clock;
  StatusLine line_;
  const std::string what_;
  const Clock::time_point start_ = Clock::now();
};

/// Removes what a StatusLine shows on the terminal, from another thread. For a program that ends without unwinding.
void erase_status_line();

/// Seconds as h:mm:ss.
std::string as_clock(double seconds);

/// The first `columns` characters of a text in UTF-8, one column each.
std::string_view cut_to_columns(std::string_view text, std::size_t columns);

}  // namespace sixdof
