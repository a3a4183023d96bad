#include <sixdof/bench/cli/progress_line.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace sixdof::cli {

std::string as_clock(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(std::uint64_t done, std::uint64_t total) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  if (shown_ && now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("\r\033[K{} {}/{}", what_, done, total);
  if (done > 0 && total > 0 && elapsed > 0.0) {
    const double rate = static_cast<double>(done) / elapsed;
    line += fmt::format(" ({} %), {:.1f}/s, {} left", done * 100 / total, rate,
                        as_clock(static_cast<double>(total - done) / rate));
  }
  fmt::print(stderr, "{}", line);
  std::fflush(stderr);
}

}  // namespace sixdof::cli
