#include <sixdof/oracle/overlap.h>

#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/winding.h>

namespace sixdof {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

OrderedTriangle ordered(const Tree::Corners& corners, Solid::Order order) {
  const std::size_t l = order.lowest;
  return {{corners[l], corners[(l + 1) % 3], corners[(l + 2) % 3]}, order.rises};
}

/// Fluxes through the part of one surface inside the other body, summed over its border as described in solid.h. The
/// border is deformed to a path along edges of the mesh; the fluxes between the border and the path are summed apart.
class SurfacePart {
 public:
  /// @param origin of the moments, in the solid's mesh frame
  SurfacePart(const Solid& solid, const Vector3d& origin) : solid_(&solid), origin_(origin) {}

  /// Adds a segment of the border, which has the part on its left.
  /// @param index of the triangle in tree order
  /// @param triangle with the segment; corners and ends are relative to the origin, in A's frame
  /// @param from_side, to_side the triangle's side on which the end lies, -1 for its interior
  void add_segment(std::uint32_t index, const OrderedTriangle& triangle, const Vector3d& from, int from_side,
                   const Vector3d& to, int to_side) {
    add(triangle_moments(triangle.corner[0], from, to), 1.0);
    if (to_side == 1) add_end(index, triangle, to, 1);
    if (from_side == 1) add_end(index, triangle, from, -1);
  }

  /// Adds a whole piece, as often as the other body winds around its pole.
  void add_piece(const Solid::Piece& piece, int winding) { potential_.add(piece.total, winding); }

  /// Fluxes about the origin between the border and the path, in A's frame.
  Solid::Moments beside_path() const { return beside_path_; }

  /// Fluxes about the origin through the region within the path, in the mesh's frame.
  Solid::Moments within_path() const {
    const Solid::Moments about_center = solid_->to_moments(potential_);
    const Vector3d shift = origin_ - solid_->tree().center();
    Solid::Moments m;
    // From the centre c to the origin o, by (p - c) = (p - o) + (o - c). The terms that appear are the region's area
    // vector and the integral of p n^T, which follow from the path but for the latter's trace, three times the volume.
    m.volume = about_center.volume - shift.dot(area_) / 3.0;
    const Matrix3d first_order = m.volume * Matrix3d::Identity() + first_order_;
    m.first = about_center.first - first_order.transpose() * shift - 0.5 * shift.squaredNorm() * area_;
    return m;
  }

 private:
  void add(const Solid::Moments& m, double sign) {
    beside_path_.volume += sign * m.volume;
    beside_path_.first += sign * m.first;
  }

  /// Moves the end of a segment along the side opposite the lowest corner to the middle corner.
  void add_end(std::uint32_t index, const OrderedTriangle& triangle, const Vector3d& end, int sign) {
    add(triangle_moments(triangle.corner[0], triangle.corner[triangle.rises ? 1 : 2], end), -sign);
    potential_.add(solid_->potential(index), sign);
    const OrderedTriangle own = ordered(solid_->tree().corners()[index], solid_->order(index));
    const Vector3d low = own.corner[0] - origin_;
    const Vector3d middle = own.corner[own.rises ? 1 : 2] - origin_;
    const Vector3d cross = low.cross(middle);
    area_ += (0.5 * sign) * cross;
    first_order_ += (sign / 6.0) * (low + middle) * cross.transpose();
  }

  const Solid* solid_;
  Vector3d origin_;
  Solid::Moments beside_path_;
  Solid::Potential potential_;
  Vector3d area_ = Vector3d::Zero();         // within the path: integral of n
  Matrix3d first_order_ = Matrix3d::Zero();  // within the path: integral of p n^T, but for a multiple of the identity
};

/// Intersection of A's box, and that around B enlarged by `slack`, in A's frame.
Eigen::AlignedBox3d common_box(const Solid& a, const Solid& b, const Pose& X_AB, double slack) {
  const Vector3d center = X_AB * b.mesh().center();
  const Vector3d half = X_AB.R.cwiseAbs() * (0.5 * b.mesh().box().sizes()) + Vector3d::Constant(slack);
  return a.mesh().box().intersection(Eigen::AlignedBox3d(center - half, center + half));
}

/// Whether the bodies' boxes are certainly apart.
bool apart(const Solid& a, const Solid& b, const Pose& X_AB) {
  constexpr double k_relative_slack = 1e-12;  // far above the rounding of transformed vertices
  const double slack = k_relative_slack * (b.mesh().diagonal() + X_AB.t.lpNorm<1>() + b.mesh().center().lpNorm<1>());
  return common_box(a, b, X_AB, slack).isEmpty();
}

}  // namespace

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference) {
  pairs_.clear();
  if (X_AB.R.allFinite() && X_AB.t.allFinite() && !apart(*a_, *b_, X_AB)) {
    find_candidates(a_->tree(), b_->tree(), X_AB, pairs_);
  }
  return evaluate(X_AB, reference, pairs_);
}

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference, std::span<const TrianglePair> pairs) {
  if (!X_AB.R.allFinite() || !X_AB.t.allFinite() || !reference.allFinite()) {
    throw BadArgument("overlap: pose and reference point must be finite");
  }
  Overlap result;
  result.reference = reference;
  result.centroid.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (apart(*a_, *b_, X_AB)) return result;

  const Vector3d origin = common_box(*a_, *b_, X_AB, 0.0).center();  // near all crossings
  const Vector3d origin_B = X_AB.inverse() * origin;
  SurfacePart part_a(*a_, origin);
  SurfacePart part_b(*b_, origin_B);
  Vector3d anchor = Vector3d::Zero();  // on a curve: however small the curves are, nothing cancels in area and moment
  Vector3d area = Vector3d::Zero();    // twice
  Vector3d moment = Vector3d::Zero();  // minus six times, about the anchor
  for (const TrianglePair& pair : pairs) {
    const OrderedTriangle a = ordered(a_->tree().corners()[pair.a], a_->order(pair.a));
    OrderedTriangle b = ordered(b_->tree().corners()[pair.b], b_->order(pair.b));
    for (Vector3d& c : b.corner) c = transform_point(X_AB, c);
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
    if (result.crossings == 1) anchor = segment->start;
    const Vector3d u = segment->start - anchor;
    const Vector3d v = segment->end - anchor;
    area += v.cross(u);
    moment += (u.squaredNorm() + u.dot(v) + v.squaredNorm()) * (u - v);
  }

  for (const Solid::Piece& piece : a_->pieces()) {
    part_a.add_piece(piece, detail::winding_of_b(b_->tree(), X_AB, transform_point, piece.pole, triangles_));
  }
  for (const Solid::Piece& piece : b_->pieces()) {
    const Vector3d pole = transform_point(X_AB, piece.pole);
    part_b.add_piece(piece, detail::winding_of_a(a_->tree(), pole, triangles_));
  }
  const Solid::Moments sum_a = part_a.within_path();  // in A's frame
  const Solid::Moments sum_b = part_b.within_path();  // in B's frame
  result.volume = sum_a.volume + sum_b.volume + (part_a.beside_path().volume + part_b.beside_path().volume);
  result.area = 0.5 * area;
  result.moment = -moment / 6.0 + (anchor - reference).cross(result.area);
  if (result.volume > 0.0) {
    result.centroid =
        origin + (sum_a.first + X_AB.R * sum_b.first + (part_a.beside_path().first + part_b.beside_path().first)) /
                     result.volume;
  }
  return result;
}

std::size_t OverlapQuery::bytes() const {
  return pairs_.capacity() * sizeof(TrianglePair) + triangles_.capacity() * sizeof(std::uint32_t);
}

}  // namespace sixdof
