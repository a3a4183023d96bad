#pragma once

/// Loops, tasks and per-thread state on all cores: the only door to oneTBB, so that every room shares one meaning of a
/// parallel step and the thread sanitizer can watch it.
///
/// `parallel` is `parallel_tbb`, except in builds with the thread sanitizer: Debian's oneTBB is not instrumented, so
/// each of its forks and joins would be reported as a race. There `parallel_threads` stands in, on std::thread, whose
/// forks and joins the sanitizer knows; it checks what our loop bodies share, which is what can be wrong.
///
/// Common to both:
/// - `for_each(n, body)`: body(i) for i in [0, n), in any order.
/// - `for_ranges(n, grain, body)`: body(begin, end) over disjoint ranges that cover [0, n); none is split below
/// `grain`.
/// - `reduce(n, grain, fold, join)`: fold(begin, end, T{}) of consecutive ranges, joined from left to right. Where the
///   ranges begin is not fixed: for bits that do not depend on the thread count, fold and join must be exact.
/// - `invoke(f, g)`: both.
/// - `Tasks`: run(f) starts f, wait() waits for all started; waits in the destructor too. One thread owns it.
/// - `sort(values)`: by operator<; equal elements in no fixed order.
/// - `PerThread<T>(make)`: local() is this thread's T, made on first use; iterate when no thread uses it.
/// - `isolated(f)`: f, during which this thread takes on no other part of an outer parallel step.
/// - `with_threads(n, f)`: f, whose parallel steps use at most n threads; 0 means all cores.
/// - `ThreadLimit(n)`: while alive, at most n threads in the whole process.
/// The first exception of a body reaches the caller of the step, of a task the caller of wait(), after all have ended.

#if defined(__SANITIZE_THREAD__)
#define SIXDOF_PARALLEL_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SIXDOF_PARALLEL_THREADS 1
#endif
#endif

#if defined(SIXDOF_PARALLEL_THREADS)
#include <sixdof/base/parallel_threads.h>
namespace sixdof {
namespace parallel = parallel_threads;
}
#else
#include <sixdof/base/parallel_tbb.h>
namespace sixdof {
namespace parallel = parallel_tbb;
}
#endif
