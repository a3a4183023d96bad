#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <sixdof/base/error.h>

/// A function that runs in a process of its own, so that a crash or an endless loop ends that process only.
///
/// The process is a fork without exec: a static library in any program cannot know where a helper program is installed.
/// The fork has the calling thread only. The function must therefore not take a lock that another thread may hold at
/// that moment: malloc, streams and exceptions are safe with glibc; parallel.h, HDF5 and objects that threads share are
/// not. A function that waits for such a lock runs into its time limit. The thread sanitizer does not watch threads
/// that are started in a fork.
namespace sixdof {

/// What a separate process may use, on top of what the caller has already.
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

/// The result on its way to the caller, as bytes.
class SeparateOutput {
 public:
  explicit SeparateOutput(int descriptor) : descriptor_(descriptor) {}
  void write(const void* bytes, std::size_t count);
  /// Ends the process, the result being whole. Nothing is destroyed, which saves the time for it.
  [[noreturn]] void finish() const;
  bool begun() const { return begun_; }

 private:
  int descriptor_;
  bool begun_ = false;
};

/// The result as it comes to the caller.
class SeparateInput {
 public:
  virtual ~SeparateInput() = default;
  /// The next `count` bytes. @throws SeparateFailure if the process has ended, or exceeds a limit
  virtual void read(void* bytes, std::size_t count) = 0;
};

/// Runs work() in a process of its own and take(), which reads what work() writes, here. The process ends with the
/// calling thread. It has none of the caller's files, its standard streams are /dev/null (sanitizers keep standard
/// error), signals have their defaults and Ctrl-C is ignored.
/// @throws SeparateFailure if the result is incomplete, also for an exception in work(); what take() throws; Error if
/// no process can be made
void run_separately(const std::function<void(SeparateOutput&)>& work, const std::function<void(SeparateInput&)>& take,
                    const SeparateLimits& limits);

/// How a process ended, after waitpid(): "ended by signal 11 (Segmentation fault)", "ended with exit code 3".
std::string words_of_end(int wait_status);

/// 80 % of the machine's memory.
std::size_t default_memory_limit();

}  // namespace sixdof
