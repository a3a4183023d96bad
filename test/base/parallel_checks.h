// The promises of parallel.h, checked on the functions of namespace SIXDOF_PARALLEL as test suite SIXDOF_SUITE.
// No include guard: included once for each set of functions.

namespace sixdof {
namespace {

TEST(SIXDOF_SUITE, EveryIndexIsVisitedOnce) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3}, k_many}) {
    std::vector<int> visits(n, 0);
    SIXDOF_PARALLEL::for_each(n, [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(n, 1));
  }
}

TEST(SIXDOF_SUITE, RangesCoverAllAndAreNotBelowTheGrain) {
  std::vector<int> visits(k_many, 0);
  std::atomic<std::size_t> smallest{k_many};
  SIXDOF_PARALLEL::for_ranges(k_many, 100, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
    std::size_t before = smallest;
    while (end != k_many && end - begin < before && !smallest.compare_exchange_weak(before, end - begin)) {
    }
  });
  EXPECT_EQ(visits, std::vector<int>(k_many, 1));
  EXPECT_GE(smallest, 50u);  // oneTBB halves a range of more than the grain
}

TEST(SIXDOF_SUITE, ReductionJoinsFromLeftToRight) {
  const auto digits = SIXDOF_PARALLEL::reduce<std::vector<std::size_t>>(
      k_many, 10,
      [](std::size_t begin, std::size_t end, std::vector<std::size_t> list) {
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

TEST(SIXDOF_SUITE, TasksMayStartTasksAndAreWaitedFor) {
  std::atomic<int> leaves{0};
  const std::function<void(int)> grow = [&](int depth) {
    if (depth == 0) {
      ++leaves;
      return;
    }
    SIXDOF_PARALLEL::Tasks tasks;
    for (int child = 0; child < 3; ++child) tasks.run([&, depth] { grow(depth - 1); });
    tasks.wait();
  };
  grow(5);
  EXPECT_EQ(leaves, 243);
}

TEST(SIXDOF_SUITE, InvokeRunsBoth) {
  int first = 0;
  int second = 0;
  SIXDOF_PARALLEL::invoke([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 2);
}

TEST(SIXDOF_SUITE, SortsAscending) {
  std::vector<std::size_t> values(k_many);
  for (std::size_t i = 0; i < k_many; ++i) values[i] = i * 7919 % k_many;
  SIXDOF_PARALLEL::sort(values);
  std::vector<std::size_t> expected(k_many);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(values, expected);
}

TEST(SIXDOF_SUITE, EachThreadHasItsOwnValue) {
  std::atomic<int> made{0};
  SIXDOF_PARALLEL::PerThread<std::vector<std::size_t>> lists([&] {
    ++made;
    return std::vector<std::size_t>{k_many};
  });
  SIXDOF_PARALLEL::for_each(k_many, [&](std::size_t i) { lists.local().push_back(i); });
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

TEST(SIXDOF_SUITE, ExceptionsReachTheCaller) {
  const auto fail = [](std::size_t i) {
    if (i == 77) throw std::runtime_error("body 77");
  };
  EXPECT_THROW(SIXDOF_PARALLEL::for_each(k_many, fail), std::runtime_error);
  SIXDOF_PARALLEL::Tasks tasks;
  tasks.run([] { throw std::runtime_error("task"); });
  EXPECT_THROW(tasks.wait(), std::runtime_error);
  EXPECT_THROW(SIXDOF_PARALLEL::invoke([] {}, [] { throw std::runtime_error("second"); }), std::runtime_error);
  EXPECT_THROW(SIXDOF_PARALLEL::with_threads(1, [] { throw std::runtime_error("limited"); }), std::runtime_error);
}

TEST(SIXDOF_SUITE, TasksEndBeforeAnExceptionLeavesTheirOwner) {
  std::atomic<int> started{0};
  std::atomic<int> ended{0};
  try {
    SIXDOF_PARALLEL::Tasks tasks;
    for (int i = 0; i < 8; ++i) {
      tasks.run([&] {
        ++started;
        std::this_thread::yield();
        ++ended;
      });
    }
    throw std::runtime_error("owner");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(started, ended);
}

TEST(SIXDOF_SUITE, OneThreadMeansTheCallersOnly) {
  const auto threads = [] {
    SIXDOF_PARALLEL::PerThread<int> used;
    SIXDOF_PARALLEL::for_each(k_many, [&](std::size_t) { ++used.local(); });
    int count = 0;
    for (const int visits : used) count += visits > 0 ? 1 : 0;
    return count;
  };
  int limited = 0;
  SIXDOF_PARALLEL::with_threads(1, [&] { limited = threads(); });
  EXPECT_EQ(limited, 1);
  const SIXDOF_PARALLEL::ThreadLimit limit(1);
  EXPECT_EQ(threads(), 1);
}

TEST(SIXDOF_SUITE, IsolatedRunsAtOnce) {
  bool ran = false;
  SIXDOF_PARALLEL::isolated([&] { ran = true; });
  EXPECT_TRUE(ran);
}

}  // namespace
}  // namespace sixdof
