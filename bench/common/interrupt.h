#pragma once

#include <csignal>

namespace sixdof {

/// While an object of this class exists, Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the program. The work
/// polls requested() between its steps and throws Interrupted, and every half-written file is removed on the way out. A
/// second signal ends the program at once. Use it only around work that polls the flag; one object at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// True once a signal came; stays true for the rest of the program.
  static bool requested();

  /// @throws Interrupted once a signal came
  static void check();

 private:
  struct sigaction old_interrupt_ = {};
  struct sigaction old_terminate_ = {};
};

}  // namespace sixdof
