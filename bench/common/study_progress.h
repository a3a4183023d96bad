#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "bench/common/progress_line.h"

namespace sixdof {

/// What a command that takes minutes says on stderr, in lines that begin with its name: how much there is to do and
/// how long it will take, each part that has ended with the share of the whole and the time that is left, and at the
/// end what was left out and why. On a terminal a StatusLine shows between these lines what is going on.
///
/// Work is counted in a unit of the command's own, of which equal amounts take about the same time.
class StudyProgress {
 public:
  static constexpr double k_no_limit = std::numeric_limits<double>::infinity();

  /// Something that was not done.
  struct LeftOut {
    std::string what, why;
  };

  /// @param budget_s wall time from now on
  /// @param print gets every line instead of stderr; for tests
  explicit StudyProgress(std::string command, double budget_s = k_no_limit,
                         std::function<void(const std::string& line)> print = {});

  double left_s() const;  ///< Of the budget; negative once it is spent.

  /// "COMMAND: WHAT". @param work all that is to do
  void begin(const std::string& what, double work);

  /// "COMMAND: about 3.2 min in all". Without this call the first part that ends tells how long all will take.
  /// @param seconds for `work`, which begins now and replaces that of begin(); 0 where nothing is left
  void estimate(double seconds, double work);

  /// What is left to do, where it turns out to be other than it was said.
  void set_remaining(double work);

  /// "COMMAND: PART: 12 % done, 0:07:31 left".
  void finished(const std::string& part, double work);

  /// Of many small parts, `done` of `total` so far, each of which is work 1: a line for every twentieth of them.
  void counted(std::size_t done, std::size_t total, std::string_view unit);

  /// On terminals only.
  void status(std::string_view text) { line_.show(text); }

  void leave_out(std::string what, std::string why);
  const std::vector<LeftOut>& left_out() const { return left_out_; }

  /// "COMMAND: left out: WHAT: WHY" of each, or that nothing was.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds_since(Clock::time_point start);
  void say_whole(double seconds);
  void say(const std::string& text);

  const std::string command_;
  const double budget_s_;
  const std::function<void(const std::string&)> print_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point begun_ = start_;  ///< Of the work that is counted.
  double done_ = 0.0, total_ = 0.0;
  bool estimated_ = false;
  std::size_t told_ = 0;  ///< Twentieths.
  std::vector<LeftOut> left_out_;
  StatusLine line_;
};

}  // namespace sixdof
