#include "bench/common/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <utility>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"

namespace sixdof {
namespace {

std::atomic<bool> signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

/// Wakes the watching thread. sem_post() is one of the few calls that a signal handler may make.
sem_t wake;
[[maybe_unused]] const int wake_made = sem_init(&wake, 0, 0);

void on_signal(int /*signal*/) {
  const int error = errno;
  signalled.store(true, std::memory_order_relaxed);
  sem_post(&wake);
  errno = error;
}

}  // namespace

InterruptGuard::InterruptGuard(std::string program, std::function<void()> keep)
    : program_(std::move(program)), keep_(std::move(keep)), watcher_([this] { watch(); }) {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  // SA_RESETHAND: the second signal has its default action, which ends the program.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, &old_interrupt_);
  sigaction(SIGTERM, &action, &old_terminate_);
}

InterruptGuard::~InterruptGuard() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  sem_post(&wake);
  watcher_.join();
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
}

bool InterruptGuard::requested() { return signalled.load(std::memory_order_relaxed); }

void InterruptGuard::check() {
  if (requested()) throw Interrupted("interrupted");
}

void InterruptGuard::watch() {
  while (sem_wait(&wake) != 0) {
  }
  {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, k_grace_period, [this] { return ended_; })) return;
  }
  // The standard streams are not flushed: the work may hold their locks.
  if (keep_) keep_();
  const auto none_is_made = remove_own_partials();
  erase_status_line();
  print_message(program_, "interrupted");
  ::_exit(k_exit_interrupted);
}

}  // namespace sixdof
