#include <sixdof/process/keeper.h>

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>

#include <sixdof/process/child_process.h>

// All of this runs in a copy of a process that may have had many threads: nothing is allocated, no lock is taken.
// Behind give_memory_back() there is no function but syscall(): the linker resolves a name at its first call, by tables
// that may have been given back.

namespace sixdof {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_can_give_memory_back = false;  // their own functions need it
#elif defined(__has_feature)
constexpr bool k_can_give_memory_back = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool k_can_give_memory_back = true;
#endif

/// Children are looked for so many times, k_pause apart: for those of a program that starts new ones all the time.
constexpr int k_most_passes = 5000;
constexpr timespec k_pause{0, 1'000'000};

/// In the process that is to be the program.
[[noreturn]] void become(const KeptProgram& program, pid_t keeper) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != keeper) ::_exit(k_not_started);
  ::setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  limit_resources(program.memory_bytes);
  ::dup2(program.input, STDIN_FILENO);
  ::dup2(program.output, STDOUT_FILENO);
  int place = STDERR_FILENO + 1;
  for (const int file : program.files) ::dup2(file, place++);
  ::execvp(program.words[0], program.words);
  ::_exit(k_not_started);
}

/// A line of /proc/self/maps: "7f00-7f20 rw-p 0000 00:00 0   [heap]".
struct Mapping {
  std::uintptr_t begin = 0, end = 0;
  bool is_private_data = false, has_file = false;

  bool holds(const void* address) const {
    const auto place = reinterpret_cast<std::uintptr_t>(address);
    return begin <= place && place < end;
  }
};

/// Takes the characters of a line one by one.
class MappingReader {
 public:
  /// @returns whether the line has ended
  bool take(char c) {
    if (c == '\n') return true;
    if (c == ' ' || (c == '-' && field_ == k_begin)) {
      ++field_;
      place_ = 0;
    } else if (field_ == k_begin || field_ == k_end) {
      std::uintptr_t& number = field_ == k_begin ? mapping.begin : mapping.end;
      number = number * 16 + static_cast<std::uintptr_t>(c <= '9' ? c - '0' : c - 'a' + 10);
    } else if (field_ == k_rights) {
      constexpr char k_wanted[] = "rw-p";
      if (place_ == 0) mapping.is_private_data = true;
      if (place_ < 4 && c != k_wanted[place_]) mapping.is_private_data = false;
      ++place_;
    } else if (field_ == k_inode && c != '0') {
      mapping.has_file = true;
    }
    return false;
  }
  Mapping mapping = {};

 private:
  enum Field {
    k_begin,
    k_end,
    k_rights,
    k_offset,
    k_device,
    k_inode
  };
  int field_ = k_begin, place_ = 0;
};

constexpr std::uintptr_t k_mebibyte = 1 << 20;

/// Gives the pages of a mapping back, but for a mebibyte around those of `needed` that it holds and what lies between
/// them: stack and thread-local data, which may lie in one mapping with what was allocated.
void give_back(const Mapping& mapping, const std::array<const void*, 2>& needed) {
  std::uintptr_t low = mapping.end, high = mapping.end;
  for (const void* const address : needed) {
    if (!mapping.holds(address)) continue;
    const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(address) / k_mebibyte * k_mebibyte;
    if (low == mapping.end || place - k_mebibyte < low) low = place - k_mebibyte;
    if (high == mapping.end || place + 2 * k_mebibyte > high) high = place + 2 * k_mebibyte;
  }
  if (low > mapping.begin) ::syscall(SYS_madvise, mapping.begin, low - mapping.begin, MADV_DONTNEED);
  if (high < mapping.end) ::syscall(SYS_madvise, high, mapping.end - high, MADV_DONTNEED);
}

/// Gives back what the caller had allocated: else it would copy every page that it changes, and what it frees would
/// stay taken. Small mappings stay, and those behind a file's, which are its variables.
void give_memory_back() {
  if (!k_can_give_memory_back) return;
  const auto file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, "/proc/self/maps", O_RDONLY | O_CLOEXEC));
  if (file < 0) return;
  std::array<char, 2048> block;
  MappingReader line;
  std::uintptr_t end_of_file = 0;
  for (long count = 0; (count = ::syscall(SYS_read, file, block.data(), block.size())) > 0;) {
    for (long i = 0; i < count; ++i) {
      if (!line.take(block[static_cast<std::size_t>(i)])) continue;
      const Mapping& found = line.mapping;
      if (found.has_file) {
        end_of_file = found.end;
      } else if (found.is_private_data && found.end - found.begin > k_mebibyte && found.begin != end_of_file) {
        give_back(found, {&line, &errno});
      }
      line = MappingReader();
    }
  }
  ::syscall(SYS_close, file);
}

