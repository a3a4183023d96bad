#include <sixdof/oracle/penetration_cell.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/hull_inside.h>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// Of a point in the middle of a cell, and of the points at its corners: these only have to lie inside both bodies.
constexpr CommonPointSearch::Effort k_middle{.gain = 0.2, .most = 30};
constexpr CommonPointSearch::Effort k_corner{.gain = 0.5, .most = 20};
/// A point at a corner as deep as this part of the middle's is deep enough.
constexpr double k_enough = 0.5;
constexpr CommonPointSearch::Effort k_thorough{.gain = 0.02, .most = 30};
/// Least depth of a common point, in clearances.
constexpr double k_least_depth = 4.0;
/// Other balls are tried if they are deeper than the point of the seed by this factor.
constexpr double k_deeper = 1.2;
/// Common points less deep than this part of a cell's size are where an overlap vanishes: others are searched.
constexpr double k_vanishing = 0.3;
/// First step from a guess by balls, by the smaller radius.
constexpr double k_ball_step = 0.2;
/// Pairs of triangles, and corners of each mesh, from which the pool is searched; points that are kept.
constexpr std::size_t k_pool_pairs = 48, k_pool_corners = 16, k_pool_size = 16;
/// A point nearer to a deeper one than this part of that one's depth is the same maximum.
constexpr double k_same_maximum = 0.25;
/// A part of the length that is left to the limit. Corners of a cell farther beyond r1 than that: halving its
/// directions brings them nearer.
constexpr double k_far_corners = 0.25;

Vector3d middle_of(const Tree::Corners& c) { return (c[0] + c[1] + c[2]) / 3.0; }

/// Evenly spread numbers below n, `count` at most.
std::vector<std::size_t> spread(std::size_t n, std::size_t count) {
  std::vector<std::size_t> numbers(std::min(n, count));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i * n / numbers.size();
  return numbers;
}

double clearance_of(const DistanceOracle& oracle, const Pose& X_AB) {
  const Tree &a = oracle.tree_a(), &b = oracle.tree_b();
  // Points are brought back to B's frame by the transposed matrix.
  const double defect = (X_AB.R.transpose() * X_AB.R - Eigen::Matrix3d::Identity()).norm();
  return (PenetrationOracle::k_clearance + defect) *
         (2.0 * (a.radius() + b.radius()) + a.center().norm() + b.center().norm() + X_AB.t.norm());
}

}  // namespace

double TranslationCell::plane_distance() const {
  return std::abs((u[1] - u[0]).cross(u[2] - u[0]).normalized().dot(u[0]));
}

std::pair<double, std::size_t> TranslationCell::longest_side() const {
  std::pair<double, std::size_t> longest{-1.0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (u[(k + 1) % 3] - u[k]).norm();
    if (length > longest.first) longest = {length, k};
  }
  return longest;
}

TranslationCell TranslationCell::halved(std::size_t half) const {
  const std::size_t k = longest_side().second, next = (k + 1) % 3;
  TranslationCell cell = *this;
  cell.u[half == 0 ? next : k] = (u[k] + u[next]).normalized();
  return cell;
}

void TranslationCell::add_seed(const PlacedPoint& seed) {
  seed_count = std::min(seed_count + 1, k_most_seeds);
  for (std::size_t i = seed_count - 1; i > 0; --i) seeds[i] = seeds[i - 1];
  seeds[0] = seed;
}

/// Corners of a cell's hull, the outer ones first, and a translation between the outer ones.
struct CellProver::Corners {
  std::array<Vector3d, 6> at;
  std::size_t count;
  Vector3d middle;

  explicit Corners(const TranslationCell& cell) {
    const double outer = cell.r1 / cell.plane_distance();
    for (std::size_t k = 0; k < 3; ++k) at[k] = outer * cell.u[k];
    for (std::size_t k = 0; k < 3; ++k) at[3 + k] = cell.r0 * cell.u[k];
    count = cell.r0 > 0.0 ? 6 : 4;
    middle = cell.r1 * (cell.u[0] + cell.u[1] + cell.u[2]).normalized();
  }
  static constexpr std::size_t k_outer = 3;
};

CellProver::CellProver(const PenetrationOracle& oracle, const Pose& X_AB)
    : oracle_(oracle),
      X_AB_(X_AB),
      clearance_(clearance_of(oracle.distance_oracle(), X_AB)),
      balls_b_(oracle.balls_b().moved(X_AB)),
      points_(oracle.a(), oracle.distance_oracle().tree_a(), oracle.b(), oracle.distance_oracle().tree_b()),
      free_(oracle.distance_oracle()) {}

