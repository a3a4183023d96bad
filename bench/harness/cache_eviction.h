#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sixdof::bench {

/// Size of the last-level cache in bytes, or k_unknown_cache_bytes where the system does not report it.
std::size_t last_level_cache_bytes();

/// As large as the cache of most machines.
constexpr std::size_t k_unknown_cache_bytes = std::size_t{64} << 20;

/// Size of the buffer that is read to empty the caches: twice the last-level cache, since caches that do not evict the
/// oldest line first would keep some data after reading a buffer of their own size.
inline std::size_t eviction_bytes() { return 2 * last_level_cache_bytes(); }

/// Empties the caches of the processor: data that was used before is in memory only.
class CacheEviction {
 public:
  /// Reads every cache line of a buffer of eviction_bytes(), which is made at the first call.
  /// @throws std::bad_alloc
  void operator()();

  std::size_t bytes() const { return buffer_.size() * sizeof(buffer_[0]); }

 private:
  std::vector<std::uint64_t> buffer_;
};

}  // namespace sixdof::bench
