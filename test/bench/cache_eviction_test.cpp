#include "bench/harness/cache_eviction.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>

#include <benchmark/benchmark.h>
#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

/// A chain of places in random order, one in each cache line of 256 kB, so that nothing is fetched ahead.
class Chain {
 public:
  Chain() : next_(k_lines * k_words) {
    std::vector<std::size_t> lines(k_lines);
    std::iota(lines.begin(), lines.end(), std::size_t{0});
    std::shuffle(lines.begin(), lines.end(), std::mt19937_64(3));
    for (std::size_t i = 0; i < k_lines; ++i) next_[lines[i] * k_words] = lines[(i + 1) % k_lines] * k_words;
  }

  double walk_s() const {
    const auto start = std::chrono::steady_clock::now();
    std::size_t place = 0;
    for (std::size_t i = 0; i < k_lines; ++i) place = next_[place];
    benchmark::DoNotOptimize(place);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  static constexpr std::size_t k_lines = 4096;
  static constexpr std::size_t k_words = 64 / sizeof(std::size_t);
  std::vector<std::size_t> next_;
};

TEST(CacheEviction, LeavesNothingInTheCaches) {
  const Chain chain;
  CacheEviction evict;
  EXPECT_EQ(evict.bytes(), 0u) << "made when needed";
  double warm = 1e300, cold = 1e300;
  for (int i = 0; i < 5; ++i) {
    evict();
    cold = std::min(cold, chain.walk_s());
    for (int k = 0; k < 5; ++k) warm = std::min(warm, chain.walk_s());
  }
  EXPECT_GE(evict.bytes(), 2 * last_level_cache_bytes());
  // Memory takes ten times as long as the second level.
  EXPECT_GT(cold, 2 * warm);
}

}  // namespace
}  // namespace sixdof::bench
