#include <sixdof/base/separate_process.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>

namespace sixdof {
namespace {

using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_sanitized = true;
#else
constexpr bool k_sanitized = false;
#endif

/// Exit codes of the separate process. Others may come from work(), which may call exit().
constexpr int k_done = 0, k_not_started = 125, k_out_of_memory = 126;

/// The first byte: what follows.
constexpr char k_result = 'r', k_exception = 'e';

[[noreturn]] void end_for_memory() { ::_exit(k_out_of_memory); }

/// Data of this process so far, which a limit counts (RLIMIT_DATA); with sanitizers also what they have mapped.
std::size_t data_bytes() {
  std::ifstream file("/proc/self/statm");
  std::array<std::size_t, 6> pages{};  // size, resident, shared, text, none, data and stack
  for (std::size_t& count : pages) file >> count;
  return pages[5] * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Limits a resource, never above what this process may have. Beyond `most` a signal comes where there is one for it,
/// beyond `hard` a kill.
void limit(__rlimit_resource resource, rlim_t most, rlim_t hard) {
  rlimit allowed{};
  if (::getrlimit(resource, &allowed) != 0) return;
  const rlimit both{std::min(most, allowed.rlim_max), std::min(hard, allowed.rlim_max)};
  ::setrlimit(resource, &both);
}

void limit_all(const SeparateLimits& limits, std::size_t data_before) {
  const rlim_t data = data_before + limits.memory_bytes, stack = limits.stack_bytes;
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.processor_s));
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_DATA, data, data);
  limit(RLIMIT_STACK, stack, stack);
  limit(RLIMIT_CPU, seconds, seconds + 1);
}

void forget_handlers() {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  ::signal(SIGINT, SIG_IGN);
  ::signal(SIGPIPE, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// @returns the descriptor of the result, the only one left beside the standard streams
int forget_files(int output) {
  constexpr int k_place = STDERR_FILENO + 1;
  const int nothing = ::open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
      if (!k_sanitized || stream != STDERR_FILENO) ::dup2(nothing, stream);
    }
  }
  if (output != k_place) ::dup2(output, k_place);
  ::close_range(k_place + 1, ~0u, 0);
  return k_place;
}

void write_or_exit(int output, std::string_view bytes) {
  if (write_all(output, bytes) != 0) ::_exit(k_not_started);  // the caller has gone
}

/// In the new process.
[[noreturn]] void work_and_exit(const std::function<void(SeparateOutput&)>& work, const SeparateLimits& limits,
                                std::size_t data_before, int output, pid_t caller) noexcept {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != caller) ::_exit(k_not_started);
  output = forget_files(output);
  forget_handlers();
  limit_all(limits, data_before);
  std::set_terminate([] { std::abort(); });
  std::set_new_handler(end_for_memory);
  SeparateOutput result(output);
  std::string words;
  try {
    work(result);
    result.finish();
  } catch (const std::bad_alloc&) {
    end_for_memory();
  } catch (const std::exception& e) {
    words = e.what();
  }
  if (result.begun()) ::_exit(k_not_started);
  write_or_exit(output, std::string(1, k_exception) + words);
  ::_exit(k_done);
}

