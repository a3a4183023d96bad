// Loaded before libc (LD_PRELOAD): one chosen call that writes to the disk fails, in this process or any that it
// starts.
//
// SIXDOF_FAULT       a file of two 64-bit counts that all processes share: calls so far, and faults so far
// SIXDOF_FAULT_AT    which call fails, from 1 on; 0: none, they are counted
// SIXDOF_FAULT_KIND  ENOSPC, EIO, EDQUOT, EFBIG: it fails so; short: a write does half, and all later ones fail with
//                    ENOSPC; lost: a write says that it was done, and was not
// SIXDOF_FAULT_ONCE  1: later calls succeed; else they fail, too, as on a disk that stays full
//
// Calls are those on regular files (and the flushing of folders), open() that makes a file, and calls that make names.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

enum class Answer {
  go_on,
  fail,
  half,
  pretend
};

struct Shared {
  std::atomic<std::uint64_t> calls, faults;
};

struct Plan {
  Shared* shared = nullptr;
  std::uint64_t at = 0;
  int failure = ENOSPC;
  bool once = false, half = false, pretend = false;

  Plan() {
    const char* const file = std::getenv("SIXDOF_FAULT");
    if (file == nullptr) return;
    const auto descriptor = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CLOEXEC, 0));
    if (descriptor < 0) return;
    void* const memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::syscall(SYS_close, descriptor);
    if (memory == MAP_FAILED) return;
    shared = static_cast<Shared*>(memory);
    const auto text = [](const char* name) {
      const char* const value = std::getenv(name);
      return value == nullptr ? "" : value;
    };
    at = std::strtoull(text("SIXDOF_FAULT_AT"), nullptr, 10);
    once = std::strcmp(text("SIXDOF_FAULT_ONCE"), "1") == 0;
    const char* const kind = text("SIXDOF_FAULT_KIND");
    half = std::strcmp(kind, "short") == 0;
    pretend = std::strcmp(kind, "lost") == 0;
    if (std::strcmp(kind, "EIO") == 0) failure = EIO;
    if (std::strcmp(kind, "EDQUOT") == 0) failure = EDQUOT;
    if (std::strcmp(kind, "EFBIG") == 0) failure = EFBIG;
  }
};

/// Counts a call. @param writes bytes that have a half
Answer next(bool writes) {
  static Plan* const plan = new Plan;  // never destroyed: calls go on to the last
  if (plan->shared == nullptr) return Answer::go_on;
  const std::uint64_t number = plan->shared->calls.fetch_add(1) + 1;
  if (plan->at == 0 || number < plan->at) return Answer::go_on;
  if (number > plan->at && (plan->once || plan->pretend)) return Answer::go_on;
  if (plan->pretend && !writes) return Answer::go_on;
  plan->shared->faults.fetch_add(1);
  errno = plan->failure;
  if (plan->pretend) return Answer::pretend;
  return plan->half && writes && number == plan->at ? Answer::half : Answer::fail;
}

/// Memory that processes share (memfd_create) has no name.
bool is_regular(int descriptor, bool or_folder = false) {
  const int before = errno;
  struct stat state = {};
  const bool known = ::fstat(descriptor, &state) == 0;
  errno = before;
  return known && state.st_nlink > 0 && (S_ISREG(state.st_mode) || (or_folder && S_ISDIR(state.st_mode)));
}

bool is_written(int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY && is_regular(descriptor);
}

/// @param write called with the number of bytes
template <class Write>
ssize_t write_bytes(int descriptor, std::size_t size, const Write& write) {
  if (!is_regular(descriptor)) return write(size);
  switch (next(size > 0)) {
    case Answer::go_on:
      return write(size);
    case Answer::half:
      return size > 1 ? write(size / 2) : -1;
    case Answer::pretend:
      return static_cast<ssize_t>(size);
    case Answer::fail:
      break;
  }
  return -1;
}

template <class Call>
int other_call(bool counts, const Call& call) {
  return counts && next(false) == Answer::fail ? -1 : call();
}