/// The common point near a known one after another translation: half way between the point that stays in A and the one
/// that moves with B, and from there to a deep one.
PlacedPoint CellProver::move(const PlacedPoint& from, const Vector3d& translation,
                             const CommonPointSearch::Effort& effort) {
  const Vector3d way = translation - from.translation;
  const Pose X = FreeTranslations::moved(X_AB_, translation);
  const CommonPoint start = points_.at(from.point.p + 0.5 * way, X, from.point);
  const double tau = std::abs(start.depth()) + std::max(0.5 * way.norm(), k_least_depth * clearance_);
  return {translation, points_.ascend(start, X, tau, effort)};
}

/// Whether common points at the corners, near the seed's, prove the cell.
/// @param lost an outer corner at which none was found
bool CellProver::covers(const PlacedPoint& seed, const Corners& corners, std::optional<Vector3d>& lost) {
  std::array<Vector3d, 6> of_a, of_b;
  CommonPointSearch::Effort effort = k_corner;
  effort.enough = k_enough * seed.point.depth();
  for (std::size_t k = 0; k < corners.count; ++k) {
    const CommonPoint point = move(seed, corners.at[k], effort).point;
    if (point.depth() <= k_least_depth * clearance_) {
      if (k < Corners::k_outer && !lost) lost = corners.at[k];
      return false;
    }
    of_a[k] = point.p;
    of_b[k] = point.b.p;
  }
  return is_hull_clear(oracle_.distance_oracle().tree_a(), std::span(of_a.data(), corners.count), clearance_) &&
         is_hull_clear(oracle_.distance_oracle().tree_b(), std::span(of_b.data(), corners.count), clearance_);
}

/// The deepest point in the balls of both bodies that overlap most, and from there up; none if a body has no balls, or
/// if they prove no depth above `least` (length; negative: for whatever they guess).
std::optional<PlacedPoint> CellProver::from_balls(const Vector3d& translation, double least) {
  const InnerBalls& balls_a = oracle_.balls_a();
  if (balls_a.size() == 0 || balls_b_.size() == 0) return std::nullopt;
  const BallPair pair = deepest_pair(balls_a, balls_b_, translation);
  if (least >= 0.0 && 0.5 * pair.overlap <= least) return std::nullopt;
  const Pose X = FreeTranslations::moved(X_AB_, translation);
  const CommonPoint start = points_.at(pair.p, X, balls_a.triangle[pair.a], balls_b_.triangle[pair.b]);
  const double tau = std::abs(start.depth()) + k_ball_step * std::min(balls_a.radius[pair.a], balls_b_.radius[pair.b]);
  return PlacedPoint{translation, points_.ascend(start, X, tau, k_middle)};
}

std::optional<PlacedPoint> CellProver::best_of(std::span<const PlacedPoint> pool, const Vector3d& translation) {
  const PlacedPoint* best = nullptr;
  double deepest = 0.0;
  const Pose X = FreeTranslations::moved(X_AB_, translation);
  for (const PlacedPoint& each : pool) {
    const Vector3d half_way = each.point.p + 0.5 * (translation - each.translation);
    const double depth = points_.at(half_way, X, each.point).depth();
    if (best != nullptr && depth <= deepest) continue;
    best = &each;
    deepest = depth;
  }
  if (best == nullptr) return std::nullopt;
  return move(*best, translation, k_middle);
}

/// What is at a corner without a common point: a free translation, or other common points.
void CellProver::examine(const Vector3d& lost, double limit, CellProof& proof) {
  if (lost.norm() >= limit) return;  // it may be free, and the cell is not proven by it in either case
  if (free_.is_free(X_AB_, lost)) {
    proof.free = lost;
    return;
  }
  const std::optional<Vector3d> p = free_.crossing(X_AB_, lost);
  if (!p) return;
  const Pose X = FreeTranslations::moved(X_AB_, lost);
  const CommonPoint start = points_.at(*p, X, 0, 0);
  const double step = 1e-3 * std::max(limit, clearance_);
  proof.seeds.push_back({lost, points_.ascend(start, X, step, k_middle)});
}

