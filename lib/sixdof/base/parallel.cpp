#include <sixdof/base/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef SIXDOF_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace sixdof::parallel {
namespace {

/// A fork and its join, as the thread sanitizer must see them; empty in other builds. What the forking thread did comes
/// before every Body, and every Body before what follows the join.
class Step {
 public:
#ifdef SIXDOF_THREAD_SANITIZER
  Step() { __tsan_release(&fork_); }
  ~Step() { __tsan_acquire(&join_); }

  class Body {
   public:
    explicit Body(Step& step) : step_(step) { __tsan_acquire(&step_.fork_); }
    ~Body() { __tsan_release(&step_.join_); }

   private:
    Step& step_;
  };

 private:
  char fork_ = 0, join_ = 0;  ///< Their addresses name the two events.
#else
  Step() {}
  struct Body {
    explicit Body(Step&) {}
  };
#endif
};

}  // namespace

namespace detail {

using Slots = tbb::enumerable_thread_specific<void*>;

ThreadSlots::ThreadSlots() : slots_(std::make_shared<Slots>(nullptr)) {}
void* ThreadSlots::get() const { return static_cast<Slots*>(slots_.get())->local(); }
void ThreadSlots::set(void* value) { static_cast<Slots*>(slots_.get())->local() = value; }

}  // namespace detail

void for_ranges(std::size_t n, const std::function<void(std::size_t, std::size_t)>& body) {
  Step step;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n), [&](const tbb::blocked_range<std::size_t>& range) {
    const Step::Body part(step);
    body(range.begin(), range.end());
  });
}

void isolated(const std::function<void()>& f) { tbb::this_task_arena::isolate(f); }

unsigned most_threads() { return static_cast<unsigned>(tbb::task_arena().max_concurrency()); }

void with_threads(unsigned threads, const std::function<void()>& f) {
  Step step;  // oneTBB may run f on another thread
  // oneTBB prints a warning if it is asked for more than it has.
  const unsigned used = threads == 0 ? most_threads() : std::min(threads, most_threads());
  tbb::task_arena(static_cast<int>(used)).execute([&] {
    const Step::Body part(step);
    f();
  });
}

}  // namespace sixdof::parallel
