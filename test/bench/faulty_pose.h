#pragma once

#include <bit>
#include <cstdint>

#include <sixdof/geometry/pose.h>

namespace sixdof::test {

/// How much longer the faulty queries of faulty_algorithms_bench.cpp take, so that their time is seen wherever it
/// counts: longer than a query waits for a processor. Instrumented queries are slow enough to wait often.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double k_fault_delay_ns = 5e7;
#else
inline constexpr double k_fault_delay_ns = 1e7;
#endif

/// True for one pose in 20, by a hash of its translation.
inline bool is_faulty(const Pose& X_AB) {
  constexpr std::uint64_t k_one_in = 20;
  std::uint64_t hash = 0;
  for (const double x : X_AB.t) {
    // splitmix64
    hash += std::bit_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111eb;
    hash ^= hash >> 31;
  }
  return hash % k_one_in == 0;
}

}  // namespace sixdof::test