std::size_t bytes_of(const iovec* parts, int count) {
  std::size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += parts[i].iov_len;
  return bytes;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  return write_bytes(descriptor, size, [&](std::size_t n) { return ::syscall(SYS_write, descriptor, bytes, n); });
}

ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off64_t at) {
  return write_bytes(descriptor, size,
                     [&](std::size_t n) { return ::syscall(SYS_pwrite64, descriptor, bytes, n, at); });
}

ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t at) {
  return pwrite64(descriptor, bytes, size, at);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  return write_bytes(descriptor, bytes_of(parts, count), [&](std::size_t n) -> ssize_t {
    if (n == bytes_of(parts, count) || count == 0) return ::syscall(SYS_writev, descriptor, parts, count);
    return ::syscall(SYS_write, descriptor, parts[0].iov_base, parts[0].iov_len / 2);
  });
}

ssize_t pwritev64(int descriptor, const iovec* parts, int count, off64_t at) {
  return write_bytes(descriptor, bytes_of(parts, count), [&](std::size_t n) -> ssize_t {
    if (n == bytes_of(parts, count) || count == 0) return ::syscall(SYS_pwritev, descriptor, parts, count, at, 0);
    return ::syscall(SYS_pwrite64, descriptor, parts[0].iov_base, parts[0].iov_len / 2, at);
  });
}

ssize_t pwritev(int descriptor, const iovec* parts, int count, off_t at) {
  return pwritev64(descriptor, parts, count, at);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  return other_call(is_regular(descriptor),
                    [&] { return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size)); });
}

int ftruncate(int descriptor, off_t size) noexcept { return ftruncate64(descriptor, size); }

int fsync(int descriptor) {
  return other_call(is_regular(descriptor, true), [&] { return static_cast<int>(::syscall(SYS_fsync, descriptor)); });
}

int fdatasync(int descriptor) {
  return other_call(is_regular(descriptor, true),
                    [&] { return static_cast<int>(::syscall(SYS_fdatasync, descriptor)); });
}

/// Closes in any case, as Linux does.
int close(int descriptor) {
  if (!is_written(descriptor) || next(false) != Answer::fail) return static_cast<int>(::syscall(SYS_close, descriptor));
  const int failure = errno;
  ::syscall(SYS_close, descriptor);
  errno = failure;
  return -1;
}

int fchmod(int descriptor, mode_t mode) noexcept {
  return other_call(is_regular(descriptor), [&] { return static_cast<int>(::syscall(SYS_fchmod, descriptor, mode)); });
}

int openat64(int folder, const char* name, int flags, ...) {
  mode_t mode = 0;
  if ((flags & (O_CREAT | __O_TMPFILE)) != 0) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  return other_call((flags & O_CREAT) != 0,
                    [&] { return static_cast<int>(::syscall(SYS_openat, folder, name, flags, mode)); });
}

int openat(int folder, const char* name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openat64(folder, name, flags, mode);
}

int open64(const char* name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openat64(AT_FDCWD, name, flags, mode);
}

int open(const char* name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openat64(AT_FDCWD, name, flags, mode);
}

int renameat2(int from, const char* old_name, int to, const char* new_name, unsigned flags) noexcept {
  return other_call(true,
                    [&] { return static_cast<int>(::syscall(SYS_renameat2, from, old_name, to, new_name, flags)); });
}

int renameat(int from, const char* old_name, int to, const char* new_name) noexcept {
  return renameat2(from, old_name, to, new_name, 0);
}

int rename(const char* old_name, const char* new_name) noexcept {
  return renameat2(AT_FDCWD, old_name, AT_FDCWD, new_name, 0);
}

int linkat(int from, const char* old_name, int to, const char* new_name, int flags) noexcept {
  return other_call(true, [&] { return static_cast<int>(::syscall(SYS_linkat, from, old_name, to, new_name, flags)); });
}

int link(const char* old_name, const char* new_name) noexcept {
  return linkat(AT_FDCWD, old_name, AT_FDCWD, new_name, 0);
}

int mkdir(const char* name, mode_t mode) noexcept {
  return other_call(true, [&] { return static_cast<int>(::syscall(SYS_mkdirat, AT_FDCWD, name, mode)); });
}

}  // extern "C"
