#include <sixdof/oracle/cast_search.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/distance_search.h>

namespace sixdof {
namespace {

using detail::NodePair;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double k_never = std::numeric_limits<double>::infinity();

/// Rounding of bounds on speeds, relative; of gaps, relative to the coordinates.
constexpr double k_speed_rounding = 1.0 + 1e-12;
constexpr double k_gap_rounding = 1e-14;

/// A pair of volumes waits again as long as its bound is more than this part of the first one; then it is split.
constexpr double k_worth_waiting = 0.5;
/// And if that is more than this part of the motion: where a gap is as small as rounding, it does not grow.
constexpr double k_least_wait = 1e-6;

/// At so many roundings the direction of the shortest line between triangles is known.
constexpr double k_clear = 1e6;

/// Triangles that touch within this part of the motion are bounded along their edges' cross products, too.
constexpr double k_close = 1e-4;

bool is_leaf(std::uint32_t volume) { return (volume & NodePair::k_leaf) != 0; }
bool is_triangle(std::uint32_t volume) { return !is_leaf(volume) && (volume & NodePair::k_triangle) != 0; }

const Tree::Volume& volume_of(const Tree& tree, std::uint32_t volume) {
  return is_leaf(volume) ? tree.leaves()[volume - NodePair::k_leaf].volume : tree.nodes()[volume].volume;
}

/// A box and a slab in doubles, relative to the tree's centre.
struct Volume {
  Vector3d center, half, normal;
  double slab_lower, slab_upper;

  explicit Volume(const Tree::Volume& from) {
    for (int k = 0; k < 3; ++k) {
      const double lower = from.lower[k], upper = from.upper[k];
      center[k] = 0.5 * (lower + upper);
      half[k] = 0.5 * (upper - lower);
      normal[k] = from.normal[k];
    }
    slab_lower = from.slab_lower;
    slab_upper = from.slab_upper;
  }

  /// Upper bound on n . p for the points p of the volume.
  double support(const Vector3d& n) const {
    const double of_box = n.dot(center) + half.dot(n.cwiseAbs());
    // The component of n along the slab's normal is bounded by the slab, the rest by the box.
    const double along = n.dot(normal);
    const Vector3d rest = n - along * normal;
    const double of_slab =
        (along >= 0.0 ? along * slab_upper : along * slab_lower) + rest.dot(center) + half.dot(rest.cwiseAbs());
    return std::min(of_box, of_slab);
  }
};

/// Time for which a gap that closes at `speed` and accelerates by at most `acceleration` stays open.
double time_of(double gap, double speed, double acceleration) {
  const double root = std::sqrt(speed * speed + 2.0 * acceleration * gap);
  if (speed > 0.0) return 2.0 * gap / (speed + root);
  return acceleration > 0.0 ? (root - speed) / acceleration : k_never;
}

/// Area times normal.
Vector3d area_vector(const Tree::Corners& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }

/// Largest factor by which a matrix close to a rotation lengthens a vector.
double stretch_of(const Matrix3d& R) {
  return std::sqrt(1.0 + (R.transpose() * R - Matrix3d::Identity()).norm()) * k_speed_rounding;
}

/// Largest distance of a point of the mesh from its origin.
double reach_of(const Tree& tree) { return tree.center().norm() + tree.radius(); }

}  // namespace

/// The pose at one time and what all pairs need of it. Vectors are in A's axes.
class CastSearch::Moment {
 public:
  Moment(const CastSearch& search, double time)
      : t(time),
        X(search.motion_.pose_at(time)),
        search_(search),
        velocity_(search.motion_.translation),
        rotation_(search.motion_.rotation),
        turn_(rotation_.norm()),
        axis_(turn_ > 0.0 ? Vector3d(rotation_ / turn_) : Vector3d::Zero()),
        pivot_(X * search.motion_.reference),
        shift_(X * search.b_.center() - search.a_.center()) {}

  const double t;
  const Pose X;

