#include <sixdof/oracle/penetration.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

#include <sixdof/base/error.h>
#include <sixdof/oracle/penetration_cover.h>

namespace sixdof {
namespace {

using detail::FreeTranslations;
using Eigen::Vector3d;

/// Of the free translations that are found, those from which shorter ones are searched, and those along whose contacts'
/// normals B approaches once more.
constexpr std::size_t k_descents = 6, k_normals = 8;
/// Of R^T R: what a matrix of numbers with seven digits may have. Intervals get wider by it.
constexpr double k_rotation_error = 1e-5;
/// Bodies that are free after a translation shorter than this, over the clearance of hulls, only touch.
constexpr double k_touch = 1e5;

/// A short free translation: from many directions, then along the normals of the contacts found.
Vector3d search_free(FreeTranslations& translations, const Pose& X_AB) {
  std::vector<FreeTranslations::Stop> stops;
  const auto sort = [&] {
    std::ranges::stable_sort(stops, [](const auto& x, const auto& y) { return x.d.norm() < y.d.norm(); });
  };
  for (const Vector3d& u : detail::sphere_directions()) stops.push_back(translations.approach(X_AB, u));
  sort();
  const std::size_t count = std::min(k_normals, stops.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d normal = stops[i].normal;
    if (!normal.isZero(0.0)) stops.push_back(translations.approach(X_AB, normal));
  }
  sort();
  Vector3d best = stops.front().d;
  for (std::size_t i = 0; i < std::min(k_descents, stops.size()); ++i) {
    const Vector3d d = translations.descend(X_AB, stops[i].d);
    if (d.norm() < best.norm()) best = d;
  }
  return best;
}

void check(const Pose& X_AB) {
  if (!X_AB.R.allFinite() || !X_AB.t.allFinite()) throw BadArgument("the pose is not finite");
  if (!X_AB.R.isUnitary(k_rotation_error) || X_AB.R.determinant() < 0.0) {
    throw BadArgument("the pose's matrix is not a rotation");
  }
}

}  // namespace

PenetrationOracle::PenetrationOracle(const Mesh& a, const Mesh& b) : a_(&a), b_(&b), distance_(a, b) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) throw BadMesh(mesh->name() + ": " + mesh->why_not_solid());
  }
  balls_a_ = detail::find_inner_balls(a, distance_.tree_a());
  balls_b_ = &a == &b ? balls_a_ : detail::find_inner_balls(b, distance_.tree_b());
}

PenetrationDepth PenetrationOracle::evaluate(const Pose& X_AB, const PenetrationOptions& options) const {
  check(X_AB);
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0)) throw BadArgument("the tolerance is not between 0 and 1");
  if (options.budget == 0) throw BadArgument("the budget is 0");
  FreeTranslations translations(distance_);
  if (translations.is_free(X_AB, Vector3d::Zero())) return {.closed = true};
  const Vector3d first = search_free(translations, X_AB);
  const double clearance = detail::CellProver(*this, X_AB).clearance();
  PenetrationDepth found;
  if (first.norm() <= k_touch * clearance) {
    found = {.translation = first, .closed = true};
  } else {
    found = detail::PenetrationCover(*this, X_AB, first, options).run();
  }
  // The pose that was tested is a rounded sum.
  found.hi = ((X_AB.t + found.translation) - X_AB.t).norm() + clearance;
  found.lo = std::max(0.0, found.lo - clearance);
  found.casts += translations.casts();
  return found;
}

std::optional<double> PenetrationOracle::directional_depth(const Pose& X_AB, const Vector3d& direction) const {
  check(X_AB);
  FreeTranslations translations(distance_);
  const FreeTranslations::Stop stop = translations.approach(X_AB, direction);
  if (!stop.blocked) return 0.0;
  if (stop.normal.isZero(0.0)) return std::nullopt;
  return stop.d.dot(direction);
}

}  // namespace sixdof
