#include <sixdof/oracle/overlap.h>

#include <limits>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/oracle/winding.h>

namespace sixdof {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Fluxes about the origin through the region within a path, in the mesh's frame.
/// @param origin of the path's integrals, in the solid's mesh frame
Solid::Moments within(const detail::BorderPath& path, const Solid& solid, const Vector3d& origin) {
  const Solid::Moments about_center = solid.to_moments(path.potential);
  const Vector3d shift = origin - solid.tree().center();
  Solid::Moments m;
  // From the centre c to the origin o, by (p - c) = (p - o) + (o - c). The terms that appear are the region's area
  // vector and the integral of p n^T, which follow from the path but for the latter's trace, three times the volume.
  m.volume = about_center.volume - shift.dot(path.area) / 3.0;
  const Matrix3d first_order = m.volume * Matrix3d::Identity() + path.first_order;
  m.first = about_center.first - first_order.transpose() * shift - 0.5 * shift.squaredNorm() * path.area;
  return m;
}

/// Intersection of A's box, and that around B enlarged by `slack`, in A's frame.
Eigen::AlignedBox3d common_box(const Solid& a, const Solid& b, const Pose& X_AB, double slack) {
  const Vector3d center = X_AB * b.mesh().center();
  const Vector3d half = X_AB.R.cwiseAbs() * (0.5 * b.mesh().box().sizes()) + Vector3d::Constant(slack);
  return a.mesh().box().intersection(Eigen::AlignedBox3d(center - half, center + half));
}

/// Whether the bodies' boxes are certainly apart.
bool apart(const Solid& a, const Solid& b, const Pose& X_AB) {
  constexpr double k_relative_slack = 1e-12;  // far above the rounding of transformed vertices
  const double slack = k_relative_slack * (b.mesh().diagonal() + b.mesh().center().lpNorm<1>()) +
                       (k_relative_slack * X_AB.t).lpNorm<1>();  // the sum itself may overflow
  return common_box(a, b, X_AB, slack).isEmpty();
}

}  // namespace

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference, bool warm_start) {
  if (!X_AB.R.allFinite() || !X_AB.t.allFinite() || apart(*a_, *b_, X_AB))
    return evaluate(X_AB, reference, std::span<const TrianglePair>{});
  if (!warm_start) {
    if (threads_ > 1) return evaluate_by_threads(X_AB, reference);
    find_candidates(a_->tree(), b_->tree(), X_AB, scratch_, pairs_);
    return evaluate(X_AB, reference, pairs_);
  }
  const Overlap overlap = evaluate(X_AB, reference, kept_.at(a_->tree(), b_->tree(), X_AB));
  kept_.count_crossings(overlap.crossings);
  return overlap;
}

/// One thread sums up the crossings of the parts that are searched, and searches itself while there is none; the others
/// search. Isolated: no other query of this object may begin on a thread that waits.
Overlap OverlapQuery::evaluate_by_threads(const Pose& X_AB, const Vector3d& reference) {
  parts_.start(*a_, *b_, X_AB);
  Overlap overlap;
  const auto work = [&](std::size_t i) {
    if (i != 0) return parts_.help();
    overlap = sum_up(
        X_AB, reference, [this] { return parts_.next(); }, Vector3d::Zero());
  };
  parallel::isolated([&] { parallel::for_each(threads_, work); });
  return overlap;
}

Overlap OverlapQuery::evaluate(const Pose& X_AB, const Vector3d& reference, std::span<const TrianglePair> pairs,
                               const Vector3d& along) {
  return sum_up(
      X_AB, reference, [&] { return detail::PairPiece{std::exchange(pairs, {})}; }, along);
}

Overlap OverlapQuery::sum_up(const Pose& X_AB, const Vector3d& reference, const detail::PairSource& next,
                             const Vector3d& along) {
  if (!X_AB.R.allFinite() || !X_AB.t.allFinite() || !reference.allFinite()) {
    throw BadArgument("overlap: pose and reference point must be finite");
  }
  Overlap result;
  result.reference = reference;
  result.centroid.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (apart(*a_, *b_, X_AB)) return result;

  const Vector3d origin = common_box(*a_, *b_, X_AB, 0.0).center();  // near all crossings
  const Vector3d origin_B = X_AB.inverse() * origin;
  detail::CrossingSums sums = detail::sum_crossings(*a_, *b_, X_AB, origin, next, along);
  for (const Solid::Piece& piece : a_->pieces()) {
    sums.path_a.potential.add(piece.total,
                              detail::winding_of_b(b_->tree(), X_AB, transform_point, piece.pole, triangles_));
  }
  for (const Solid::Piece& piece : b_->pieces()) {
    const Vector3d pole = transform_point(X_AB, piece.pole);
    sums.path_b.potential.add(piece.total, detail::winding_of_a(a_->tree(), pole, triangles_));
  }
  const Solid::Moments within_a = within(sums.path_a, *a_, origin);    // in A's frame
  const Solid::Moments within_b = within(sums.path_b, *b_, origin_B);  // in B's frame
  result.crossings = sums.crossings;
  result.volume = within_a.volume + within_b.volume + sums.beside_paths.volume;
  result.area = -0.5 * sums.area;
  result.curvature = -sums.curvature;
  result.moment = sums.moment / 6.0 + (sums.anchor - reference).cross(result.area);
  if (result.volume > 0.0) {
    result.centroid = origin + (within_a.first + X_AB.R * within_b.first + sums.beside_paths.first) / result.volume;
  }
  return result;
}

std::size_t OverlapQuery::bytes() const {
  return scratch_.bytes() + pairs_.capacity() * sizeof(TrianglePair) + parts_.bytes() + kept_.bytes() +
         triangles_.capacity() * sizeof(std::uint32_t);
}

}  // namespace sixdof
