#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

/// The functions of parallel.h on oneTBB.
namespace sixdof::parallel_tbb {

template <class Body>
void for_each(std::size_t n, const Body& body) {
  tbb::parallel_for(std::size_t{0}, n, body);
}

template <class Body>
void for_ranges(std::size_t n, std::size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

template <class T, class Fold, class Join>
T reduce(std::size_t n, std::size_t grain, const Fold& fold, const Join& join) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, n, grain), T{},
      [&](const tbb::blocked_range<std::size_t>& range, T sum) {
        return fold(range.begin(), range.end(), std::move(sum));
      },
      join);
}

template <class F, class G>
void invoke(const F& f, const G& g) {
  tbb::parallel_invoke(f, g);
}

class Tasks {
 public:
  Tasks() = default;
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;
  /// Reached with tasks under way only when an exception unwinds the stack: they use what is about to go.
  ~Tasks() {
    if (waited_) return;
    group_.cancel();
    try {
      group_.wait();
    } catch (...) {  // The exception under way tells more.
    }
  }

  template <class F>
  void run(F&& f) {
    waited_ = false;
    group_.run(std::forward<F>(f));
  }
  void wait() {
    waited_ = true;
    group_.wait();
  }

 private:
  tbb::task_group group_;
  bool waited_ = true;
};

template <class T>
void sort(std::vector<T>& values) {
  tbb::parallel_sort(values);
}

template <class T>
class PerThread {
 public:
  PerThread() = default;
  explicit PerThread(std::function<T()> make) : values_(std::move(make)) {}
  T& local() { return values_.local(); }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

 private:
  tbb::enumerable_thread_specific<T> values_;
};

template <class F>
void isolated(const F& f) {
  tbb::this_task_arena::isolate(f);
}

template <class F>
void with_threads(unsigned threads, const F& f) {
  tbb::task_arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)).execute(f);
}

class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t threads) : limit_(tbb::global_control::max_allowed_parallelism, threads) {}

 private:
  tbb::global_control limit_;
};

}  // namespace sixdof::parallel_tbb
