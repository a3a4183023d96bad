#pragma once

#include <cstddef>
#include <span>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof::detail {

/// Candidates kept for successive poses that are close together. A search predicts a pose a little ahead, and finds all
/// pairs that can intersect while every point of B is within a margin of its place there. They are used until B leaves
/// the margin. The next search is done before that, in parts, one per query.
///
/// A wide margin needs fewer searches, but every query tests all candidates within it. If B moves by s per query, the
/// cost of searches per query is proportional to s / m, where m is the margin, and the number of additional candidates
/// to m. The sum is least where both costs are equal. How fast candidates grow with m is measured in the last search
/// with a margin. If B moves so fast that a margin would not last for a few queries, there is none.
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
  /// Additional candidates per candidate, for a margin of the size of a triangle: the first guess, measured on
  /// elephants with an overlap of 10 %, and the least.
  static constexpr double k_first_growth = 6.0, k_least_growth = 0.6;
  /// After a margin with too many candidates, growth_ is raised by the first factor, and lowered by the second in each
  /// search: about a hundred searches have no margin.
  static constexpr double k_growth_of_failure = 8.0, k_decay_of_growth = 0.98;
  /// A smaller number of candidates without a margin counts as this: so few cost nearly nothing.
  static constexpr double k_negligible_candidates = 64.0;

  void search(const Tree& a, const Tree& b, const Pose& X_AB);
  void search_ahead(const Tree& a, const Tree& b, const Pose& X_AB);
  /// Whether a search has found so many candidates that its margin is too wide.
  bool has_too_many(const CandidateSearch& search) const;
  double without_margin() const { return per_crossing_ * crossings_; }
  void advance(CandidateSearch& search, const Tree& a, const Tree& b, std::size_t most);
  double next_margin(const Tree& a, const Tree& b, double step);
  /// The predicted pose: the motion from last_ to X_AB, repeated as long as no point of B moves by more than `length`.
  Pose pose_ahead(const Tree& b, const Pose& X_AB, double length) const;

  CandidateSearch now_, next_;
  bool has_now_ = false, has_next_ = false;
  std::size_t part_ = 0;                         ///< Expansions of a search ahead in one query.
  Pose last_;                                    ///< Of the last query.
  double crossings_ = 1.0, per_crossing_ = 2.0;  ///< At last_; candidates per crossing without a margin.
  double growth_ = k_first_growth;               ///< As k_first_growth.
  std::size_t expansions_ = 0;
};

}  // namespace sixdof::detail
