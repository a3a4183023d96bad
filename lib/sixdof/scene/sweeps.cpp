#include <sixdof/scene/sweeps.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof::scene::detail {
namespace {

/// Roundings of poses, in units of the scene's size.
constexpr double k_rounding = 1e-12;

/// Axis times angle of a rotation, the shorter way.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (!(sine > 0.0)) return Eigen::Vector3d::Zero();
  return (2.0 * std::atan2(sine, q.w()) / sine) * q.vec();
}

}  // namespace

Sweeps::Sweeps(const Scene& scene, const Bodies& bodies) : motions_(bodies.size()), paths_(bodies.size(), 0.0) {
  double size = 0.0;
  for (std::uint32_t rank = 0; rank < bodies.size(); ++rank) {
    centers_.push_back(scene.meshes[bodies.mesh_index(rank)]->center());
    radii_.push_back(bodies.radius(rank));
    size = std::max(size, bodies.radius(rank) + bodies.center(rank).norm());
  }
  rounding_ = k_rounding * size;
}

void Sweeps::clear() {
  for (const std::uint32_t rank : moving_) paths_[rank] = 0.0;
  moving_.clear();
}

void Sweeps::add(const Bodies& bodies, std::uint32_t rank, const Pose& to) {
  const Pose& from = bodies.pose(rank);
  const Eigen::Vector3d& center = centers_[rank];
  const Eigen::Vector3d travel = to * center - from * center;
  const Eigen::Vector3d turn = rotation_vector(to.R * from.R.transpose());
  motions_[rank] = {from, travel, turn, center};
  paths_[rank] = travel.norm() + turn.norm() * bodies.radius(rank);
  rounding_ = std::max(rounding_, k_rounding * (bodies.radius(rank) + (to * center).norm()));
  if (paths_[rank] > 0.0) moving_.push_back(rank);
}

double Sweeps::largest_reach() const {
  double longest = 0.0, second = 0.0;
  for (const std::uint32_t rank : moving_) {
    second = std::max(second, std::min(paths_[rank], longest));
    longest = std::max(longest, paths_[rank]);
  }
  if (longest == 0.0) return 0.0;
  return (longest + second) * (1.0 + 1e-9) + 4.0 * k_touching * *std::ranges::max_element(radii_) + rounding_;
}

Pose Sweeps::pose_at(const Bodies& bodies, std::uint32_t rank, double t) const {
  return moves(rank) ? motions_[rank].pose_at(t) : bodies.pose(rank);
}

Sweeps::Contact Sweeps::first_contact(const Bodies& bodies, NearQuery& query, std::uint32_t a, std::uint32_t b) const {
  const double speed = paths_[a] + paths_[b];
  if (!(speed > 0.0)) return {};
  const PreparedMesh &mesh_a = bodies.mesh(a), &mesh_b = bodies.mesh(b);
  const double touch = touching(a, b);
  const auto relative = [&](double t) { return pose_at(bodies, a, t).inverse() * pose_at(bodies, b, t); };
  double t = 0.0;
  NearHint none;
  for (std::uint32_t step = 0; step < k_most_steps; ++step) {
    const Pose X_AB = relative(t);
    const double left = (1.0 - t) * speed + touch;
    NearHint hint = none;  // the same triangles whatever was asked before
    const auto distance = query.distance(mesh_a, mesh_b, X_AB, left, hint);
    if (!distance) return {};
    if (*distance <= touch) return {.t = step == 0 ? std::nullopt : std::optional(t)};
    if (step == 0 && query.is_nested(mesh_a, mesh_b, X_AB)) return {};
    t += *distance / speed;
    if (t > 1.0) return {};
  }
  return {.undecided = true};
}

}  // namespace sixdof::scene::detail
