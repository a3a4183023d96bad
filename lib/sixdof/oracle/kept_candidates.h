#pragma once

#include <cstddef>
#include <span>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof::detail {

/// Candidates for poses that follow each other closely. A search takes a margin around a pose a little ahead and holds
/// until B leaves it. Before B does, the next search is done in parts, one per query, for where B will be then.
///
/// A wide margin spares searches, but all candidates within it are decided in every query. With the margin m and B
/// moving by s per query, a query takes a share of a search that is proportional to s / m, and decides so many
/// candidates more as grow with m. The sum is least where both are equal. The growth is that of the last search with a
/// margin. Where B moves too far for a margin to last for some queries, searches take none.
///
/// No allocation once the vectors have grown.
class KeptCandidates {
 public:
  /// All pairs of triangles that intersect at X_AB, and others, in the order of find_candidates(). They hold until the
  /// next call.
  /// @param a, b the same in every call
  std::span<const TrianglePair> at(const Tree& a, const Tree& b, const Pose& X_AB);

  /// @param crossings how many of the pairs that at() gave last intersect
  void count_crossings(std::size_t crossings);

  /// Pairs of volumes that searches expanded.
  std::size_t expansions() const { return expansions_; }
  std::size_t bytes() const;

 private:
  /// The growth of candidates at first, of elephants with an overlap of 10 %; and the least.
  static constexpr double k_first_growth = 6.0, k_least_growth = 0.6;
  /// Where candidates abound within a margin, none is tried for the next hundred searches.
  static constexpr double k_growth_of_failure = 8.0, k_decay_of_growth = 0.98;
  static constexpr double k_few = 64.0;  ///< Candidates that cost next to nothing.

  void search(const Tree& a, const Tree& b, const Pose& X_AB);
  void search_ahead(const Tree& a, const Tree& b, const Pose& X_AB);
  /// Whether it has found so many candidates that its margin is too wide.
  bool abounds(const CandidateSearch& search) const;
  double without_margin() const { return per_crossing_ * crossings_; }
  void advance(CandidateSearch& search, const Tree& a, const Tree& b, std::size_t most);
  double next_margin(const Tree& a, const Tree& b, double step);
  /// Where B will be after moving on from X_AB, as from last_ to there, by at most `length`.
  Pose pose_ahead(const Tree& b, const Pose& X_AB, double length) const;

  CandidateSearch now_, next_;
  bool has_now_ = false, has_next_ = false;
  std::size_t part_ = 0;                         ///< Expansions of a search ahead in one query.
  Pose last_;                                    ///< For which pairs were asked last.
  double crossings_ = 1.0, per_crossing_ = 2.0;  ///< There, and candidates for each without a margin.
  double growth_ = k_first_growth;               ///< By which share candidates grow per margin, in sizes of a triangle.
  std::size_t expansions_ = 0;
};

}  // namespace sixdof::detail