/// The caller's side: reads from the process, and ends it.
class Waiting : public SeparateInput {
 public:
  Waiting(pid_t process, int input, const SeparateLimits& limits)
      : process_(process), input_(input), limits_(limits), end_(Clock::now() + duration(limits.wall_s)) {}
  ~Waiting() override {
    end();
    ::close(input_);
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  void read(void* bytes, std::size_t count) override {
    if (!begun_) begin();
    if (count > limits_.result_bytes - got_) {
      throw SeparateFailure(fmt::format("gave more than {} bytes", limits_.result_bytes));
    }
    got_ += count;
    if (read_some(static_cast<char*>(bytes), count) < count) fail();
  }

 private:
  static Clock::duration duration(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  void begin() {
    char kind = k_result;
    if (read_some(&kind, 1) == 0) fail();
    begun_ = true;
    if (kind != k_exception) return;
    constexpr std::size_t k_longest_words = 4096;
    std::string words(k_longest_words, '\0');
    words.resize(read_some(words.data(), words.size()));
    throw SeparateFailure("ended by an exception: " + words);
  }

  /// Reads `count` bytes; fewer if the process has closed its side before.
  std::size_t read_some(char* bytes, std::size_t count) {
    for (std::size_t read = 0; read < count;) {
      const ssize_t got = ::read(input_, bytes + read, count - read);
      if (got > 0) {
        read += static_cast<std::size_t>(got);
      } else if (got == 0) {
        return read;
      } else if (errno == EAGAIN) {
        wait_for_bytes();
      } else if (errno != EINTR) {
        throw SeparateFailure(fmt::format("cannot be heard: {}", std::strerror(errno)));
      }
    }
    return count;
  }

  void wait_for_bytes() {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end_ - Clock::now()).count();
    if (left <= 0) throw SeparateFailure(fmt::format("took longer than {} s", limits_.wall_s));
    pollfd waiting{input_, POLLIN, 0};
    constexpr std::int64_t k_longest_ms = 1'000'000;
    ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left, k_longest_ms)));
  }

  /// The process has closed its side without a result, by ending: a kill changes nothing about how it ended.
  [[noreturn]] void fail() {
    end();
    if (WIFSIGNALED(status_) && WTERMSIG(status_) == SIGXCPU) {
      throw SeparateFailure(fmt::format("took longer than {} s of processor time", limits_.processor_s));
    }
    if (WIFEXITED(status_) && WEXITSTATUS(status_) == k_out_of_memory) {
      throw SeparateFailure(
          fmt::format("ran out of {:.1f} GB of memory", static_cast<double>(limits_.memory_bytes) / 1e9));
    }
    throw SeparateFailure(words_of_end(status_));
  }

  void end() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }

  pid_t process_;
  int input_;
  const SeparateLimits& limits_;
  Clock::time_point end_;
  std::size_t got_ = 0;
  bool begun_ = false;
  int status_ = 0;
};

}  // namespace

std::string words_of_end(int wait_status) {
  if (!WIFSIGNALED(wait_status)) return fmt::format("ended with exit code {}", WEXITSTATUS(wait_status));
  const int signal = WTERMSIG(wait_status);
  const char* const name = ::sigdescr_np(signal);
  return fmt::format("ended by signal {} ({})", signal, name == nullptr ? "unknown" : name);
}

std::size_t default_memory_limit() {
  constexpr double k_share = 0.8;
  const double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return static_cast<std::size_t>(k_share * bytes);
}

void SeparateOutput::write(const void* bytes, std::size_t count) {
  if (!begun_) write_or_exit(descriptor_, {&k_result, 1});
  begun_ = true;
  write_or_exit(descriptor_, {static_cast<const char*>(bytes), count});
}

void SeparateOutput::finish() const { ::_exit(k_done); }

void run_separately(const std::function<void(SeparateOutput&)>& work, const std::function<void(SeparateInput&)>& take,
                    const SeparateLimits& limits) {
  const std::size_t data_before = data_bytes();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(fmt::format("no pipe: {}", std::strerror(errno)));
  // No handler of the caller's runs in the new process before it has forgotten them.
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t caller = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) work_and_exit(work, limits, data_before, ends[1], caller);
  const int error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(ends[1]);
  if (process < 0) {
    ::close(ends[0]);
    throw Error(fmt::format("no process can be made: {}", std::strerror(error)));
  }
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  constexpr int k_pipe_bytes = 1 << 20;
  ::fcntl(ends[0], F_SETPIPE_SZ, k_pipe_bytes);
  Waiting waiting(process, ends[0], limits);
  take(waiting);
}

}  // namespace sixdof
