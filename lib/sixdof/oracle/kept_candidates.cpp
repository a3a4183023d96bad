#include <sixdof/oracle/kept_candidates.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>

namespace sixdof::detail {
namespace {

/// Queries among which a search ahead is divided, at most.
constexpr double k_most_parts = 8.0;
/// Candidates with a margin over those without, more than which it is not worth.
constexpr double k_most_candidates = 4.0;
/// A search is made for a pose as far ahead as this share of its margin.
constexpr double k_ahead = 0.8;

/// Upper bound on how far two poses take a point of a tree from each other. The matrices need not be rotations.
double largest_displacement(const Tree& tree, const Pose& x, const Pose& y) {
  return tree.radius() * (x.R - y.R).norm() + (x * tree.center() - y * tree.center()).norm();
}

bool contains(const CandidateSearch& search, const Tree& b, const Pose& X_AB) {
  return largest_displacement(b, X_AB, search.X_AB) <= search.margin;
}

/// About the edge of a triangle, from the surface's extent.
double triangle_size(const Tree& tree) {
  return 2.0 * tree.radius() / std::sqrt(static_cast<double>(tree.corners().size()));
}

}  // namespace

std::span<const TrianglePair> KeptCandidates::at(const Tree& a, const Tree& b, const Pose& X_AB) {
  if (has_now_ && contains(now_, b, X_AB)) {
    if (now_.margin > 0.0) search_ahead(a, b, X_AB);
  } else if (has_next_ && contains(next_, b, X_AB)) {
    advance(next_, a, b, CandidateSearch::k_whole);
    std::swap(now_, next_);
    has_next_ = false;
  } else {
    search(a, b, X_AB);
  }
  last_ = X_AB;
  return now_.pairs;
}

void KeptCandidates::search(const Tree& a, const Tree& b, const Pose& X_AB) {
  constexpr std::size_t k_part = 512;  // after as many expansions it looks whether there are too many candidates
  const double margin = has_now_ ? next_margin(a, b, largest_displacement(b, X_AB, last_)) : 0.0;
  now_.start(a, b, margin > 0.0 ? pose_ahead(b, X_AB, k_ahead * margin) : X_AB, margin);
  while (margin > 0.0 && !now_.is_complete() && !has_too_many(now_)) advance(now_, a, b, k_part);
  if (margin > 0.0 && has_too_many(now_)) {
    growth_ *= k_growth_of_failure;
    now_.start(a, b, X_AB, 0.0);
  }
  advance(now_, a, b, CandidateSearch::k_whole);
  has_now_ = true;
  has_next_ = false;
}

/// Begins when what is left of the margin is passed in as many queries as a search takes, and a few more.
void KeptCandidates::search_ahead(const Tree& a, const Tree& b, const Pose& X_AB) {
  if (!has_next_) {
    constexpr double k_more = 2.0;
    const double step = largest_displacement(b, X_AB, last_);
    const double from_center = largest_displacement(b, X_AB, now_.X_AB);
    const bool recedes = from_center > largest_displacement(b, last_, now_.X_AB);
    const double left = recedes ? now_.margin - from_center : now_.margin + from_center;
    if (left > (k_most_parts + k_more) * step) return;
    const double margin = next_margin(a, b, step);
    if (margin == 0.0) return;
    next_.start(a, b, pose_ahead(b, X_AB, left + k_ahead * margin), margin);
    has_next_ = true;
    const double parts = std::clamp(left / step - 1.0, 1.0, k_most_parts);
    part_ = static_cast<std::size_t>(static_cast<double>(now_.expansions) / parts) + 1;
  }
  if (next_.is_complete()) return;
  advance(next_, a, b, part_);
  if (has_too_many(next_)) {
    growth_ *= k_growth_of_failure;
    has_next_ = false;
  }
}

bool KeptCandidates::has_too_many(const CandidateSearch& search) const {
  return static_cast<double>(search.pairs.size()) >
         k_most_candidates * std::max(without_margin(), k_negligible_candidates);
}

void KeptCandidates::advance(CandidateSearch& search, const Tree& a, const Tree& b, std::size_t most) {
  const std::size_t before = search.expansions;
  search.advance(a, b, most);
  expansions_ += search.expansions - before;
}

void KeptCandidates::count_crossings(std::size_t crossings) {
  crossings_ = static_cast<double>(std::max<std::size_t>(crossings, 1));
  if (now_.margin == 0.0) per_crossing_ = static_cast<double>(now_.pairs.size()) / crossings_;
}

double KeptCandidates::next_margin(const Tree& a, const Tree& b, double step) {
  // Elephants with an overlap of 10 %: a search takes as long as deciding ten times as many candidates as there are
  // without a margin, and lasts for nearly twice the margin.
  constexpr double k_search = 6.0;
  constexpr double k_least_steps = 3.0;
  const double size = std::min(triangle_size(a), triangle_size(b));
  double measured = k_first_growth;
  if (now_.margin > 0.0) {
    const double more =
        static_cast<double>(now_.pairs.size()) / std::max(without_margin(), k_negligible_candidates) - 1.0;
    measured = std::max(more * size / now_.margin, k_least_growth);
  }
  growth_ = std::max(measured, k_decay_of_growth * growth_);  // where candidates abounded, they may no longer
  const double margin = std::sqrt(k_search / growth_ * size * step);
  return margin >= k_least_steps * step ? margin : 0.0;
}

Pose KeptCandidates::pose_ahead(const Tree& b, const Pose& X_AB, double length) const {
  constexpr int k_most_steps = 128;
  const Pose step = X_AB * last_.inverse();
  Pose ahead = X_AB;
  for (int i = 0; i < k_most_steps; ++i) {
    const Pose next = step * ahead;
    if (!(largest_displacement(b, next, X_AB) <= length)) break;
    ahead = next;
  }
  return ahead;
}

std::size_t KeptCandidates::bytes() const {
  std::size_t sum = 0;
  for (const CandidateSearch* search : {&now_, &next_}) {
    sum += search->scratch.bytes() + search->pairs.capacity() * sizeof(TrianglePair);
  }
  return sum;
}

}  // namespace sixdof::detail