  /// How long two volumes stay apart, at least: 0 where no axis separates them now. Ends early where that is longer
  /// than `enough`.
  double time_apart(const Tree::Volume& a, const Tree::Volume& b, double enough) const {
    const Volume x(a), y(b);
    const Vector3d arm = X.R * y.center + (shift_ + search_.a_.center() - pivot_);  // of B's volume, from the pivot
    const Vector3d line = X.R * y.center + shift_ - x.center;
    const double rho = axis_.cross(arm).norm() + search_.stretch_ * y.half.norm();
    double best = 0.0;
    const auto try_axis = [&](const Vector3d& n) {
      best = std::max(best, time_along(n.dot(line) >= 0.0 ? n : Vector3d(-n), x, y, arm, rho));
      return best > enough;
    };
    const double length = line.norm();
    if (length > 0.0 && try_axis(line / length)) return best;
    if (try_axis(x.normal) || try_axis(X.R * y.normal)) return best;
    for (int k = 0; k < 3; ++k) {
      if (try_axis(Vector3d::Unit(k)) || try_axis(X.R.col(k))) return best;
    }
    const Vector3d course = velocity_ + rotation_.cross(arm);
    const Vector3d across = line - course * (course.dot(line) / course.squaredNorm());
    const double width = across.norm();
    if (width > 0.0) try_axis(across / width);
    return best;
  }

  /// Corners of a triangle of B.
  Tree::Corners moved(const Tree::Corners& p) const { return {X * p[0], X * p[1], X * p[2]}; }

  /// The same for two triangles along one axis, of any length.
  /// @param b moved
  double time_apart(const Vector3d& axis, const Tree::Corners& a, const Tree::Corners& b) const {
    const double length = axis.norm();
    if (!(length > 0.0)) return 0.0;
    Vector3d n = axis / length;
    if (n.dot(b[0] - a[0]) < 0.0) n = -n;
    const Vector3d w = n.cross(rotation_);
    const double turn = w.norm(), advance = -n.dot(velocity_);
    const double reach_a = std::max({0.0, n.dot(a[1] - a[0]), n.dot(a[2] - a[0])});
    double least = k_never;
    for (const Vector3d& q : b) {
      const Vector3d arm = q - pivot_;
      const double gap = n.dot(q - a[0]) - reach_a - search_.margin_;
      const double rho = axis_.cross(arm).norm();
      const double time = bounded_time(gap, advance + turn * rho, advance - arm.dot(w), turn_ * turn * rho);
      least = std::min(least, time);
    }
    return least;
  }

 private:
  /// @param n from A to B, not longer than a unit vector
  double time_along(const Vector3d& n, const Volume& x, const Volume& y, const Vector3d& arm, double rho) const {
    const Vector3d in_b = X.R.transpose() * n;
    const double gap = n.dot(shift_) - y.support(-in_b) - x.support(n) - search_.margin_;
    if (gap <= 0.0) return 0.0;
    const Vector3d w = n.cross(rotation_);
    const double turn = w.norm(), advance = -n.dot(velocity_);
    const double speed = advance - arm.dot(w) + y.half.dot((X.R.transpose() * w).cwiseAbs());
    return bounded_time(gap, advance + turn * rho, speed, turn_ * turn * rho);
  }

  double bounded_time(double gap, double most_speed, double speed, double acceleration) const {
    const double factor = k_speed_rounding * search_.speed_factor;
    // Roundings of a difference are relative to its terms.
    const double slack = (k_speed_rounding - 1.0) * search_.largest_speed_;
    if (gap > 0.0) {
      if (most_speed <= 0.0) return k_never;
      return std::max(gap / (factor * most_speed), time_of(gap, factor * speed + slack, factor * acceleration));
    }
    // Apart by less than rounding: it stays so as long as all of it recedes.
    return gap > -search_.margin_ && speed < -slack ? time_of(0.0, speed + slack, factor * acceleration) : 0.0;
  }