CellProof CellProver::prove(const TranslationCell& cell, std::span<const PlacedPoint> pool, double limit) {
  CellProof proof;
  const std::uint64_t before = points_.measurements();
  const Corners corners(cell);
  std::optional<Vector3d> lost;
  const auto tries = [&](const PlacedPoint& middle) {
    if (middle.point.depth() <= k_least_depth * clearance_) return false;
    proof.seeds.insert(proof.seeds.begin(), middle);
    if (!covers(middle, corners, lost)) return false;
    proof.next = CellProof::Next::proven;
    return true;
  };
  // A common point that does not prove the cell is usually the one that proves its parts: so others are searched only
  // where there is none, or where balls are known to overlap deeper.
  const auto finds_seed = [&] {
    for (std::size_t i = 0; i < cell.seed_count && proof.seeds.empty(); ++i) {
      if (tries(move(cell.seeds[i], corners.middle, k_middle))) return true;
    }
    const double found = proof.seeds.empty() ? -1.0 : proof.seeds.front().point.depth();
    if (const auto balls = from_balls(corners.middle, k_deeper * found); balls && tries(*balls)) return true;
    // Bodies that overlap in several places: one that is nearly left behind proves nothing around it.
    const double size = std::max(cell.r1 - cell.r0, cell.r1 * cell.longest_side().first);
    const double deepest = proof.seeds.empty() ? 0.0 : proof.seeds.front().point.depth();
    if (deepest > k_vanishing * size) return false;
    const std::optional<PlacedPoint> other = best_of(pool, corners.middle);
    return other && other->point.depth() > k_deeper * deepest && tries(*other);
  };
  if (!finds_seed()) {
    // Where no common point was found in the middle of the cell either, it may be free itself.
    const bool nowhere = proof.seeds.empty();
    if (nowhere) lost = corners.middle;
    const double outer = corners.at[0].norm(), side = cell.r1 * cell.longest_side().first;
    if (lost) examine(*lost, limit, proof);
    const bool far_corners = lost && !nowhere && outer - cell.r1 > k_far_corners * (limit - cell.r1);
    if (!far_corners && cell.r1 - cell.r0 > side) proof.next = CellProof::Next::shorten;
  }
  proof.measurements = points_.measurements() - before;
  return proof;
}

std::vector<PlacedPoint> CellProver::find_pool() {
  const Tree &a = oracle_.distance_oracle().tree_a(), &b = oracle_.distance_oracle().tree_b();
  std::vector<CommonPoint> found;
  const auto climb = [&](const Vector3d& p, std::uint32_t of_a, std::uint32_t of_b, double step) {
    const CommonPoint start = points_.at(p, X_AB_, a.mesh_triangle()[of_a], b.mesh_triangle()[of_b]);
    const CommonPoint top = points_.ascend(start, X_AB_, std::abs(start.depth()) + step, k_thorough);
    if (top.depth() > k_least_depth * clearance_) found.push_back(top);
  };
  CandidateScratch scratch;
  std::vector<TrianglePair> pairs;
  find_candidates(a, b, X_AB_, scratch, pairs);
  const double step = 1e-2 * std::min(a.radius(), b.radius());
  for (const std::size_t i : spread(pairs.size(), k_pool_pairs)) {
    const Vector3d of_b = X_AB_ * middle_of(b.corners()[pairs[i].b]);
    climb(0.5 * (middle_of(a.corners()[pairs[i].a]) + of_b), pairs[i].a, pairs[i].b, step);
  }
  for (const std::size_t i : spread(a.corners().size(), k_pool_corners)) {
    climb(a.corners()[i][0], static_cast<std::uint32_t>(i), 0, step);
  }
  for (const std::size_t i : spread(b.corners().size(), k_pool_corners)) {
    climb(X_AB_ * b.corners()[i][0], 0, static_cast<std::uint32_t>(i), step);
  }
  std::ranges::stable_sort(found, [](const CommonPoint& x, const CommonPoint& y) { return x.depth() > y.depth(); });
  std::vector<PlacedPoint> pool;
  for (const CommonPoint& point : found) {
    const bool known = std::ranges::any_of(pool, [&](const PlacedPoint& other) {
      return (other.point.p - point.p).norm() < k_same_maximum * other.point.depth();
    });
    if (!known && pool.size() < k_pool_size) pool.push_back({Vector3d::Zero(), point});
  }
  return pool;
}

}  // namespace sixdof::detail
