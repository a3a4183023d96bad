#include <sixdof/scene/bodies.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::scene::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Relative rounding of a transformed point, of a box and of a motion: some 20 roundings of 1.1e-16, with a wide
/// margin.
constexpr double k_rounding = 1e-13;

}  // namespace

Bodies::Bodies(const Scene& scene) : filter_(scene) {
  const std::size_t n = scene.bodies.size();
  index_.resize(n);
  std::iota(index_.begin(), index_.end(), 0u);
  std::ranges::sort(index_, {}, [&](std::uint32_t i) { return scene.bodies[i].id; });
  rank_.resize(n);
  meshes_.resize(scene.meshes.size());
  parallel::for_each(scene.meshes.size(),
                     [&](std::size_t i) { meshes_[i] = std::make_unique<const PreparedMesh>(*scene.meshes[i]); });
  for (const auto& mesh : meshes_) radii_.push_back(mesh->tree().radius());
  poses_.resize(n);
  centers_.resize(n);
  boxes_.resize(n);
  for (std::uint32_t r = 0; r < n; ++r) {
    const Body& body = scene.bodies[index_[r]];
    rank_[index_[r]] = r;
    ids_.push_back(body.id);
    mesh_.push_back(body.mesh);
    fixed_.push_back(body.fixed);
    place(r, body.pose.pose());
  }
}

void Bodies::place(std::uint32_t rank, const Pose& X_WB) {
  const Eigen::AlignedBox3d& box = mesh(rank).box();
  const Vector3d center = X_WB * box.center();
  const Vector3d half = X_WB.R.cwiseAbs() * (0.5 * box.sizes());
  const double slack = k_rounding * (radius(rank) + X_WB.t.cwiseAbs().sum() + box.center().cwiseAbs().sum());
  // No point is further from the centre than the sphere reaches.
  const Eigen::Array3d reach = half.array().min(radius(rank)) + slack;
  poses_[rank] = X_WB;
  centers_[rank] = center;
  boxes_[rank] = {center.array() - reach, center.array() + reach};
}

std::uint32_t Bodies::rank_of_id(std::uint32_t id) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(ids_, id) - ids_.begin());
}

double Bodies::move(std::uint32_t rank, const Pose& X_WB) {
  const Matrix3d turn = X_WB.R - poses_[rank].R;
  const Vector3d before = centers_[rank];
  place(rank, X_WB);
  // The difference of two rotation matrices stretches no vector by more than 2 sin(angle / 2), which is its Frobenius
  // norm over sqrt(2).
  const double turned = turn.norm() * (1.0 / std::sqrt(2.0)) * radius(rank);
  const double shift = (centers_[rank] - before).norm();
  return (1.0 + k_rounding) * (shift + turned) + k_rounding * (radius(rank) + before.cwiseAbs().sum());
}

double Bodies::rounding(std::uint32_t a, std::uint32_t b) const {
  return k_rounding * (radius(a) + radius(b) + poses_[a].t.cwiseAbs().sum() + poses_[b].t.cwiseAbs().sum() +
                       mesh(a).box().center().cwiseAbs().sum() + mesh(b).box().center().cwiseAbs().sum());
}

double Bodies::lower_bound(std::uint32_t a, std::uint32_t b) const {
  const double spheres = (centers_[a] - centers_[b]).norm() - radius(a) - radius(b);
  return std::max(spheres, boxes_[a].gap(boxes_[b])) - rounding(a, b);
}

std::size_t Bodies::bytes() const {
  std::size_t sum = size() * (sizeof(Pose) + sizeof(Box) + sizeof(Vector3d) + 4 * sizeof(std::uint32_t));
  for (const auto& mesh : meshes_) sum += mesh->bytes();
  return sum;
}

Wrenches::Wrenches(const Scene& scene, const Bodies& bodies) {
  solids_.resize(scene.meshes.size());
  for (std::uint32_t r = 0; r < bodies.size(); ++r) {
    auto& solid = solids_[bodies.mesh_index(r)];
    if (!solid) solid = std::make_unique<const Solid>(*scene.meshes[bodies.mesh_index(r)], bodies.mesh(r).tree());
  }
}

std::vector<BodyWrench> Wrenches::sum(const Bodies& bodies, std::span<const BodyPair> pairs) const {
  struct Term {
    Vector3d force, torque_a, torque_b;  // on B; about the centres of A's and of B's box
  };
  std::vector<Term> terms(pairs.size());
  parallel::for_each(pairs.size(), [&](std::size_t k) {
    const auto [a, b] = pairs[k];
    OverlapQuery query(*solids_[bodies.mesh_index(a)], *solids_[bodies.mesh_index(b)]);
    const Overlap overlap = query.evaluate(bodies.relative(a, b));
    const Matrix3d& R = bodies.pose(a).R;
    Term& term = terms[k];
    term.force = R * -overlap.area;
    term.torque_b = R * -overlap.moment;
    const Vector3d arm = bodies.pose(a) * overlap.reference - bodies.center(a);
    term.torque_a = -(term.torque_b + arm.cross(term.force));
  });
  std::map<std::uint32_t, BodyWrench> sums;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b] = pairs[k];
    BodyWrench& on_a = sums[a];
    on_a.force -= terms[k].force;
    on_a.torque += terms[k].torque_a;
    BodyWrench& on_b = sums[b];
    on_b.force += terms[k].force;
    on_b.torque += terms[k].torque_b;
  }
  std::vector<BodyWrench> wrenches;
  for (auto& [rank, wrench] : sums) {
    wrench.body = bodies.id(rank);
    wrenches.push_back(wrench);
  }
  return wrenches;
}

std::size_t Wrenches::bytes() const {
  std::size_t sum = 0;
  for (const auto& solid : solids_) sum += solid ? solid->bytes() : 0;
  return sum;
}

}  // namespace sixdof::scene::detail
