#include "bench/harness/progress.h"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace sixdof::bench {
namespace {

constexpr const char* k_wipe_line = "\r\033[K";

}  // namespace

std::string in_words(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(seconds / 60.0 + 0.5);
  if (minutes < 60) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

Progress::Progress(std::size_t total) : shown_(::isatty(STDERR_FILENO) == 1), total_(total) {}

void Progress::begin(const std::string& name) {
  const std::size_t done = begun_++;
  if (!shown_) return;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::string left;
  if (done > 0 && total_ > done) {
    const double each = elapsed / static_cast<double>(done);
    left = ", about " + in_words(each * static_cast<double>(total_ - done)) + " left";
  }
  fmt::print(stderr, "{}[{}/{}] {}{}: {}", k_wipe_line, done + 1, total_, in_words(elapsed), left, name);
  std::fflush(stderr);
}

void Progress::wipe() {
  if (!shown_) return;
  fmt::print(stderr, "{}", k_wipe_line);
  std::fflush(stderr);
}

}  // namespace sixdof::bench
