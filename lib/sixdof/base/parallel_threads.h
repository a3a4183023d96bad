#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

/// The functions of parallel.h on std::thread: for checking, not for speed. Several threads run even on one core, as
/// many as the machine is said to have would hide races; steps inside a step run in their thread.
namespace sixdof::parallel_threads {

namespace detail {

constexpr std::size_t k_threads = 4;
constexpr int k_deepest = 2;

inline std::atomic<std::size_t> process_limit{std::numeric_limits<std::size_t>::max()};
inline thread_local std::size_t local_limit = std::numeric_limits<std::size_t>::max();
inline thread_local int depth = 0;

inline std::size_t width() { return depth > 0 ? 1 : std::min({k_threads, process_limit.load(), local_limit}); }

/// Threads that carry the first exception of their work to join().
class Crew {
 public:
  Crew() = default;
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() { join_all(); }

  template <class F>
  void start(F f) {
    threads_.emplace_back([this, f = std::move(f), below = depth + 1]() mutable {
      depth = below;
      attempt(f);
    });
  }
  template <class F>
  void attempt(F& f) {
    try {
      f();
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }
  void join() {
    join_all();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  void join_all() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace detail

template <class Body>
void for_ranges(std::size_t n, std::size_t grain, const Body& body) {
  grain = std::max<std::size_t>(1, grain);
  const std::size_t ranges = (n + grain - 1) / grain;
  const std::size_t width = std::min(ranges, detail::width());
  // Ranges are dealt, not fetched: else a quick first thread does all and no two bodies are ever unordered.
  const auto work = [&](std::size_t thread) {
    for (std::size_t k = thread; k < ranges; k += width) body(k * grain, std::min(n, (k + 1) * grain));
  };
  if (width <= 1) {
    if (width == 1) work(0);
    return;
  }
  detail::Crew crew;
  for (std::size_t t = 0; t < width; ++t) crew.start([&work, t] { work(t); });
  crew.join();
}

template <class Body>
void for_each(std::size_t n, const Body& body) {
  // A few ranges per thread: an atomic step for each of millions of bodies would be most of the time.
  for_ranges(n, n / (8 * detail::k_threads) + 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

template <class T, class Fold, class Join>
T reduce(std::size_t n, std::size_t grain, const Fold& fold, const Join& join) {
  const std::size_t parts = std::clamp<std::size_t>(n / std::max<std::size_t>(1, grain), 1, detail::k_threads);
  std::vector<T> sums(parts);
  for_ranges(parts, 1, [&](std::size_t k, std::size_t) { sums[k] = fold(n * k / parts, n * (k + 1) / parts, T{}); });
  T sum = std::move(sums[0]);
  for (std::size_t k = 1; k < parts; ++k) sum = join(std::move(sum), sums[k]);
  return sum;
}

class Tasks {
 public:
  template <class F>
  void run(F&& f) {
    if (detail::depth < detail::k_deepest && std::min(detail::process_limit.load(), detail::local_limit) > 1) {
      crew_.start(std::forward<F>(f));
    } else {
      crew_.attempt(f);
    }
  }
  void wait() { crew_.join(); }

 private:
  detail::Crew crew_;
};

template <class F, class G>
void invoke(const F& f, const G& g) {
  Tasks tasks;
  tasks.run(f);
  g();
  tasks.wait();
}

template <class T>
void sort(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
}

template <class T>
class PerThread {
  using Values = std::map<std::thread::id, T>;

 public:
  PerThread() : PerThread([] { return T{}; }) {}
  explicit PerThread(std::function<T()> make) : make_(std::move(make)) {}

  T& local() {
    const std::thread::id me = std::this_thread::get_id();
    {
      const std::scoped_lock lock(mutex_);
      if (const auto mine = values_.find(me); mine != values_.end()) return mine->second;
    }
    T made = make_();
    const std::scoped_lock lock(mutex_);
    return values_.emplace(me, std::move(made)).first->second;
  }

  class Iterator {
   public:
    explicit Iterator(typename Values::iterator at) : at_(at) {}
    T& operator*() const { return at_->second; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    typename Values::iterator at_;
  };
  Iterator begin() { return Iterator(values_.begin()); }
  Iterator end() { return Iterator(values_.end()); }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  Values values_;
};

template <class F>
void isolated(const F& f) {
  f();
}

template <class F>
void with_threads(unsigned threads, const F& f) {
  const std::size_t before = detail::local_limit;
  if (threads > 0) detail::local_limit = std::min<std::size_t>(before, threads);
  try {
    f();
  } catch (...) {
    detail::local_limit = before;
    throw;
  }
  detail::local_limit = before;
}

class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t threads) : before_(detail::process_limit.exchange(threads)) {}
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ~ThreadLimit() { detail::process_limit = before_; }

 private:
  std::size_t before_;
};

}  // namespace sixdof::parallel_threads
