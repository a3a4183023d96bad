#include "bench/cli/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace sixdof::cli {

std::string as_clock(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

StatusLine::StatusLine(bool always) : terminal_(::isatty(STDERR_FILENO) == 1), visible_(terminal_ || always) {}

StatusLine::~StatusLine() {
  if (shown_ && terminal_) fmt::print(stderr, "\r\033[K");
}

bool StatusLine::due() const {
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10'000);
  return visible_ && (!shown_ || Clock::now() - last_ >= pause);
}

void StatusLine::show(const std::string& text) {
  if (!due()) return;
  last_ = Clock::now();
  shown_ = true;
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r\033[K" : "", text, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

ProgressLine::ProgressLine(std::string what, bool always) : line_(always), what_(std::move(what)) {}

void ProgressLine::show(std::uint64_t done, std::uint64_t total) {
  if (!line_.due()) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  std::string line = fmt::format("{} {}/{}", what_, done, total);
  if (done > 0 && total > 0 && elapsed > 0.0) {
    const double rate = static_cast<double>(done) / elapsed;
    line += fmt::format(" ({} %), {:.1f}/s, {} left", done * 100 / total, rate,
                        as_clock(static_cast<double>(total - done) / rate));
  }
  line_.show(line);
}

}  // namespace sixdof::cli
