#include <sixdof/base/atomic_file.h>

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

std::filesystem::path directory_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

constexpr std::string_view k_partial = ".partial";
constexpr mode_t k_permissions = 0777;
constexpr mode_t k_new_file = 0666;    // less the umask
constexpr mode_t k_new_folder = 0777;  // less the umask
constexpr int k_most_links = 40;       // as Linux has it

std::string temporary_prefix(const std::filesystem::path& target) { return "." + target.filename().string() + "."; }

[[noreturn]] void throw_not_writable(const std::filesystem::path& file, int failure) {
  throw BadFile(file.string(), "cannot be written: " + std::string(std::strerror(failure)));
}

/// ".NAME.PID.RANDOM.partial" beside the target. The process stands in it for remove_stale_partials().
std::filesystem::path temporary_name(const std::filesystem::path& target, const std::filesystem::path& shown_as) {
  std::uint64_t random = 0;
  // Requests of up to 256 bytes are never cut short, and fail only where there is no such call.
  if (::getrandom(&random, sizeof random, 0) != static_cast<ssize_t>(sizeof random))
    throw_not_writable(shown_as, errno);
  return directory_of(target) / fmt::format("{}{}.{:016x}{}", temporary_prefix(target), ::getpid(), random, k_partial);
}

/// Temporary files and folders of the objects that exist. What is made is added under the same lock, so that
/// remove_own_partials() misses none.
struct Partials {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;

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

/// The rule of Linux's fs.protected_symlinks, which may be off, for every folder that everyone can write, sticky or
/// not.
bool is_followed(const struct stat& link, const struct stat& folder) {
  if ((folder.st_mode & S_IWOTH) == 0) return true;
  return link.st_uid == ::geteuid() || link.st_uid == 0 || link.st_uid == folder.st_uid;
}

/// The mode of the file that is there, or that of a new one. @throws BadFile if what is there is no regular file
mode_t mode_for(const std::filesystem::path& file, const std::filesystem::path& shown_as, bool& exists) {
  struct stat there = {};
  exists = ::lstat(file.c_str(), &there) == 0;
  if (!exists) return k_new_file;
  if (!S_ISREG(there.st_mode)) throw BadFile(shown_as.string(), "cannot be written: is not a regular file");
  return there.st_mode & k_permissions;
}

/// @return errno, 0 on success. The descriptor is closed in any case.
int close_file(int& descriptor) {
  // Linux has closed it also where it says EINTR.
  return ::close(std::exchange(descriptor, -1)) == 0 || errno == EINTR ? 0 : errno;
}

/// Makes renames in a folder durable. @return errno; 0 also where a folder cannot be flushed, or not be read
int flush_folder(const std::filesystem::path& folder) {
  int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno == EACCES ? 0 : errno;
  int failure = ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
  if (const int closing = close_file(descriptor); failure == 0) failure = closing;
  return failure;
}

/// @return errno, 0 if the file has these bytes and no others
int compare(int descriptor, std::string_view content) {
  constexpr std::size_t k_block = std::size_t{1} << 20;
  std::vector<char> block(std::min(content.size() + 1, k_block));
  for (std::size_t at = 0;;) {
    const ssize_t count = ::pread(descriptor, block.data(), block.size(), static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    const std::string_view found(block.data(), static_cast<std::size_t>(count));
    if (found.empty()) return at == content.size() ? 0 : EIO;
    if (content.substr(at, found.size()) != found) return EIO;
    at += found.size();
  }
}

}  // namespace

std::filesystem::path follow_links(const std::filesystem::path& path) {
  std::deque<std::filesystem::path> rest(path.begin(), path.end());
  std::filesystem::path done;
  for (int links = 0; !rest.empty();) {
    const std::filesystem::path next = std::exchange(rest.front(), {});
    rest.pop_front();
    const std::filesystem::path candidate = done / next;
    struct stat found = {};
    if (::lstat(candidate.c_str(), &found) != 0 || !S_ISLNK(found.st_mode)) {
      // What is not there, or may not be looked at, fails where it is opened.
      done = candidate;
      continue;
    }
    struct stat folder = {};
    if (::stat(directory_of(candidate).c_str(), &folder) != 0) throw_not_writable(path, errno);
    if (!is_followed(found, folder)) {
      throw BadFile(path.string(), fmt::format("cannot be written: {} is a link of another user (uid {}) in a folder "
                                               "that everyone can write",
                                               candidate.string(), found.st_uid));
    }
    if (++links > k_most_links) throw_not_writable(path, ELOOP);
    std::error_code error;
    const std::filesystem::path leads_to = std::filesystem::read_symlink(candidate, error);
    if (error) throw_not_writable(path, error.value());
    if (leads_to.is_absolute()) done.clear();
    rest.insert(rest.begin(), leads_to.begin(), leads_to.end());
  }
  return done;
}

int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)), replaced_(follow_links(target_)) {
  const auto directory = directory_of(replaced_);
  if (!std::filesystem::is_directory(directory)) {
    throw BadFile(target_.string(), "cannot be written: " + directory.string() + " is not a directory");
  }
  bool replaces = false;
  const mode_t mode = mode_for(replaced_, target_, replaces);
  {
    const std::scoped_lock lock(partials().mutex);
    do {
      temporary_ = temporary_name(replaced_, target_);
      descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) throw_not_writable(target_, errno);
    partials().paths.insert(temporary_);
  }
  if (replaces && ::fchmod(descriptor_, mode) != 0) {
    const int failure = errno;
    discard();
    throw_not_writable(target_, failure);
  }
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  // What is discarded need not reach the disk.
  if (descriptor_ >= 0) static_cast<void>(close_file(descriptor_));
  partials().erase(temporary_);
}

