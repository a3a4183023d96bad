#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <vector>

#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing_sums.h>
#include <sixdof/oracle/solid.h>

namespace sixdof::detail {

/// find_candidates() by several threads. The first pairs of volumes are divided into parts, which threads search in
/// order. One thread takes the candidates part by part; while the next part is unfinished, it searches another one. If
/// a part has many candidates, as with faces in one plane, the thread that searched it also selects those that
/// intersect.
///
/// No allocation once the vectors have grown.
class CrossingParts {
 public:
  /// Divides the search at X_AB. No thread may be in help() or next().
  void start(const Solid& a, const Solid& b, const Pose& X_AB);

  /// Searches parts until none is left. Any number of threads at once. If it throws, what next() gives is incomplete.
  void help();

  /// The next candidates; none after the last. One thread.
  PairPiece next();

  std::size_t bytes() const;

 private:
  struct Part {
    CandidateScratch::VolumePair pair;
    CandidateSearch search;
    bool is_decided = false;  // all pairs that are left intersect
    std::atomic<bool> is_done = false;
  };

  /// Searches the first part that no thread has taken. Returns false if there is none.
  /// @param axes what this thread has seen so far
  bool search_one(CandidateAxes& axes);

  const Solid* a_ = nullptr;
  const Solid* b_ = nullptr;
  Pose X_AB_;
  CandidateAxes axes_;  // as the thread of next() has seen them
  CandidateScratch scratch_;
  std::vector<CandidateScratch::VolumePair> pairs_, wider_;  // scratch
  std::deque<Part> parts_;                                   // the first count_ are in use
  std::size_t count_ = 0, given_ = 0;
  std::atomic<std::size_t> taken_ = 0;
};

}  // namespace sixdof::detail
