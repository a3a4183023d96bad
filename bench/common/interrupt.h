#pragma once

#include <atomic>
#include <csignal>

#include <sixdof/base/error.h>

namespace sixdof {

/// While an object of this class exists, Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the program. The work
/// polls requested() between its steps and throws Interrupted, and every half-written file is removed on the way out. A
/// second signal ends the program at once. Use it only around work that polls the flag; one object at a time.
class InterruptGuard {
 public:
  InterruptGuard() {
    struct sigaction action = {};
    action.sa_handler = [](int /*signal*/) { signalled_.store(true, std::memory_order_relaxed); };
    sigemptyset(&action.sa_mask);
    // SA_RESETHAND: the second signal has its default action, which ends the program.
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &action, &old_interrupt_);
    sigaction(SIGTERM, &action, &old_terminate_);
  }
  ~InterruptGuard() {
    sigaction(SIGINT, &old_interrupt_, nullptr);
    sigaction(SIGTERM, &old_terminate_, nullptr);
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// True once a signal came; stays true for the rest of the program.
  static bool requested() { return signalled_.load(std::memory_order_relaxed); }

  /// @throws Interrupted once a signal came
  static void check() {
    if (requested()) throw Interrupted("interrupted");
  }

 private:
  static inline std::atomic<bool> signalled_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
  struct sigaction old_interrupt_ = {};
  struct sigaction old_terminate_ = {};
};

}  // namespace sixdof