  const CastSearch& search_;
  const Vector3d velocity_, rotation_;
  const double turn_;
  const Vector3d axis_, pivot_, shift_;
};

CastSearch::CastSearch(const Tree& a, const Tree& b) : a_(a), b_(b) {}

void CastSearch::push(const Waiting& pair) {
  queue_.push_back(pair);
  std::push_heap(queue_.begin(), queue_.end());
}

CastSearch::Waiting CastSearch::pop() {
  std::pop_heap(queue_.begin(), queue_.end());
  const Waiting next = queue_.back();
  queue_.pop_back();
  return next;
}

/// Bounds a pair of volumes and lets it wait, unless it stays apart to the end.
void CastSearch::wait(const Moment& moment, std::uint32_t a, std::uint32_t b) {
  ++counts_.pairs;
  const double left = 1.0 - moment.t;
  const double apart = moment.time_apart(volume_of(a_, a), volume_of(b_, b), left);
  if (apart <= left) push({moment.t + apart, a, b, apart});
}

/// Bounds a pair again that has waited. @return whether it waits on, or was dropped
bool CastSearch::waits_again(const Moment& moment, const Waiting& pair) {
  if (pair.first_wait <= k_least_wait) return false;
  ++counts_.pairs;
  const double left = 1.0 - moment.t;
  const double apart = moment.time_apart(volume_of(a_, pair.a), volume_of(b_, pair.b), left);
  if (apart > left) return true;
  if (apart <= std::max(k_worth_waiting * pair.first_wait, k_least_wait)) return false;
  push({moment.t + apart, pair.a, pair.b, pair.first_wait});
  return true;
}

/// Replaces the larger volume by its children, or both leaves by their triangles.
void CastSearch::split(const Moment& moment, std::uint32_t a, std::uint32_t b) {
  if (!is_leaf(a) || !is_leaf(b)) {
    const bool of_a =
        is_leaf(b) || (!is_leaf(a) && volume_of(a_, a).squared_diagonal() >= volume_of(b_, b).squared_diagonal());
    const Tree::Node& node = of_a ? a_.nodes()[a] : b_.nodes()[b];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      of_a ? wait(moment, node.number[i], b) : wait(moment, a, node.number[i]);
    }
    return;
  }
  const Tree::Child x = a_.leaves()[a - NodePair::k_leaf].child, y = b_.leaves()[b - NodePair::k_leaf].child;
  std::array<Tree::Corners, Tree::k_leaf_triangles> moved;
  std::array<Vector3d, Tree::k_leaf_triangles> normals;
  for (std::uint32_t j = 0; j < y.count(); ++j) {
    moved[j] = moment.moved(b_.corners()[y.first() + j]);
    normals[j] = area_vector(moved[j]);
  }
  const double left = 1.0 - moment.t;
  for (std::uint32_t i = x.first(); i < x.first() + x.count(); ++i) {
    const Tree::Corners& corners = a_.corners()[i];
    const Vector3d normal = area_vector(corners), middle = corners[0] + corners[1] + corners[2];
    for (std::uint32_t j = 0; j < y.count(); ++j) {
      double apart = moment.time_apart(moved[j][0] + moved[j][1] + moved[j][2] - middle, corners, moved[j]);
      if (apart <= left) apart = std::max(apart, moment.time_apart(normal, corners, moved[j]));
      if (apart <= left) apart = std::max(apart, moment.time_apart(normals[j], corners, moved[j]));
      if (apart <= left) push({moment.t + apart, NodePair::k_triangle + i, NodePair::k_triangle + y.first() + j});
    }
  }
}

/// The same along the cross products of both triangles' edges. Close to contact of two edges their closest points
/// differ by little more than rounding, so the line through them separates no longer; the cross product does.
double CastSearch::time_along_edges(const Moment& moment, const Tree::Corners& a, const Tree::Corners& b) {
  double apart = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      apart = std::max(apart, moment.time_apart((a[(i + 1) % 3] - a[i]).cross(b[(j + 1) % 3] - b[j]), a, b));
    }
  }
  return apart;
}

/// Measures a pair of triangles. @return whether it touches; if not, it waits or is dropped
bool CastSearch::is_contact(const Moment& moment, std::uint32_t a, std::uint32_t b, Impact& impact) {
  ++counts_.triangles;
  const Tree::Corners& p = a_.corners()[a - NodePair::k_triangle];
  const Tree::Corners& q = b_.corners()[b - NodePair::k_triangle];
  const Tree::Corners at = moment.moved(q);
  const ClosestPoints closest = triangle_triangle_distance(p, at);
  const double left = 1.0 - moment.t;
  double apart = 0.0;
  if (closest.distance > 0.0) {
    for (const Vector3d& n : {Vector3d(closest.on_b - closest.on_a), area_vector(p), area_vector(at)}) {
      apart = std::max(apart, moment.time_apart(n, p, at));
    }
    if (apart < k_close) apart = std::max(apart, time_along_edges(moment, p, at));
    if (apart > left) return false;
    const double resolution = std::max(k_resolution, least_time_);
    if (apart >= resolution) return push({moment.t + apart, a, b}), false;
    // Soon. Where the gap is lost in rounding, this is the contact, although exact tests may miss it.
    const double next = moment.t + apart;
    const bool stuck = !(next > moment.t) || apart < 1e-3 * least_time_;
    const Pose soon = motion_.pose_at(std::min(1.0, moment.t + resolution));
    if (!stuck && !triangles_intersect(p, {soon * q[0], soon * q[1], soon * q[2]})) return push({next, a, b}), false;
    impact = impact_of(a, b, moment.t > 0.0 ? moment.t : std::min(1.0, 0.5 * resolution));
    return true;
  }
  impact = impact_of(a, b, moment.t);
  return true;
}

