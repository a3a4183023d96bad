#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>

#include "bodies.h"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

// These count for the whole program.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* const p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* const p = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace sixdof {
namespace {

TEST(Allocations, OverlapQueriesMakeNoneOnceTheirScratchHasGrown) {
  const bodies::Body a(bodies::bumpy_torus(61, 33)), b(bodies::bumpy_torus(43, 25, 0.2, 0.8));
  std::mt19937_64 random(41);
  std::vector<Pose> poses;
  for (int i = 0; i < 20; ++i) poses.push_back(bodies::random_pose(random, 0.4));
  OverlapQuery query(a.solid, b.solid);
  std::size_t crossings = 0;
  const std::size_t before = allocations;
  for (const Pose& X_AB : poses) crossings += query.evaluate(X_AB).crossings;
  EXPECT_GT(allocations, before);
  const std::size_t grown = allocations;
  for (const Pose& X_AB : poses) crossings -= query.evaluate(X_AB).crossings;
  EXPECT_EQ(allocations, grown);
  EXPECT_EQ(crossings, 0u);
}

TEST(Allocations, OverlapQueriesWithAWarmStartMakeNoneOnceTheirScratchHasGrown) {
  const bodies::Body a(bodies::bumpy_torus(61, 33)), b(bodies::bumpy_torus(43, 25, 0.2, 0.8));
  const Pose start{Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {0.4, 0.1, 0.0}};
  OverlapQuery query(a.solid, b.solid);
  const auto move = [&] {
    std::size_t crossings = 0;
    for (int i = 0; i < 200; ++i) {
      const Pose pose{start.R, start.t + 2e-4 * i * Eigen::Vector3d(-1, 1, 1)};
      crossings += query.evaluate(pose, true).crossings;
    }
    return crossings;
  };
  const std::size_t crossings = move();
  move();
  const std::size_t grown = allocations;
  EXPECT_EQ(move(), crossings);
  EXPECT_EQ(allocations, grown);
  EXPECT_GT(crossings, 1000u);
}

}  // namespace
}  // namespace sixdof
