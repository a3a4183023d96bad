#include "bench/harness/cache_eviction.h"

#include <unistd.h>

#include <benchmark/benchmark.h>

namespace sixdof::bench {

std::size_t last_level_cache_bytes() {
  for (const int name : {_SC_LEVEL4_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE, _SC_LEVEL2_CACHE_SIZE}) {
    // 0 or -1 where there is no such cache, or a virtual machine hides it.
    if (const long bytes = ::sysconf(name); bytes > 0) return static_cast<std::size_t>(bytes);
  }
  return k_unknown_cache_bytes;
}

void CacheEviction::operator()() {
  constexpr std::size_t k_line_bytes = 64;
  constexpr std::size_t k_step = k_line_bytes / sizeof(buffer_[0]);
  // Written once, so that every page has memory of its own.
  if (buffer_.empty()) buffer_.assign(eviction_bytes() / sizeof(buffer_[0]), 1);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < buffer_.size(); i += k_step) sum += buffer_[i];
  benchmark::DoNotOptimize(sum);
}

}  // namespace sixdof::bench
