#include <sixdof/base/parallel.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr std::size_t k_many = 10007;

TEST(Parallel, EveryIndexIsUsedOnce) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3}, k_many}) {
    std::vector<int> uses(n, 0);
    parallel::for_each(n, [&](std::size_t i) { ++uses[i]; });
    EXPECT_EQ(uses, std::vector<int>(n, 1));
  }
}

TEST(Parallel, RangesCoverAll) {
  std::vector<int> uses(k_many, 0);
  parallel::for_ranges(k_many, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++uses[i];
  });
  EXPECT_EQ(uses, std::vector<int>(k_many, 1));
}

TEST(Parallel, ReductionJoinsFromLeftToRight) {
  const auto digits = parallel::reduce<std::vector<std::size_t>>(
      k_many, 10,
      [](std::size_t begin, std::size_t end) {
        std::vector<std::size_t> list;
        for (std::size_t i = begin; i < end; ++i) list.push_back(i);
        return list;
      },
      [](std::vector<std::size_t> left, const std::vector<std::size_t>& right) {
        left.insert(left.end(), right.begin(), right.end());
        return left;
      });
  std::vector<std::size_t> expected(k_many);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(digits, expected);
}

TEST(Parallel, BodiesMayRunLoops) {
  std::atomic<int> leaves{0};
  const std::function<void(int)> grow = [&](int depth) {
    if (depth == 0) {
      ++leaves;
    } else {
      parallel::for_each(3, [&](std::size_t) { grow(depth - 1); });
    }
  };
  grow(5);
  EXPECT_EQ(leaves, 243);
}

TEST(Parallel, InvokeRunsBoth) {
  int first = 0;
  int second = 0;
  parallel::invoke([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 2);
}

TEST(Parallel, SortsAscending) {
  constexpr std::size_t k_many_pieces = 20 * k_many + 1;
  for (const std::size_t n : {std::size_t{0}, k_many, k_many_pieces}) {
    std::vector<std::size_t> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = i * 7919 % n;  // a permutation: 7919 is a prime
    parallel::sort(values);
    std::vector<std::size_t> expected(n);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(values, expected);
  }
}

TEST(Parallel, EachThreadHasItsOwnValue) {
  std::atomic<int> made{0};
  parallel::PerThread<std::vector<std::size_t>> lists([&] {
    ++made;
    return std::vector<std::size_t>{k_many};
  });
  parallel::for_each(k_many, [&](std::size_t i) { lists.local().push_back(i); });
  std::set<std::size_t> seen;
  std::size_t all = 0;
  int count = 0;
  for (const std::vector<std::size_t>& list : lists) {
    seen.insert(list.begin(), list.end());
    all += list.size();
    ++count;
  }
  EXPECT_EQ(count, made);
  EXPECT_EQ(seen.size(), k_many + 1);
  EXPECT_EQ(all, k_many + static_cast<std::size_t>(count));
}

TEST(Parallel, ExceptionsReachTheCaller) {
  const auto fail = [](std::size_t i) {
    if (i == 77) throw std::runtime_error("body 77");
  };
  EXPECT_THROW(parallel::for_each(k_many, fail), std::runtime_error);
  EXPECT_THROW(parallel::invoke([] {}, [] { throw std::runtime_error("second"); }), std::runtime_error);
  EXPECT_THROW(parallel::with_threads(1, [] { throw std::runtime_error("limited"); }), std::runtime_error);
}

TEST(Parallel, BodiesEndBeforeAnExceptionReachesTheCaller) {
  std::atomic<int> started{0};
  std::atomic<int> ended{0};
  EXPECT_THROW(parallel::for_each(8,
                                  [&](std::size_t i) {
                                    if (i == 5) throw std::runtime_error("body 5");
                                    ++started;
                                    std::this_thread::yield();
                                    ++ended;
                                  }),
               std::runtime_error);
  EXPECT_EQ(started, ended);
}

TEST(Parallel, OneThreadMeansTheCallersOnly) {
  int threads = 0;
  parallel::with_threads(1, [&] {
    parallel::PerThread<int> used;
    parallel::for_each(k_many, [&](std::size_t) { ++used.local(); });
    for (const int uses : used) threads += uses > 0 ? 1 : 0;
  });
  EXPECT_EQ(threads, 1);
}

TEST(Parallel, MoreThreadsThanTheMachineHasAreNotAskedFor) {
  EXPECT_GE(parallel::most_threads(), 1u);
  std::atomic<std::size_t> bodies{0};
  ::testing::internal::CaptureStderr();
  parallel::with_threads(1000, [&] { parallel::for_each(k_many, [&](std::size_t) { ++bodies; }); });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "oneTBB would warn";
  EXPECT_EQ(bodies, k_many);
}

TEST(Parallel, IsolatedRunsAtOnce) {
  bool ran = false;
  parallel::isolated([&] { ran = true; });
  EXPECT_TRUE(ran);
}

#if defined(__SANITIZE_THREAD__)

/// Runs f() twice at the same time on two threads, if there are two. The relaxed counter orders nothing else.
template <class F>
void run_on_two_threads(const F& f) {
  std::atomic<int> started{0};
  const auto body = [&] {
    started.fetch_add(1, std::memory_order_relaxed);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (started.load(std::memory_order_relaxed) < 2 && std::chrono::steady_clock::now() < end) {
    }
    f();
  };
  parallel::invoke(body, body);
}

TEST(ParallelDeathTest, TheSanitizerSeesARaceBetweenBodies) {
  constexpr int k_exit_after_reports = 66;  // the thread sanitizer's default
  ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
  int shared = 0;
  const auto race = [&] {
    run_on_two_threads([&] { ++shared; });
    std::exit(shared == 0 ? 1 : 0);
  };
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(k_exit_after_reports), "data race");
}

#endif

}  // namespace
}  // namespace sixdof
