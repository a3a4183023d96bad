#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

/// Loops and per-thread values on all cores. Nothing else in this project uses oneTBB, and only parallel.cpp
/// includes it.
///
/// An exception that leaves a body reaches the caller of the step after all bodies have ended; of several, one does.
///
/// Thread sanitizer: Debian's oneTBB is not instrumented, so the sanitizer does not see its forks and joins. In builds
/// with the sanitizer, parallel.cpp is compiled without instrumentation and states every fork and join by
/// __tsan_release and __tsan_acquire. A body and its per-thread values must therefore not lie in oneTBB's memory. No
/// suppressions are needed. A race between two bodies is found only if they run on different threads, on two cores.
namespace sixdof::parallel {

namespace detail {

/// The value of each thread as an untyped pointer, null at first.
class ThreadSlots {
 public:
  ThreadSlots();
  void* get() const;
  void set(void* value);

 private:
  std::shared_ptr<void> slots_;
};

}  // namespace detail

/// body(begin, end) over disjoint ranges that cover [0, n), in any order.
void for_ranges(std::size_t n, const std::function<void(std::size_t begin, std::size_t end)>& body);

/// body(i) for i in [0, n), in any order.
template <class Body>
void for_each(std::size_t n, const Body& body) {
  for_ranges(n, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// fold(begin, end) of consecutive ranges of about `grain`, joined from left to right. The ranges depend on n and
/// `grain` only: the result is the same for every number of threads.
template <class T, class Fold, class Join>
T reduce(std::size_t n, std::size_t grain, const Fold& fold, const Join& join) {
  const std::size_t count = std::max<std::size_t>(1, n / std::max<std::size_t>(1, grain));
  std::vector<T> parts(count);
  for_each(count, [&](std::size_t k) { parts[k] = fold(n * k / count, n * (k + 1) / count); });
  T sum = std::move(parts[0]);
  for (std::size_t k = 1; k < count; ++k) sum = join(std::move(sum), parts[k]);
  return sum;
}

/// f() and g(), in any order.
template <class F, class G>
void invoke(const F& f, const G& g) {
  for_each(2, [&](std::size_t i) { i == 0 ? f() : g(); });
}

namespace detail {

template <class Iterator>
void sort_range(Iterator begin, Iterator end) {
  constexpr auto k_sorted_by_one_thread = 1 << 16;
  if (end - begin <= k_sorted_by_one_thread) {
    std::sort(begin, end);
    return;
  }
  const Iterator middle = begin + (end - begin) / 2;
  invoke([=] { sort_range(begin, middle); }, [=] { sort_range(middle, end); });
  std::inplace_merge(begin, middle, end);
}

}  // namespace detail

/// Sorts by operator<. Equal elements come in no particular order.
template <class T>
void sort(std::vector<T>& values) {
  detail::sort_range(values.begin(), values.end());
}

/// f(), during which this thread runs no body of another step, so that a lock may be held.
void isolated(const std::function<void()>& f);

/// The number of threads that steps use where no limit is set: the processors that this process may use.
unsigned most_threads();

/// f(), whose steps use at most `threads` threads; 0, or more than most_threads(), means most_threads().
void with_threads(unsigned threads, const std::function<void()>& f);

/// A value for each thread that asks for one.
template <class T>
class PerThread {
 public:
  /// @param make makes the value of a thread on its first use, in that thread.
  explicit PerThread(std::function<T()> make = [] { return T(); }) : make_(std::move(make)) {}

  /// This thread's value.
  T& local() {
    if (void* const mine = slots_.get()) return *static_cast<T*>(mine);
    T made = make_();
    const std::scoped_lock lock(mutex_);
    values_.push_back(std::move(made));
    slots_.set(&values_.back());
    return values_.back();
  }

  /// All values, in the order in which they were made; while no thread calls local().
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  std::deque<T> values_;
  detail::ThreadSlots slots_;
};

}  // namespace sixdof::parallel