void AtomicFile::append(std::string_view content) {
  if (const int failure = write_all(descriptor_, content)) throw_not_writable(target_, failure);
}

void AtomicFile::flush() {
  if (::fsync(descriptor_) != 0) throw_not_writable(target_, errno);
  // Advice: where it is not taken, a reader gets the copy in memory.
  static_cast<void>(::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_DONTNEED));
}

void AtomicFile::store(std::string_view content) {
  append(content);
  flush();
  if (const int failure = compare(descriptor_, content)) throw_not_writable(target_, failure);
}

void AtomicFile::commit() {
  flush();
  if (const int failure = close_file(descriptor_)) throw_not_writable(target_, failure);
  if (::rename(temporary_.c_str(), replaced_.c_str()) != 0) throw_not_writable(target_, errno);
  committed_ = true;
  if (const int failure = flush_folder(directory_of(replaced_))) throw_not_writable(target_, failure);
}

PrivateFolder::PrivateFolder(const std::filesystem::path& target) {
  int made = 0;
  const std::scoped_lock lock(partials().mutex);
  do {
    path_ = temporary_name(target, target);
    made = ::mkdir(path_.c_str(), S_IRWXU);
  } while (made != 0 && errno == EEXIST);
  if (made != 0) throw BadFile(target.string(), fmt::format("cannot be made: {}", std::strerror(errno)));
  partials().paths.insert(path_);
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  partials().erase(path_);
}

void PrivateFolder::commit(const std::filesystem::path& target) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  const bool done = ::chmod(path_.c_str(), k_new_folder & ~mask) == 0 && ::rename(path_.c_str(), target.c_str()) == 0;
  const int failure = done ? flush_folder(directory_of(target)) : errno;
  if (failure != 0) throw BadFile(target.string(), fmt::format("cannot be made: {}", std::strerror(failure)));
}

void check_writable(const std::filesystem::path& target) {
  AtomicFile probe(target);
  if (const int failure = close_file(probe.descriptor_)) throw_not_writable(target, failure);
}

std::unique_lock<std::mutex> remove_own_partials() {
  Partials& all = partials();
  std::unique_lock lock(all.mutex);
  std::error_code ignored;
  for (const std::filesystem::path& path : all.paths) std::filesystem::remove_all(path, ignored);
  return lock;
}

void remove_stale_partials(const std::filesystem::path& target) {
  const std::filesystem::path replaced = follow_links(target);
  const std::string start = temporary_prefix(replaced);
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory_of(replaced), ignored)) {
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
  file.store(content);
  file.commit();
}

}  // namespace sixdof
