#pragma once

#include <csignal>

namespace sixdof {

/// While one of these lives, Ctrl-C (SIGINT) and SIGTERM ask instead of kill: the work looks at requested() between its
/// steps, throws Interrupted, and every half-written file is removed on the way out. A second Ctrl-C kills at once.
/// Make it only around work that looks; one at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// True once the user asked; stays true for the rest of the program.
  static bool requested();

  /// @throws Interrupted once the user asked.
  static void check();

 private:
  struct sigaction old_interrupt_ = {};
  struct sigaction old_terminate_ = {};
};

}  // namespace sixdof
