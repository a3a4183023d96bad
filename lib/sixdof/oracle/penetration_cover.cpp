#include <sixdof/oracle/penetration_cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;
using SphereTriangle = std::array<Vector3d, 3>;

/// Sides of spherical triangles (radians) that are not halved any more.
constexpr double k_narrowest = 1e-9;
/// Free translations are numerous where many directions are equally short. One that is shorter by less than this part
/// of the tolerance is taken as it is, until the end.
constexpr double k_worth_a_descent = 0.1;
constexpr std::size_t k_largest_pool = 1000;
/// The last part of a cone takes in a rest smaller than this part of it.
constexpr double k_small_rest = 0.2;

struct Icosahedron {
  std::vector<Vector3d> directions;  ///< Its corners, then the middles of its edges.
  std::vector<SphereTriangle> triangles;

  Icosahedron() {
    const double g = std::numbers::phi;
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.83, 0.21, -0.37, 0.35).normalized();
    std::vector<Vector3d> corners;
    for (const double s : {1.0, -1.0}) {
      for (const double t : {g, -g}) {
        for (const Vector3d& p : {Vector3d(0.0, s, t), Vector3d(s, t, 0.0), Vector3d(t, 0.0, s)}) {
          corners.push_back((turn * p).normalized());
        }
      }
    }
    directions = corners;
    // The cosine of two neighbours is 1 / sqrt(5), of all others negative.
    const auto adjacent = [&](std::size_t i, std::size_t j) { return corners[i].dot(corners[j]) > 0.4; };
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) {
        if (!adjacent(i, j)) continue;
        directions.push_back((corners[i] + corners[j]).normalized());
        for (std::size_t k = j + 1; k < corners.size(); ++k) {
          if (adjacent(i, k) && adjacent(j, k)) triangles.push_back({corners[i], corners[j], corners[k]});
        }
      }
    }
  }
};

const Icosahedron& icosahedron() {
  static const Icosahedron made;
  return made;
}

}  // namespace

std::span<const SphereTriangle> sphere_triangles() { return icosahedron().triangles; }

std::span<const Vector3d> sphere_directions() { return icosahedron().directions; }

PenetrationCover::PenetrationCover(const PenetrationOracle& oracle, const Pose& X_AB, const Vector3d& first,
                                   const PenetrationOptions& options)
    : X_AB_(X_AB),
      tolerance_(options.tolerance),
      budget_(options.budget),
      provers_([&oracle, X_AB] { return CellProver(oracle, X_AB); }),
      own_(oracle, X_AB),
      pool_(own_.find_pool()),
      translation_(first) {
  const double length = (1.0 - k_step_left) * first.norm();
  for (const SphereTriangle& triangle : sphere_triangles()) put({.u = triangle, .r0 = 0.0, .r1 = length});
}

void PenetrationCover::put(const TranslationCell& cell) {
  if (cell.longest_side().first < k_narrowest) {
    given_up_.push_back(cell.r0);
  } else {
    open_.emplace(std::pair(cell.r0, number_++), cell);
  }
}

/// The innermost cells that reach inside of the target.
std::vector<TranslationCell> PenetrationCover::take_batch() {
  std::vector<TranslationCell> batch;
  const double end = target();
  while (!open_.empty() && batch.size() < k_batch && open_.begin()->first.first < end) {
    batch.push_back(open_.begin()->second);
    batch.back().r1 = std::min(batch.back().r1, end);
    open_.erase(open_.begin());
  }
  return batch;
}

void PenetrationCover::shorten_translation(const Vector3d& free) {
  const double length = translation_.norm();
  if (free.norm() >= length) return;
  translation_ = free;
  is_descended_ = false;
  if (free.norm() < (1.0 - k_worth_a_descent * tolerance_) * length) descend();
}

void PenetrationCover::descend() {
  const Vector3d shorter = own_.translations().descend(X_AB_, translation_);
  if (shorter.norm() < translation_.norm()) translation_ = shorter;
  is_descended_ = true;
}

/// Replaces a cell by those that follow from its attempt.
void PenetrationCover::follow(const TranslationCell& cell, const CellProof& proof) {
  TranslationCell next = cell;
  if (!proof.seeds.empty()) next.drop_seeds(proof.used);
  next.searched = proof.searched;
  for (auto seed = proof.seeds.rbegin(); seed != proof.seeds.rend(); ++seed) next.add_seed(*seed);
  switch (proof.next) {
    case CellProof::Next::proven: {
      const double end = target(), rest = end - cell.r1;
      if (rest <= 0.0) return;
      next.r0 = cell.r1;
      next.r1 = cell.r1 + (1.0 - k_step_left) * (translation_.norm() - cell.r1);
      if (end - next.r1 < k_small_rest * rest) next.r1 = end;
      return put(next);
    }
    case CellProof::Next::shorten:
      next.r1 = 0.5 * (cell.r0 + cell.r1);
      return put(next);
    case CellProof::Next::halve:
      put(next.halved(0));
      put(next.halved(1));
  }
}

double PenetrationCover::covered() const {
  double lo = target();
  if (!open_.empty()) lo = std::min(lo, open_.begin()->first.first);
  for (const double r0 : given_up_) lo = std::min(lo, r0);
  return lo;
}

PenetrationDepth PenetrationCover::run() {
  while (own_.measurements() + result_.measurements + result_.cells < budget_) {
    const std::vector<TranslationCell> batch = take_batch();
    if (batch.empty()) break;
    const double limit = translation_.norm();
    std::vector<CellProof> proofs(batch.size());
    parallel::for_each(batch.size(),
                       [&](std::size_t i) { proofs[i] = provers_.local().prove(batch[i], pool_, limit); });
    result_.cells += batch.size();
    for (const CellProof& proof : proofs) {
      result_.measurements += proof.measurements;
      if (proof.free) shorten_translation(*proof.free);
      if (proof.found && pool_.size() < k_largest_pool) pool_.push_back(*proof.found);
    }
    for (std::size_t i = 0; i < batch.size(); ++i) follow(batch[i], proofs[i]);
  }
  if (!is_descended_) descend();
  result_.lo = covered();
  result_.closed = result_.lo >= target();
  for (const auto& [key, cell] : open_) result_.open_cells += key.first < target();
  result_.open_cells +=
      static_cast<std::uint64_t>(std::ranges::count_if(given_up_, [&](double r0) { return r0 < target(); }));
  result_.measurements += own_.measurements();
  result_.casts = own_.translations().casts();
  result_.translation = translation_;
  result_.hi = translation_.norm();
  return result_;
}

}  // namespace sixdof::detail
