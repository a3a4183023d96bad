#include "bench/harness/result_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <sixdof/base/error.h>
#include "bench/common/json_text.h"

namespace sixdof::bench {
namespace {

[[noreturn]] void throw_not_writable(const std::filesystem::path& file, int failure) {
  throw BadFile(file.string(), std::string("cannot be written: ") + std::strerror(failure));
}

/// @return errno, 0 on success
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

ResultJournal::ResultJournal(std::filesystem::path file) : file_(std::move(file)) {
  constexpr mode_t k_mode = 0666;
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, k_mode);
  if (descriptor_ < 0) throw_not_writable(file_, errno);
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) throw BadFile(file_.string(), "is in use by another process");
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

ResultJournal::~ResultJournal() { ::close(descriptor_); }

void ResultJournal::read() {
  std::ostringstream content;
  content << std::ifstream(file_, std::ios::binary).rdbuf();
  const std::string text = content.str();
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', size_)) {
    try {
      lines_.push_back(Json::parse(text.substr(size_, end - size_)));
    } catch (const Json::exception& e) {
      throw BadFile(file_.string(), "line " + std::to_string(lines_.size() + 1), e.what());
    }
    size_ = end + 1;
  }
  if (size_ < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) throw_not_writable(file_, errno);
}

void ResultJournal::append(const Json& line) {
  const std::string text = json_text(line, -1) + "\n";
  int failure = write_all(descriptor_, text);
  if (failure == 0 && ::fsync(descriptor_) != 0) failure = errno;
  if (failure != 0) {
    // Cutting off frees space; if even that fails, the next reader removes the torn line.
    [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(size_));
    throw_not_writable(file_, failure);
  }
  size_ += text.size();
}

void ResultJournal::clear() {
  if (::ftruncate(descriptor_, 0) != 0) throw_not_writable(file_, errno);
  lines_.clear();
  size_ = 0;
}

void ResultJournal::remove() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace sixdof::bench
