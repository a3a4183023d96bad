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

/// work() in a process of its own, which ends with the thread that waits for it, and take() here, which reads what
/// work() writes. The process has no files of the caller's, its standard streams are /dev/null (sanitizers keep their
/// standard error), signals have their defaults and Ctrl-C passes it by.
/// @throws SeparateFailure if the result is not whole, also for an exception in work(); what take() throws; Error if no
/// process can be made
void run_separately(const std::function<void(SeparateOutput&)>& work, const std::function<void(SeparateInput&)>& take,
                    const SeparateLimits& limits);

/// How a process ended, after waitpid(): "ended by signal 11 (Segmentation fault)", "ended with exit code 3".
std::string words_of_end(int wait_status);

/// A part of the machine's memory that leaves enough for other programs.
std::size_t default_memory_limit();

}  // namespace sixdof
