#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <sixdof/base/error.h>

/// A function that runs in a process of its own: whatever it does, it ends nothing but itself.
///
/// The process is a fork without exec. A helper program would start as clean as any, but this is a static library in
/// anybody's program: nothing tells that program where a helper was installed, or moved to. A fork needs nothing but
/// the caller, whose memory it reads where it lies.
///
/// The caller may have other threads; the fork has only the calling one. That is safe as long as the function takes no
/// lock that another thread may hold at that moment. glibc makes malloc and streams usable in the fork (POSIX does not
/// promise it); exceptions and what the function makes itself are safe; parallel.h, HDF5 and objects that threads share
/// are not. A function that waits for such a lock is ended by its limit of time. Threads of the sanitizer for threads
/// are not watched in a fork.
namespace sixdof {

/// What a separate process may use. What the caller has already counts for nothing.
struct SeparateLimits {
  double processor_s = 60.0;
  double wall_s = 240.0;
  std::size_t memory_bytes = std::size_t{2} << 30;
  std::size_t stack_bytes = std::size_t{64} << 20;  ///< Of the main thread; others have the stack they began with.
  std::size_t result_bytes = std::size_t{16} << 30;
};

/// Why a separate process gave no result: "ended by signal 11 (Segmentation fault)", "took longer than 60 s".
struct SeparateFailure : Error {
  using Error::Error;
};

/// work() in a process of its own, which ends with the thread that waits for it. The process has no files of the
/// caller's, its standard streams are /dev/null (sanitizers keep their standard error), signals have their defaults
/// and Ctrl-C passes it by.
/// @returns what work() returned
/// @throws SeparateFailure if there is none, also for an exception; Error if no process can be made
std::string run_separately(const std::function<std::string()>& work, const SeparateLimits& limits);

/// How a process ended, after waitpid(): "ended by signal 11 (Segmentation fault)", "ended with exit code 3".
std::string words_of_end(int wait_status);

/// A part of the machine's memory that leaves enough for other programs.
std::size_t default_memory_limit();

}  // namespace sixdof
