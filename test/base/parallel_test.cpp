#include <atomic>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/parallel.h>

namespace {
constexpr std::size_t k_many = 10007;
}

// What builds use, and, so that the stand-in for thread-sanitizer builds is tested in every build, that as well.
#define SIXDOF_SUITE Parallel
#define SIXDOF_PARALLEL parallel
#include "parallel_checks.h"

#if !defined(SIXDOF_PARALLEL_THREADS)
#include <sixdof/base/parallel_threads.h>
#undef SIXDOF_SUITE
#undef SIXDOF_PARALLEL
#define SIXDOF_SUITE ParallelThreads
#define SIXDOF_PARALLEL parallel_threads
#include "parallel_checks.h"

#else

#include <cstdlib>

namespace sixdof {
namespace {

TEST(ParallelDeathTest, TheSanitizerSeesARaceBetweenBodies) {
  constexpr int k_exit_after_reports = 66;  // the thread sanitizer's default
  ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
  int shared = 0;
  const auto race = [&] {
    parallel::for_each(k_many, [&](std::size_t) { ++shared; });
    std::exit(shared == 0 ? 1 : 0);
  };
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(k_exit_after_reports), "data race");
}

}  // namespace
}  // namespace sixdof

#endif
