#include <sixdof/oracle/overlap.h>

#include <cmath>
#include <limits>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

OrderedTriangle ordered(const Tree::Corners& corners, Solid::Order order) {
  const std::size_t l = order.lowest;
  return {{corners[l], corners[(l + 1) % 3], corners[(l + 2) % 3]}, order.rises};
}

/// Fluxes through the part of one surface inside the other body.
class SurfacePart {
 public:
  /// @param origin of the moments: in the solid's own mesh frame.
  SurfacePart(const Solid& solid, const Vector3d& origin) : solid_(&solid), origin_(origin) {}

  /// A segment of the curve within `triangle` that keeps the part inside on its left; corners and ends relative to the
  /// origin, in A's frame. `from_side`, `to_side`: the triangle's side on which the end lies, -1 for its interior.
  void add_segment(std::uint32_t index, const OrderedTriangle& triangle, const Vector3d& from, int from_side,
                   const Vector3d& to, int to_side) {
    add(triangle_moments(triangle.corner[0], from, to), 1.0);
    if (to_side == 1) add_end(index, triangle, to, 1);
    if (from_side == 1) add_end(index, triangle, from, -1);
  }

  /// A whole piece, as often as the other body winds around its pole.
  void add_piece(const Solid::Piece& piece, int winding) { add(piece.total, winding); }

  /// All fluxes about the origin; first moments of `local` are in A's frame, those of `path` in the mesh's.
  Solid::Moments local() const { return local_; }
  Solid::Moments path() const {
    const Solid::Moments about_center = solid_->to_moments(potential_);
    const Vector3d shift = origin_ - solid_->tree().center();
    Solid::Moments m;
    // (p - c) = (p - o) + (o - c): area vector, first and second order terms of the region within the path follow from
    // its border, but for the volume itself.
    m.volume = about_center.volume - shift.dot(area_) / 3.0;
    const Matrix3d first_order = m.volume * Matrix3d::Identity() + first_order_;
    m.first = about_center.first - first_order.transpose() * shift - 0.5 * shift.squaredNorm() * area_;
    return m;
  }

 private:
  void add(const Solid::Moments& m, double sign) {
    local_.volume += sign * m.volume;
    local_.first += sign * m.first;
  }

  void add(const Solid::Potential& p, int sign) {
    potential_.volume += sign * p.volume;
    for (std::size_t k = 0; k < 3; ++k) potential_.first[k] += sign * p.first[k];
  }

  /// The end of a segment on the side opposite the lowest corner slides to the middle corner.
  void add_end(std::uint32_t index, const OrderedTriangle& triangle, const Vector3d& end, int sign) {
    add(triangle_moments(triangle.corner[0], triangle.corner[triangle.rises ? 1 : 2], end), -sign);
    add(solid_->potential(index), sign);
    const OrderedTriangle own = ordered(solid_->tree().corners()[index], solid_->order(index));
    const Vector3d low = own.corner[0] - origin_;
    const Vector3d middle = own.corner[own.rises ? 1 : 2] - origin_;
    const Vector3d cross = low.cross(middle);
    area_ += (0.5 * sign) * cross;
    first_order_ += (sign / 6.0) * (low + middle) * cross.transpose();
  }

  const Solid* solid_;
  Vector3d origin_;
  Solid::Moments local_;
  Solid::Potential potential_;
  Vector3d area_ = Vector3d::Zero();         // of the region within the path: integral of n
  Matrix3d first_order_ = Matrix3d::Zero();  // integral of p n^T, less its trace
};

/// Centre of the box that both bodies' boxes have in common, in A's frame: everything that happens is near it.
Vector3d common_center(const Solid& a, const Solid& b, const Pose& X_AB) {
  const Vector3d center = X_AB * b.mesh().center();
  const Vector3d half = X_AB.R.cwiseAbs() * (0.5 * b.mesh().box().sizes());
  return a.mesh().box().intersection(Eigen::AlignedBox3d(center - half, center + half)).center();
}

bool apart(const Solid& a, const Solid& b, const Pose& X_AB) {
  const Vector3d center = X_AB * b.mesh().center();
  // Twice over: the rounding of placed vertices is far below it.
  constexpr double k_relative_slack = 1e-12;
  const double slack = k_relative_slack * (b.mesh().diagonal() + X_AB.t.lpNorm<1>() + b.mesh().center().lpNorm<1>());
  const Vector3d half = X_AB.R.cwiseAbs() * (0.5 * b.mesh().box().sizes()) + Vector3d::Constant(slack);
  return a.mesh().box().intersection(Eigen::AlignedBox3d(center - half, center + half)).isEmpty();
}

/// The end of the shortest axis-parallel way from `p` out of `box`; empty box if `p` is outside already.
struct WayOut {
  bool outside = false;
  Vector3d end;
};

WayOut way_out(const Eigen::AlignedBox3d& box, const Vector3d& p) {
  if (!box.contains(p)) return {true, p};
  WayOut best{false, p};
  double shortest = std::numeric_limits<double>::infinity();
  const double margin = 0.01 * box.sizes().maxCoeff();  // well outside, whatever is rounded after
  for (int k = 0; k < 3; ++k) {
    for (const double face : {box.min()[k] - margin, box.max()[k] + margin}) {
      if (std::abs(face - p[k]) < shortest) {
        shortest = std::abs(face - p[k]);
        best.end = p;
        best.end[k] = face;
      }
    }
  }
  return best;
}

}  // namespace

