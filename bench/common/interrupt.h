#pragma once

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace sixdof {

/// While an object of this class exists, Ctrl-C (SIGINT) and SIGTERM end the work within a second. They set a flag; the
/// work polls requested() between its steps and throws Interrupted. If the object still exists k_grace_period after the
/// signal, because a step takes long, a watcher thread ends the program: it calls `keep`, removes the temporary files
/// of every AtomicFile, prints one line and exits with k_exit_interrupted. A second signal ends the program at once. At
/// most one object exists at a time.
class InterruptGuard {
 public:
  /// @param program named in the line on stderr
  /// @param keep saves what is finished; called from another thread while the work goes on. It does not throw.
  explicit InterruptGuard(std::string program, std::function<void()> keep = {});
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// True once a signal came; stays true for the rest of the program.
  static bool requested();

  /// @throws Interrupted once a signal came
  static void check();

  /// Together with `keep` and the exit this is less than a second.
  static constexpr std::chrono::milliseconds k_grace_period{700};

 private:
  void watch();

  const std::string program_;
  const std::function<void()> keep_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  struct sigaction old_interrupt_ = {};
  struct sigaction old_terminate_ = {};
  std::thread watcher_;
};

}  // namespace sixdof
