#include <sixdof/process/shared_memory.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/process/child_process.h>

namespace sixdof {

MemoryFile::MemoryFile(const char* name, std::span<const std::byte> content) : name_(name) {
  const int made = ::memfd_create(name, MFD_CLOEXEC);
  if (made < 0) throw Error(fmt::format("memfd_create: {}", std::strerror(errno)));
  descriptor_ = high_descriptor(made);
  try {
    replace(content);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

void MemoryFile::replace(std::span<const std::byte> content) {
  int failure = 0;
  if (::ftruncate(descriptor_, 0) != 0 || ::lseek(descriptor_, 0, SEEK_SET) != 0) failure = errno;
  if (failure == 0) failure = write_all(descriptor_, {reinterpret_cast<const char*>(content.data()), content.size()});
  if (failure != 0)
    throw Error(fmt::format("{}: a file in memory of {} bytes: {}", name_, content.size(), std::strerror(failure)));
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

std::string path_of_descriptor(int number) { return fmt::format("/proc/self/fd/{}", number); }

SharedCounter::SharedCounter(int descriptor) { map(descriptor, "progress"); }

SharedCounter::SharedCounter(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) throw BadFile(path, std::strerror(errno));
  try {
    map(descriptor, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);
}

SharedCounter::~SharedCounter() { ::munmap(value_, sizeof(*value_)); }

void SharedCounter::map(int descriptor, const std::string& name) {
  // Behind the end of a file, an access to its memory ends the process (SIGBUS).
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw BadFile(name, std::strerror(errno));
  if (status.st_size < static_cast<off_t>(sizeof(*value_))) throw BadFile(name, "fewer than 8 bytes");
  void* const memory = ::mmap(nullptr, sizeof(*value_), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) throw BadFile(name, std::strerror(errno));
  value_ = static_cast<std::uint64_t*>(memory);
}

}  // namespace sixdof
