#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof::detail {

/// find_candidates() by several threads: the first pairs of volumes are divided into parts, which threads search in
/// their order. One thread takes the candidates part by part, and searches itself while the next part is not there.
///
/// No allocation once the vectors have grown.
class CandidateParts {
 public:
  /// Divides the search at X_AB. No thread may be in help() or next().
  void start(const Tree& a, const Tree& b, const Pose& X_AB);

  /// Searches parts until none is left. Any number of threads at once.
  void help();

  /// The next candidates in the order of find_candidates(); none after the last. One thread.
  std::span<const TrianglePair> next();

  std::size_t bytes() const;

 private:
  struct Part {
    CandidateScratch::VolumePair pair;
    CandidateSearch search;
    std::atomic<bool> is_done = false;
  };

  /// Searches the first part that no thread has taken. Returns false if there is none.
  /// @param axes what this thread has seen so far
  bool search_one(CandidateAxes& axes);

  const Tree* a_ = nullptr;
  const Tree* b_ = nullptr;
  Pose X_AB_;
  CandidateAxes axes_;  // as the thread of next() has seen them
  CandidateScratch scratch_;
  std::vector<CandidateScratch::VolumePair> pairs_, wider_;  // scratch
  std::deque<Part> parts_;                                   // the first count_ are in use
  std::size_t count_ = 0, given_ = 0;
  std::atomic<std::size_t> taken_ = 0;
};

}  // namespace sixdof::detail
