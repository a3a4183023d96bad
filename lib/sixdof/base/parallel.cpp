#include <sixdof/base/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

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

void for_ranges(std::size_t n, std::size_t grain, const detail::RangeBody& body) {
  Step step;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const tbb::blocked_range<std::size_t>& range) {
    const Step::Body part(step);
    body(range.begin(), range.end());
  });
}

void invoke(const std::function<void()>& f, const std::function<void()>& g) {
  Step step;
  const auto run = [&step](const std::function<void()>& body) {
    const Step::Body part(step);
    body();
  };
  tbb::parallel_invoke([&] { run(f); }, [&] { run(g); });
}

void isolated(const std::function<void()>& f) { tbb::this_task_arena::isolate(f); }

void with_threads(unsigned threads, const std::function<void()>& f) {
  Step step;  // oneTBB may run f on another thread
  tbb::task_arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)).execute([&] {
    const Step::Body part(step);
    f();
  });
}

ThreadLimit::ThreadLimit(std::size_t threads)
    : limit_(std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads)) {}

struct Tasks::Group {
  struct Task {
    std::function<void()> body;
    Step step;
  };
  std::deque<Task> tasks;  ///< Outlive their runs, so that oneTBB's memory holds no part of a body.
  tbb::task_group group;
};

Tasks::Tasks() = default;

Tasks::~Tasks() {
  if (!group_) return;
  // Only an exception in the owner leads here. Tasks that run use what it is about to destroy.
  group_->group.cancel();
  try {
    group_->group.wait();
  } catch (...) {  // The owner's exception is under way.
  }
}

void Tasks::run(std::function<void()> task) {
  if (!group_) group_ = std::make_unique<Group>();
  Group::Task& added = group_->tasks.emplace_back(std::move(task));
  group_->group.run([&added] {
    const Step::Body part(added.step);
    added.body();
  });
}

void Tasks::wait() {
  if (!group_) return;
  // Destroyed on both ways out of here, which joins their steps.
  const std::unique_ptr<Group> ended = std::move(group_);
  ended->group.wait();
}

}  // namespace sixdof::parallel
