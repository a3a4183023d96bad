#include <sixdof/base/atomic_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

std::filesystem::path directory_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

constexpr std::string_view k_partial = ".partial";

std::string temporary_prefix(const std::filesystem::path& target) { return "." + target.filename().string() + "."; }

/// Flushes a file or directory to the disk. @return errno, 0 on success
int flush_to_disk(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int failure = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return failure;
}

/// Temporary files of the objects that exist.
struct Partials {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;

  void add(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex);
    paths.insert(path);
  }
  void erase(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex);
    paths.erase(path);
  }
};

/// Never destroyed: a thread may end the process while another destroys static objects.
Partials& partials() {
  static auto* const all = new Partials;
  return *all;
}

[[noreturn]] void throw_not_writable(const std::filesystem::path& file, int failure) {
  throw BadFile(file.string(), "cannot be written: " + std::string(std::strerror(failure)));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  static std::atomic<unsigned> counter{0};
  const auto directory = directory_of(target_);
  if (!std::filesystem::is_directory(directory)) {
    throw BadFile(target_.string(), "cannot be written: " + directory.string() + " is not a directory");
  }
  if (::access(directory.c_str(), W_OK) != 0) throw_not_writable(target_, errno);
  temporary_ = directory / (temporary_prefix(target_) + std::to_string(::getpid()) + "." + std::to_string(counter++) +
                            std::string(k_partial));
  partials().add(temporary_);
}

AtomicFile::~AtomicFile() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  partials().erase(temporary_);
}

void AtomicFile::commit() {
  if (const int failure = flush_to_disk(temporary_, O_RDONLY)) throw_not_writable(target_, failure);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw_not_writable(target_, errno);
  committed_ = true;
  // Makes the rename durable. Where a file system cannot flush a directory, the file is complete all the same.
  flush_to_disk(directory_of(target_), O_RDONLY | O_DIRECTORY);
}

void remove_own_partials() {
  Partials& all = partials();
  const std::scoped_lock lock(all.mutex);
  std::error_code ignored;
  for (const std::filesystem::path& path : all.paths) std::filesystem::remove(path, ignored);
}

void remove_stale_partials(const std::filesystem::path& target) {
  const std::string start = temporary_prefix(target);
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory_of(target), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(k_partial)) continue;
    pid_t writer = 0;
    const char* const digits = name.data() + start.size();
    const auto [end, error] = std::from_chars(digits, name.data() + name.size(), writer);
    if (error != std::errc() || *end != '.' || writer <= 0) continue;
    if (::kill(writer, 0) == 0 || errno != ESRCH) continue;
    std::filesystem::remove(entry.path(), ignored);
  }
}

void write_file_atomically(const std::filesystem::path& target, std::string_view content) {
  AtomicFile file(target);
  {
    errno = 0;
    std::ofstream out(file.temporary_path(), std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) throw_not_writable(target, errno == 0 ? EIO : errno);
  }
  file.commit();
}

}  // namespace sixdof
