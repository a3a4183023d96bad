#include <sixdof/base/write_log.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <map>
#include <utility>

#include <sixdof/base/hash.h>

namespace sixdof {
namespace {

std::string hash_of(std::span<const std::byte> bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

/// Parts of a file that do not overlap: begin to end.
using Parts = std::map<std::uint64_t, std::uint64_t>;

/// What `covered` leaves of a part, which it covers from now on.
Parts take_rest(Parts& covered, std::uint64_t begin, std::uint64_t end) {
  Parts rest;
  auto next = covered.upper_bound(begin);
  if (next != covered.begin()) begin = std::max(begin, std::prev(next)->second);
  for (; begin < end; ++next) {
    const std::uint64_t stop = next == covered.end() ? end : std::min(end, next->first);
    if (begin < stop) rest.emplace(begin, stop);
    if (next == covered.end()) break;
    begin = next->second;
  }
  covered.insert(rest.begin(), rest.end());
  return rest;
}

/// Empty if they cannot be read.
std::vector<std::byte> read_part(int descriptor, std::uint64_t begin, std::uint64_t end) {
  std::vector<std::byte> bytes(end - begin);
  for (std::size_t read = 0; read < bytes.size();) {
    const ssize_t count =
        ::pread(descriptor, bytes.data() + read, bytes.size() - read, static_cast<off_t>(begin + read));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {};
    read += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace

void WriteLog::add(std::uint64_t at, std::span<const std::byte> bytes) {
  const auto* const first = reinterpret_cast<const char*>(bytes.data());
  writes_.push_back(
      {at, bytes.size(), bytes.size() > k_longest_kept ? hash_of(bytes) : std::string(first, bytes.size())});
}

bool WriteLog::matches(int descriptor) const {
  struct stat state = {};
  if (::fstat(descriptor, &state) != 0) return false;
  const auto size = static_cast<std::uint64_t>(state.st_size);
  Parts covered;
  for (auto write = writes_.rbegin(); write != writes_.rend(); ++write) {
    const bool is_hashed = write->size > k_longest_kept;
    const std::uint64_t end = write->at + write->size;
    for (const auto& [begin, stop] : take_rest(covered, write->at, std::min(end, size))) {
      if (is_hashed && (begin != write->at || stop != end)) continue;
      const std::vector<std::byte> bytes = read_part(descriptor, begin, stop);
      if (bytes.empty()) return false;
      const bool same = is_hashed
                            ? hash_of(bytes) == write->kept
                            : std::equal(bytes.begin(), bytes.end(),
                                         reinterpret_cast<const std::byte*>(write->kept.data()) + (begin - write->at));
      if (!same) return false;
    }
  }
  return true;
}

}  // namespace sixdof