int OverlapQuery::winding_of_b(const Pose& X_AB, const Vector3d& p_A) {
  const Vector3d p_B = X_AB.inverse() * p_A;
  Eigen::AlignedBox3d box = b_->mesh().box();
  const double slack = 1e-12 * (box.diagonal().norm() + p_A.lpNorm<1>() + X_AB.t.lpNorm<1>());
  box.extend(Vector3d(box.min() - Vector3d::Constant(slack)));
  box.extend(Vector3d(box.max() + Vector3d::Constant(slack)));
  const WayOut way = way_out(box, p_B);
  if (way.outside) return 0;
  const Vector3d q_A = X_AB * way.end;
  Eigen::AlignedBox3d around(p_B.cwiseMin(way.end) - Vector3d::Constant(slack),
                             p_B.cwiseMax(way.end) + Vector3d::Constant(slack));
  find_in_box(b_->tree(), around, triangles_);
  int entered = 0;
  for (const std::uint32_t t : triangles_) {
    const Tree::Corners& c = b_->tree().corners()[t];
    entered += pierce_moved_triangle(p_A, q_A, {place(X_AB, c[0]), place(X_AB, c[1]), place(X_AB, c[2])});
  }
  return -entered;
}

int OverlapQuery::winding_of_a(const Pose& X_AB, const Vector3d& p_B) {
  const Vector3d p_A = place(X_AB, p_B);
  const WayOut way = way_out(a_->mesh().box(), p_A);
  if (way.outside) return 0;
  Eigen::AlignedBox3d around(p_A);
  around.extend(way.end);
  find_in_box(a_->tree(), around, triangles_);
  int entered = 0;
  for (const std::uint32_t t : triangles_) entered += moved_edge_pierces(p_A, way.end, a_->tree().corners()[t]);
  return -entered;
}

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference) {
  pairs_.clear();
  if (X_AB.R.allFinite() && X_AB.t.allFinite() && !apart(*a_, *b_, X_AB)) {
    find_candidates(a_->tree(), b_->tree(), X_AB, pairs_);
  }
  return evaluate(X_AB, reference, pairs_);
}

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference, std::span<const CandidatePair> pairs) {
  if (!X_AB.R.allFinite() || !X_AB.t.allFinite() || !reference.allFinite()) {
    throw BadArgument("overlap: pose and reference point must be finite");
  }
  Overlap result;
  result.reference = reference;
  result.centroid.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (apart(*a_, *b_, X_AB)) return result;

  const Vector3d origin = common_center(*a_, *b_, X_AB);
  const Vector3d origin_B = X_AB.inverse() * origin;
  SurfacePart part_a(*a_, origin);
  SurfacePart part_b(*b_, origin_B);
  Vector3d area = Vector3d::Zero();    // twice
  Vector3d moment = Vector3d::Zero();  // minus six times, about the origin
  for (const CandidatePair& pair : pairs) {
    const OrderedTriangle a = ordered(a_->tree().corners()[pair.a], a_->order(pair.a));
    OrderedTriangle b = ordered(b_->tree().corners()[pair.b], b_->order(pair.b));
    for (Vector3d& c : b.corner) c = place(X_AB, c);
    const std::optional<Segment> segment = cross(a, b);
    if (!segment) continue;
    ++result.crossings;
    const Vector3d x = segment->start - origin;
    const Vector3d y = segment->end - origin;
    OrderedTriangle local_a = a, local_b = b;
    for (Vector3d& c : local_a.corner) c -= origin;
    for (Vector3d& c : local_b.corner) c -= origin;
    const auto side_of_b = [](int side) { return side < 3 ? -1 : side - 3; };
    part_a.add_segment(pair.a, local_a, x, segment->start_side, y, segment->end_side);
    // On B the part inside A lies to the right.
    part_b.add_segment(pair.b, local_b, y, side_of_b(segment->end_side), x, side_of_b(segment->start_side));
    area += y.cross(x);
    moment += (x.squaredNorm() + x.dot(y) + y.squaredNorm()) * (x - y);
  }

  for (const Solid::Piece& piece : a_->pieces()) part_a.add_piece(piece, winding_of_b(X_AB, piece.pole));
  for (const Solid::Piece& piece : b_->pieces()) part_b.add_piece(piece, winding_of_a(X_AB, piece.pole));
  const Solid::Moments sum_a = part_a.path();  // in A's frame
  const Solid::Moments sum_b = part_b.path();  // in B's frame
  result.volume = sum_a.volume + sum_b.volume + (part_a.local().volume + part_b.local().volume);
  result.area = 0.5 * area;
  result.moment = -moment / 6.0 + (origin - reference).cross(result.area);
  if (result.volume > 0.0) {
    result.centroid =
        origin + (sum_a.first + X_AB.R * sum_b.first + (part_a.local().first + part_b.local().first)) / result.volume;
  }
  return result;
}

std::size_t OverlapQuery::bytes() const {
  return pairs_.capacity() * sizeof(CandidatePair) + triangles_.capacity() * sizeof(std::uint32_t);
}

}  // namespace sixdof
