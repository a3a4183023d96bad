#include "bench/common/study_progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "bench/common/duration.h"

namespace sixdof {
namespace {

/// Lines about many small parts.
constexpr std::size_t k_counted_lines = 20;

}  // namespace

StudyProgress::StudyProgress(std::string command, double budget_s, std::function<void(const std::string& line)> print)
    : command_(std::move(command)), budget_s_(budget_s), print_(std::move(print)) {}

double StudyProgress::seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double StudyProgress::left_s() const { return budget_s_ - seconds_since(start_); }

void StudyProgress::say(const std::string& text) {
  const std::string line = fmt::format("{}: {}", command_, text);
  if (print_) return print_(line);
  line_.clear();
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

void StudyProgress::begin(const std::string& what, double work) {
  say(what);
  begun_ = Clock::now();
  done_ = 0.0;
  total_ = work;
}

void StudyProgress::say_whole(double seconds) {
  std::string text = fmt::format("about {} in all", duration_text(seconds));
  if (std::isfinite(budget_s_)) text += fmt::format(", the budget is {}", duration_text(budget_s_));
  say(text);
}

void StudyProgress::estimate(double seconds, double work) {
  if (seconds > 0.0) say_whole(seconds);
  if (seconds <= 0.0) say("nothing is left to measure");
  estimated_ = true;
  begun_ = Clock::now();
  done_ = 0.0;
  total_ = work;
}

void StudyProgress::set_remaining(double work) { total_ = done_ + work; }

void StudyProgress::finished(const std::string& part, double work) {
  done_ += work;
  total_ = std::max(total_, done_);
  const double elapsed = seconds_since(begun_);
  const double all = done_ > 0.0 ? elapsed * total_ / done_ : 0.0;
  if (!estimated_) say_whole(all);
  estimated_ = true;
  const double left = std::max(0.0, std::min(left_s(), all - elapsed));
  const double percent = total_ > 0.0 ? std::floor(100.0 * done_ / total_) : 100.0;
  say(fmt::format("{}: {:.0f} % done, {} left", part, percent, as_clock(left)));
}

void StudyProgress::counted(std::size_t done, std::size_t total, std::string_view unit) {
  status(fmt::format("{}: {} of {} {}", command_, done, total, unit));
  const std::size_t reached = total == 0 ? k_counted_lines : k_counted_lines * done / total;
  if (reached <= told_) return;
  told_ = reached;
  finished(fmt::format("{} of {} {}", done, total, unit), static_cast<double>(done) - done_);
}

void StudyProgress::leave_out(std::string what, std::string why) {
  left_out_.push_back({std::move(what), std::move(why)});
}

void StudyProgress::end() {
  for (const auto& [what, why] : left_out_) say(fmt::format("left out: {}: {}", what, why));
  if (left_out_.empty()) say("nothing was left out");
}

}  // namespace sixdof
