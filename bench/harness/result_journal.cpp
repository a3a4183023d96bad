#include "bench/harness/result_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include "bench/common/json_text.h"

namespace sixdof::bench {
namespace {

[[noreturn]] void throw_not_writable(const std::filesystem::path& file, int failure) {
  throw BadFile(file.string(), std::string("cannot be written: ") + std::strerror(failure));
}

std::string all_of(int descriptor, const std::filesystem::path& file) {
  std::string text;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw BadFile(file.string(), std::string("cannot be read: ") + std::strerror(errno));
    if (count == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// Ends every line: `,"checksum":"`, 32 digits and `"}`.
constexpr std::string_view k_checksum_begin = ",\"checksum\":\"";
constexpr std::string_view k_checksum_end = "\"}";
constexpr std::size_t k_checksum_digits = 32;

/// Of a line's text, as far as the checksum, and of the line before: so a line that was taken out or moved is found.
std::string checksum_of(std::string_view text, std::string_view before) {
  ContentHash hash;
  hash.add_values(std::span(before));
  hash.add_values(std::span(text));
  return hash.hex();
}

/// A line in two: its text without the checksum, and the checksum, empty where it has none.
std::pair<std::string_view, std::string_view> split(std::string_view line) {
  constexpr std::size_t k_tail = k_checksum_begin.size() + k_checksum_digits + k_checksum_end.size();
  if (line.size() < k_tail) return {line, {}};
  const std::string_view tail = line.substr(line.size() - k_tail);
  if (!tail.starts_with(k_checksum_begin) || !tail.ends_with(k_checksum_end)) return {line, {}};
  return {line.substr(0, line.size() - k_tail), tail.substr(k_checksum_begin.size(), k_checksum_digits)};
}

/// Helpers of a process that was killed hold its lock until they have ended, too.
bool is_locked(int descriptor) {
  constexpr int k_tries = 60;
  constexpr auto k_pause = std::chrono::milliseconds(50);
  for (int i = 0; i < k_tries; ++i) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return false;
    std::this_thread::sleep_for(k_pause);
  }
  return false;
}

}  // namespace

ResultJournal::ResultJournal(std::filesystem::path file) : file_(std::move(file)) {
  constexpr mode_t k_mode = 0666;
  // A link may have been put there by another user, to have the file that it leads to overwritten.
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, k_mode);
  if (descriptor_ < 0) {
    const int failure = errno;  // ELOOP or, where the system protects such links, EACCES
    std::error_code ignored;
    if (std::filesystem::is_symlink(file_, ignored)) throw BadFile(file_.string(), "is a link, which is not followed");
    throw_not_writable(file_, failure);
  }
  try {
    struct stat state = {};
    if (::fstat(descriptor_, &state) != 0) throw_not_writable(file_, errno);
    if (!S_ISREG(state.st_mode)) throw BadFile(file_.string(), "is not a regular file");
    if (state.st_nlink > 1) throw BadFile(file_.string(), "has other names (hard links), so it is not written");
    if (!is_locked(descriptor_)) throw BadFile(file_.string(), "is in use by another process");
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

ResultJournal::~ResultJournal() { ::close(descriptor_); }

void ResultJournal::read() {
  const std::string text = all_of(descriptor_, file_);
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', size_)) {
    const std::string_view line = std::string_view(text).substr(size_, end - size_);
    const auto refuse = [&](const std::string& why) {
      throw BadFile(file_.string(), "line " + std::to_string(lines_.size() + 1), why);
    };
    const auto [words, checksum] = split(line);
    if (checksum != checksum_of(words, last_checksum_)) {
      refuse(checksum.empty() ? "has no checksum: damaged, edited, or of an older version"
                              : "does not have its checksum: it or the line before was damaged or edited");
    }
    last_checksum_ = checksum;
    try {
      Json value = Json::parse(line);
      value.erase("checksum");
      lines_.push_back(std::move(value));
    } catch (const Json::exception& e) {
      refuse(e.what());
    }
    size_ = end + 1;
  }
  if (size_ < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) throw_not_writable(file_, errno);
}

void ResultJournal::append(const Json& line) {
  std::string text = json_text(line, -1);
  text.pop_back();  // the brace
  std::string checksum = checksum_of(text, last_checksum_);
  text += std::string(k_checksum_begin) + checksum + std::string(k_checksum_end) + "\n";
  int failure = write_all(descriptor_, text);
  if (failure == 0 && ::fsync(descriptor_) != 0) failure = errno;
  if (failure != 0) {
    // Cutting off frees space; if even that fails, the next reader removes the torn line.
    [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(size_));
    throw_not_writable(file_, failure);
  }
  size_ += text.size();
  last_checksum_ = std::move(checksum);
}

void ResultJournal::clear() {
  if (::ftruncate(descriptor_, 0) != 0) throw_not_writable(file_, errno);
  lines_.clear();
  last_checksum_.clear();
  size_ = 0;
}

void ResultJournal::remove() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace sixdof::bench
