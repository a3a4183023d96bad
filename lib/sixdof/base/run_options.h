#pragma once

#include <cstdint>
#include <functional>

#include <sixdof/base/error.h>

namespace sixdof {

/// Options of a long computation: threads, progress, cancellation.
struct RunOptions {
  /// 0: as many as the machine has. The result does not depend on it.
  unsigned threads = 0;
  /// Called now and then, one call at a time, with the steps done so far and in all; the function says what a step is.
  /// Not called if empty.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;
  /// Called before every step, from any thread: true ends the computation with Interrupted. Never ended if empty.
  std::function<bool()> cancelled;

  /// @throws Interrupted if `cancelled` says so.
  void check_cancelled() const {
    if (cancelled && cancelled()) throw Interrupted("interrupted");
  }
};

}  // namespace sixdof
