#include <sixdof/process/child_process.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/process/keeper.h>

namespace sixdof {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int k_poll_ms = 50;                             ///< Time between two checks of a time limit.
constexpr milliseconds k_exit_timeout{200};               ///< To end after its input was closed.
constexpr milliseconds k_exit_timeout_after_close{1000};  ///< To end after it has closed its output.
constexpr milliseconds k_keeper_exit_timeout{10'000};     ///< To end after SIGTERM; then it is killed.
constexpr int k_first_high_descriptor = 100;              ///< Above those that a program finds.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_can_limit_memory = false;
#else
constexpr bool k_can_limit_memory = true;
#endif

[[noreturn]] void throw_errno(const char* what) { throw Error(fmt::format("{}: {}", what, std::strerror(errno))); }

/// Waits until it is true. @returns whether it is, at the end of the timeout at the latest
template <class Condition>
bool becomes_true(const Condition& condition, milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  bool is_true = false;
  while (!(is_true = condition()) && Clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  return is_true;
}

/// Processes that the kernel has ended for want of memory since it started; 0 where it does not tell.
long count_kernel_kills() {
  std::ifstream file("/proc/vmstat");
  std::string name;
  for (long value = 0; file >> name >> value;) {
    if (name == "oom_kill") return value;
  }
  return 0;
}

/// The same for all calls of a thread, and of no thread that begins while somebody has it.
const std::shared_ptr<const char>& this_thread() {
  thread_local const auto identity = std::make_shared<const char>();
  return identity;
}

}  // namespace

TimeLimit expires_after(double seconds) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  return [end] { return Clock::now() >= end; };
}

ChildFailure how_it_ended(int wait_status, bool ran_out_of_memory) {
  const bool started = WIFSIGNALED(wait_status) || WEXITSTATUS(wait_status) != k_not_started;
  const std::string words =
      started ? words_of_end(wait_status) : fmt::format("could not be started (exit code {})", k_not_started);
  if (!ran_out_of_memory) return {Status::crashed, words};
  return {Status::out_of_memory, "out of memory: " + words};
}

void write_line(int output, std::string line) {
  line += '\n';
  if (const int failure = write_all(output, line)) {
    throw Error(fmt::format("a reply cannot be written: {}", std::strerror(failure)));
  }
}

int high_descriptor(int descriptor) {
  const int high = ::fcntl(descriptor, F_DUPFD_CLOEXEC, k_first_high_descriptor);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  if (high < 0) throw_errno("file descriptor");
  return high;
}

void limit_resources(std::size_t memory_bytes) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (!k_can_limit_memory || memory_bytes == 0) return;
  const rlimit memory{memory_bytes, memory_bytes};
  ::setrlimit(RLIMIT_DATA, &memory);
}

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::vector<int>& files,
                           std::size_t memory_bytes)
    : thread_(this_thread()), kernel_kills_(count_kernel_kills()) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  // A socket rather than a pipe: writing to a program that has ended raises no SIGPIPE (MSG_NOSIGNAL).
  std::array<int, 2> input{}, output{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input.data()) != 0) throw_errno("socketpair");
  if (::pipe2(output.data(), O_CLOEXEC) != 0) throw_errno("pipe");
  input_ = high_descriptor(input[0]);
  output_ = high_descriptor(output[0]);
  const int its_input = high_descriptor(input[1]), its_output = high_descriptor(output[1]);
  process_ = start_kept({pointers.data(), its_input, its_output, files, memory_bytes});
  const int error = errno;
  ::close(its_input);
  ::close(its_output);
  if (process_ < 0) {
    ::close(input_);
    ::close(output_);
    errno = error;
    throw_errno("fork");
  }
  ::fcntl(input_, F_SETFL, O_NONBLOCK);
  ::fcntl(output_, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  ::close(input_);
  if (!ended_) becomes_true([this] { return has_ended(); }, k_exit_timeout);
  end();
  ::close(output_);
}

bool ChildProcess::ends_with_this_thread() const { return thread_ == this_thread(); }

/// Whether it has ended by itself. Its number stays taken until end().
bool ChildProcess::has_ended() const {
  siginfo_t info{};
  const int result = ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
  return (result != 0 && errno == ECHILD) || info.si_pid != 0;
}

/// Kills the program and what it has started.
void ChildProcess::end() {
  if (ended_) return;
  ::kill(process_, SIGTERM);
  if (!becomes_true([this] { return has_ended(); }, k_keeper_exit_timeout)) ::kill(process_, SIGKILL);
  while (::waitpid(process_, &wait_status_, 0) < 0 && errno == EINTR) {
  }
  ended_ = true;
}

void ChildProcess::give_up(Status status, const std::string& words) {
  end();
  throw ChildFailure(status, words);
}

/// The program has closed its side, mostly by ending.
void ChildProcess::closed() {
  if (!becomes_true([this] { return has_ended(); }, k_exit_timeout_after_close))
    give_up(Status::crashed, "closed its standard streams");
  end();
  read_what_is_there();  // its note may be unread: of a program that ended before it was asked
  while (take_line()) {
  }
  const bool killed = WIFSIGNALED(wait_status_) && WTERMSIG(wait_status_) == SIGKILL;
  const ChildFailure failure =
      how_it_ended(wait_status_, noted_memory_ || (killed && count_kernel_kills() > kernel_kills_));
  throw failure;
}

void ChildProcess::send(std::string_view line, const TimeLimit& expired) {
  const std::string text = std::string(line) + "\n";
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::send(input_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd waiting{input_, POLLOUT, 0};
      ::poll(&waiting, 1, k_poll_ms);
      if (expired()) give_up(Status::timed_out, "did not read the request within the limit");
    } else if (errno != EINTR) {
      read_what_is_there();
      if (received_.find('\n') != std::string::npos) return;  // written before it was asked: for receive()
      closed();
    }
  }
}

std::optional<std::string> ChildProcess::take_line() {
  while (true) {
    const std::size_t end_of_line = received_.find('\n', searched_);
    if (end_of_line == std::string::npos) break;
    std::string line = received_.substr(0, end_of_line);
    received_.erase(0, end_of_line + 1);
    searched_ = 0;
    if (line != k_memory_note) return line;
    noted_memory_ = true;
  }
  searched_ = received_.size();
  return std::nullopt;
}

void ChildProcess::read_what_is_there() {
  std::array<char, 1 << 12> block;
  ssize_t count = 0;
  while ((count = ::read(output_, block.data(), block.size())) > 0 && received_.size() <= k_longest_line) {
    received_.append(block.data(), static_cast<std::size_t>(count));
  }
}

void ChildProcess::expect_no_line() {
  read_what_is_there();
  if (take_line()) give_up(Status::failed, "wrote a line that answers no request");
}

std::string ChildProcess::receive(const TimeLimit& expired) {
  while (true) {
    if (auto line = take_line()) return *std::move(line);
    if (received_.size() > k_longest_line) {
      give_up(Status::failed, fmt::format("wrote a line of more than {} bytes", k_longest_line));
    }
    std::array<char, 1 << 16> block;
    const ssize_t count = ::read(output_, block.data(), block.size());
    if (count > 0) {
      received_.append(block.data(), static_cast<std::size_t>(count));
      if (noted_memory_ && expired()) give_up(Status::timed_out, "gave no answer in time");  // notes without an end
    } else if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      pollfd waiting{output_, POLLIN, 0};
      if (::poll(&waiting, 1, k_poll_ms) <= 0 && expired()) give_up(Status::timed_out, "gave no answer in time");
    } else if (count == 0 || errno != EINTR) {
      closed();
    }
  }
}

}  // namespace sixdof