/// Points at the contact; the normal of a little earlier, where the distance is not lost in rounding.
Impact CastSearch::impact_of(std::uint32_t a, std::uint32_t b, double t) const {
  const Tree::Corners& p = a_.corners()[a - NodePair::k_triangle];
  const Tree::Corners& q = b_.corners()[b - NodePair::k_triangle];
  const auto closest_at = [&](double time) {
    const Pose X = motion_.pose_at(time);
    return triangle_triangle_distance(p, {X * q[0], X * q[1], X * q[2]});
  };
  Impact impact{.hit = true, .t = t, .has_witnesses = true};
  ClosestPoints closest = closest_at(t);
  impact.witness_a = closest.on_a;
  impact.witness_b = closest.on_b;
  // It takes at least as long to go so far.
  const double far = k_clear * margin_;
  for (double back = std::max({k_resolution, least_time_, far / largest_speed_}); closest.distance < far && back < 1e-4;
       back *= 8.0) {
    closest = closest_at(std::max(0.0, t - back));
  }
  const Vector3d line = closest.on_b - closest.on_a;
  const double length = line.norm();
  if (length > 0.0) impact.normal = line / length;
  return impact;
}

double cast_margin(const Motion& motion, const Tree& a, const Tree& b) {
  const double stretch = stretch_of(motion.start.R), reach = stretch * reach_of(b);
  return 2.0 * motion.pose_error(reach) + k_gap_rounding * (a.radius() + stretch * b.radius()) +
         1e-15 * (reach_of(a) + reach);
}

/// @return whether B moves
bool CastSearch::begin(const Motion& motion) {
  counts_ = {};
  queue_.clear();
  motion_ = motion;
  stretch_ = stretch_of(motion.start.R);
  margin_ = cast_margin(motion, a_, b_);
  const double arm = stretch_ * reach_of(b_) + stretch_ * motion.reference.norm();
  largest_speed_ = motion.translation.norm() + motion.rotation.norm() * arm;
  if (largest_speed_ == 0.0) return false;
  least_time_ = 4.0 * margin_ / largest_speed_;
  return true;
}

Outcome<Impact> CastSearch::find(const Motion& motion) { return begin(motion) ? search({0.0, 0, 0}) : Impact{}; }

Outcome<Impact> CastSearch::find_after(const Motion& motion, double apart, TrianglePair next) {
  if (!begin(motion)) return Impact{};
  // Nothing touches before, so where this pair touches soon after there is no need to look at others.
  const double soon = apart + std::max(k_resolution, 8.0 * least_time_);
  const Waiting first{apart, NodePair::k_triangle + next.a, NodePair::k_triangle + next.b};
  Impact impact;
  for (Waiting pair = first; pair.t <= soon;) {
    if (is_contact(Moment(*this, pair.t), pair.a, pair.b, impact)) {
      return impact.t <= soon ? impact_of(pair.a, pair.b, apart) : search({apart, 0, 0});
    }
    if (queue_.empty()) break;
    pair = pop();
  }
  queue_.clear();
  return search({apart, 0, 0});
}

/// @param first before its time nothing touches
Outcome<Impact> CastSearch::search(const Waiting& first) {
  push(first);
  for (std::uint64_t taken = 0; !queue_.empty(); ++taken) {
    if (taken == k_most_pairs) return Status::failed;
    const Waiting next = pop();
    const Moment moment(*this, next.t);
    if (is_triangle(next.a)) {
      Impact impact;
      if (is_contact(moment, next.a, next.b, impact)) return impact;
      continue;
    }
    if (!waits_again(moment, next)) split(moment, next.a, next.b);
  }
  return Impact{};
}

}  // namespace sixdof
