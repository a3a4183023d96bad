#include "bench/common/progress_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

namespace sixdof {
namespace {

constexpr const char* k_erase_line = "\r\033[K";

/// Columns that fit on one line of the terminal behind stderr. The last one stays free: some terminals wrap there.
std::size_t terminal_columns() {
  constexpr unsigned k_usual = 80;
  winsize size = {};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (known ? size.ws_col : k_usual) - 1u;
}

/// Whether stderr is a terminal that knows the codes for erasing a line.
bool can_rewrite_lines() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
}

}  // namespace

std::string as_clock(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string_view cut_to_columns(std::string_view text, std::size_t columns) {
  const auto continues_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; };
  std::size_t used = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (continues_character(text[i])) continue;
    if (used == columns) return text.substr(0, i);
    ++used;
  }
  return text;
}

StatusLine::StatusLine(bool always) : terminal_(can_rewrite_lines()), visible_(terminal_ || always) {}

bool StatusLine::due() const {
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10'000);
  return visible_ && (!shown_ || Clock::now() - last_ >= pause);
}

void StatusLine::show(std::string_view text) {
  if (!due()) return;
  last_ = Clock::now();
  shown_ = true;
  if (terminal_) {
    fmt::print(stderr, "{}{}", k_erase_line, cut_to_columns(text, terminal_columns()));
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void StatusLine::clear() {
  if (!shown_ || !terminal_) return;
  shown_ = false;
  fmt::print(stderr, "{}", k_erase_line);
  std::fflush(stderr);
}

void erase_status_line() {
  if (!can_rewrite_lines()) return;
  fmt::print(stderr, "{}", k_erase_line);
  std::fflush(stderr);
}

void ProgressLine::show(std::uint64_t done, std::uint64_t total, std::string_view detail) {
  if (!line_.due()) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  std::string line = fmt::format("{} {}/{}", what_, done, total);
  if (done > 0 && total > 0 && elapsed > 0.0) {
    const double rate = static_cast<double>(done) / elapsed;
    line += fmt::format(" ({} %), {:.1f}/s, {} left", done * 100 / total, rate,
                        as_clock(static_cast<double>(total - done) / rate));
  }
  if (!detail.empty()) line += fmt::format(": {}", detail);
  line_.show(line);
}

}  // namespace sixdof
