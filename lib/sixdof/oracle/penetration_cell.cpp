#include <sixdof/oracle/penetration_cell.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>
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
/// Other common points are tried if they are deeper than those that failed by this factor.
constexpr double k_deeper = 1.2;
/// Less deep than this part of the length that is left to the limit, common points are searched where the surfaces
/// cross: from so many pairs of triangles, and again in parts of the cell smaller by this factor.
constexpr double k_stuck = 0.3;
constexpr std::size_t k_crossings = 12;
constexpr double k_search_again = 0.6;
/// First step from a guess by balls, by the smaller radius.
constexpr double k_ball_step = 0.2;
/// First step from the surfaces, by the smaller of the bodies' radii.
constexpr double k_crossing_step = 1e-2;
/// Pairs of triangles, and corners of each mesh, from which the pool is searched; points that are kept.
constexpr std::size_t k_pool_pairs = 48, k_pool_corners = 16, k_pool_size = 16;
/// Points of a pool that are tried for a cell.
constexpr std::size_t k_pool_tries = 16;
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

void TranslationCell::drop_seeds(std::size_t count) {
  for (std::size_t i = count; i < seed_count; ++i) seeds[i - count] = seeds[i];
  seed_count -= std::min(count, seed_count);
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

/// What is known while a cell is tried.
struct CellProver::Attempt {
  const TranslationCell& cell;
  Corners corners;
  double limit;
  CellProof proof = {};
  std::optional<Vector3d> lost = {};  ///< An outer corner at which a common point was not found.
  double deepest = 0.0;               ///< Of the common points in the middle.
  bool gap = true;                    ///< The last one was lost at a corner, or there is none.
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

/// Common points at the corners, near the seed's.
/// @param lost an outer corner at which none was found
CellProver::Cover CellProver::covers(const PlacedPoint& seed, const Corners& corners, std::optional<Vector3d>& lost) {
  std::array<Vector3d, 6> of_a, of_b;
  CommonPointSearch::Effort effort = k_corner;
  effort.enough = k_enough * seed.point.depth();
  for (std::size_t k = 0; k < corners.count; ++k) {
    const CommonPoint point = move(seed, corners.at[k], effort).point;
    if (point.depth() <= k_least_depth * clearance_) {
      if (k < Corners::k_outer && !lost) lost = corners.at[k];
      return Cover::gap;
    }
    of_a[k] = point.p;
    of_b[k] = point.b.p;
  }
  const bool clear =
      is_hull_clear(oracle_.distance_oracle().tree_a(), std::span(of_a.data(), corners.count), clearance_) &&
      is_hull_clear(oracle_.distance_oracle().tree_b(), std::span(of_b.data(), corners.count), clearance_);
  return clear ? Cover::whole : Cover::blocked;
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

/// The deepest of those that were found nearest to the translation.
std::optional<PlacedPoint> CellProver::best_of(std::span<const PlacedPoint> pool, const Vector3d& translation) {
  nearest_.clear();
  for (std::size_t i = 0; i < pool.size(); ++i) {
    nearest_.emplace_back((pool[i].translation - translation).squaredNorm(), i);
  }
  const std::size_t count = std::min(k_pool_tries, nearest_.size());
  std::ranges::partial_sort(nearest_, nearest_.begin() + static_cast<std::ptrdiff_t>(count));
  const PlacedPoint* best = nullptr;
  double deepest = 0.0;
  const Pose X = FreeTranslations::moved(X_AB_, translation);
  for (const auto& [distance, i] : std::span(nearest_).first(count)) {
    const Vector3d half_way = pool[i].point.p + 0.5 * (translation - pool[i].translation);
    const double depth = points_.at(half_way, X, pool[i].point).depth();
    if (best != nullptr && depth <= deepest) continue;
    best = &pool[i];
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

/// The deepest point above the curves in which the surfaces cross after a translation.
std::optional<PlacedPoint> CellProver::from_crossings(const Vector3d& translation) {
  const Tree &a = oracle_.distance_oracle().tree_a(), &b = oracle_.distance_oracle().tree_b();
  const Pose X = FreeTranslations::moved(X_AB_, translation);
  scratch_.axes = {};  // they learn
  find_candidates(a, b, X, scratch_, pairs_);
  std::vector<std::pair<TrianglePair, Vector3d>> crossings;
  for (const TrianglePair& pair : pairs_) {
    Tree::Corners of_b;
    for (std::size_t k = 0; k < 3; ++k) of_b[k] = transform_point(X, b.corners()[pair.b][k]);
    const std::optional<Segment> segment = cross(a.corners()[pair.a], of_b);
    if (segment) crossings.emplace_back(pair, 0.5 * (segment->start + segment->end));
  }
  const double step = k_crossing_step * std::min(a.radius(), b.radius());
  std::optional<PlacedPoint> best;
  for (const std::size_t i : spread(crossings.size(), k_crossings)) {
    const auto& [pair, p] = crossings[i];
    const CommonPoint start = points_.at(p, X, a.mesh_triangle()[pair.a], b.mesh_triangle()[pair.b]);
    const CommonPoint top = points_.ascend(start, X, step, k_middle);
    if (!best || top.depth() > best->point.depth()) best = PlacedPoint{translation, top};
  }
  return best;
}

/// Whether a common point in the middle of the cell, if it is one, proves the cell.
bool CellProver::proves(const PlacedPoint& middle, Attempt& attempt) {
  const double depth = middle.point.depth();
  if (depth <= k_least_depth * clearance_) return false;
  std::vector<PlacedPoint>& seeds = attempt.proof.seeds;
  seeds.insert(depth > attempt.deepest ? seeds.begin() : seeds.end(), middle);
  attempt.deepest = std::max(attempt.deepest, depth);
  const Cover cover = covers(middle, attempt.corners, attempt.lost);
  attempt.gap = cover == Cover::gap;
  return cover == Cover::whole;
}

/// A common point that does not prove the cell is usually the one that proves its parts. So others are searched only
/// where there is none, where balls are known to overlap deeper, or where the overlap vanishes inside of the cell: of
/// bodies that overlap in several places, the place that is left behind proves nothing around it.
bool CellProver::finds_proof(std::span<const PlacedPoint> pool, Attempt& attempt) {
  const TranslationCell& cell = attempt.cell;
  const Vector3d& middle = attempt.corners.middle;
  const auto is_deeper = [&](const std::optional<PlacedPoint>& x) {
    return x && x->point.depth() > k_deeper * attempt.deepest;
  };
  while (attempt.gap && attempt.proof.used < cell.seed_count) {
    const PlacedPoint moved = move(cell.seeds[attempt.proof.used++], middle, k_middle);
    if (is_deeper(moved) && proves(moved, attempt)) return true;
  }
  const double least = attempt.proof.seeds.empty() ? -1.0 : k_deeper * attempt.deepest;
  if (const auto balls = from_balls(middle, least); balls && proves(*balls, attempt)) return true;
  if (!attempt.gap) return false;
  const std::optional<PlacedPoint> known = best_of(pool, middle);
  if (is_deeper(known) && proves(*known, attempt)) return true;
  const double size = std::max(cell.r1 - cell.r0, cell.r1 * cell.longest_side().first);
  const bool is_stuck = attempt.gap && attempt.deepest <= k_stuck * (attempt.limit - cell.r1);
  if (!is_stuck || size > k_search_again * cell.searched) return false;
  attempt.proof.searched = size;
  const std::optional<PlacedPoint> crossing = from_crossings(middle);
  if (!is_deeper(crossing)) return false;
  attempt.proof.found = crossing;
  return proves(*crossing, attempt);
}

CellProof CellProver::prove(const TranslationCell& cell, std::span<const PlacedPoint> pool, double limit) {
  const std::uint64_t before = points_.measurements();
  Attempt attempt{.cell = cell, .corners = Corners(cell), .limit = limit};
  CellProof& proof = attempt.proof;
  proof.searched = cell.searched;
  if (finds_proof(pool, attempt)) {
    proof.next = CellProof::Next::proven;
  } else {
    // Where no common point was found in the middle of the cell either, it may be free itself.
    const bool nowhere = proof.seeds.empty();
    if (nowhere) attempt.lost = attempt.corners.middle;
    const double outer = attempt.corners.at[0].norm(), side = cell.r1 * cell.longest_side().first;
    if (attempt.lost) examine(*attempt.lost, limit, proof);
    const bool far_corners = attempt.lost && !nowhere && outer - cell.r1 > k_far_corners * (limit - cell.r1);
    if (!far_corners && cell.r1 - cell.r0 > side) proof.next = CellProof::Next::shorten;
  }
  proof.measurements = points_.measurements() - before;
  return std::move(proof);
}

std::vector<PlacedPoint> CellProver::find_pool() {
  const Tree &a = oracle_.distance_oracle().tree_a(), &b = oracle_.distance_oracle().tree_b();
  std::vector<CommonPoint> found;
  const auto climb = [&](const Vector3d& p, std::uint32_t of_a, std::uint32_t of_b, double step) {
    const CommonPoint start = points_.at(p, X_AB_, a.mesh_triangle()[of_a], b.mesh_triangle()[of_b]);
    const CommonPoint top = points_.ascend(start, X_AB_, std::abs(start.depth()) + step, k_thorough);
    if (top.depth() > k_least_depth * clearance_) found.push_back(top);
  };
  scratch_.axes = {};
  find_candidates(a, b, X_AB_, scratch_, pairs_);
  const double step = k_crossing_step * std::min(a.radius(), b.radius());
  for (const std::size_t i : spread(pairs_.size(), k_pool_pairs)) {
    const Vector3d of_b = X_AB_ * middle_of(b.corners()[pairs_[i].b]);
    climb(0.5 * (middle_of(a.corners()[pairs_[i].a]) + of_b), pairs_[i].a, pairs_[i].b, step);
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