/// Signal sets as the kernel has them: a bit for each from 1 on.
using SignalBits = std::uint64_t;

constexpr SignalBits bit_of(int signal) { return SignalBits{1} << (signal - 1); }

/// @returns SIGCHLD or SIGTERM; -1 if neither came within the time
int await_signal(const timespec* time) {
  const SignalBits awaited = bit_of(SIGCHLD) | bit_of(SIGTERM);
  return static_cast<int>(::syscall(SYS_rt_sigtimedwait, &awaited, nullptr, time, sizeof awaited));
}

/// A child that has ended, or one that has that number; si_pid is 0 if there is none.
siginfo_t ended_child(idtype_t which, pid_t child, int more_options) {
  siginfo_t info;
  info.si_pid = 0;
  ::syscall(SYS_waitid, which, child, &info, WEXITED | WNOHANG | more_options, nullptr);
  return info;
}

/// Waits for the end of the program, whose number stays taken. Children of others that have become this process' own
/// are let go. @returns false if it is to be ended
bool await_end(pid_t program) {
  while (true) {
    while (true) {
      const siginfo_t info = ended_child(P_ALL, 0, WNOWAIT);
      if (info.si_pid == program) return true;
      if (info.si_pid == 0) break;
      ended_child(P_PID, info.si_pid, 0);
    }
    if (await_signal(nullptr) == SIGTERM) return false;
  }
}

void kill_children() {
  const auto file =
      static_cast<int>(::syscall(SYS_openat, AT_FDCWD, "/proc/thread-self/children", O_RDONLY | O_CLOEXEC));
  if (file < 0) return;  // a kernel without it: the program's group is ended, no more
  std::array<char, 2048> block;
  long child = 0;
  for (long count = 0; (count = ::syscall(SYS_read, file, block.data(), block.size())) > 0;) {
    for (long i = 0; i < count; ++i) {
      const char c = block[static_cast<std::size_t>(i)];
      if (c >= '0' && c <= '9') {
        child = child * 10 + (c - '0');
      } else {
        if (child > 0) ::syscall(SYS_kill, child, SIGKILL);
        child = 0;
      }
    }
  }
  ::syscall(SYS_close, file);
}

/// Children of those that are killed become this process' own, until there is none. @returns how the program ended
siginfo_t kill_all(pid_t program) {
  ::syscall(SYS_kill, -program, SIGKILL);
  siginfo_t end;
  end.si_code = CLD_KILLED;
  end.si_status = SIGKILL;
  for (int pass = 0; pass < k_most_passes; ++pass) {
    kill_children();
    siginfo_t info;
    long result = 0;
    while (true) {
      info.si_pid = 0;
      result = ::syscall(SYS_waitid, P_ALL, 0, &info, WEXITED | WNOHANG, nullptr);
      if (result != 0 || info.si_pid == 0) break;
      if (info.si_pid == program) end = info;
    }
    if (result != 0) break;  // no children
    await_signal(&k_pause);
  }
  return end;
}

[[noreturn]] void end_like(const siginfo_t& end) {
  if (end.si_code != CLD_EXITED) {
    const SignalBits none = 0;
    ::syscall(SYS_rt_sigprocmask, SIG_SETMASK, &none, nullptr, sizeof none);
    ::syscall(SYS_kill, ::syscall(SYS_getpid), end.si_status);
  }
  while (true) ::syscall(SYS_exit_group, end.si_status);
}

[[noreturn]] void keep(const KeptProgram& program, pid_t caller) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != caller) ::_exit(k_not_started);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  ::prctl(PR_SET_NAME, "sixdof-keeper");
  ::setpgid(0, 0);
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);  // all are blocked
  const pid_t keeper = ::getpid();
  const pid_t child = ::vfork();  // copies nothing
  if (child == 0) become(program, keeper);
  if (child < 0) ::_exit(k_not_started);
  ::setpgid(child, child);
  limit_resources(0);
  if (::syscall(SYS_close_range, 0u, ~0u, 0u) != 0) {
    for (int file = static_cast<int>(::sysconf(_SC_OPEN_MAX)); file-- > 0;) ::close(file);
  }
  give_memory_back();
  await_end(child);
  end_like(kill_all(child));
}

}  // namespace

pid_t start_kept(const KeptProgram& program) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t caller = ::getpid();
  const pid_t keeper = ::fork();
  if (keeper == 0) keep(program, caller);
  const int error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return keeper;
}

}  // namespace sixdof
