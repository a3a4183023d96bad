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
  prepare(scene);
  poses_.resize(n);
  centers_.resize(n);
  boxes_.resize(n);
  for (std::uint32_t r = 0; r < n; ++r) {
    const Body& body = scene.bodies[index_[r]];
    rank_[index_[r]] = r;
    ids_.push_back(body.id);
    mesh_.push_back(body.mesh);
    ranks_of_mesh_[body.mesh].push_back(r);
    fixed_.push_back(body.fixed);
    place(r, body.pose.pose());
  }
}

void Bodies::prepare(const Scene& scene) {
  const std::size_t n = scene.meshes.size();
  rigid_.resize(n);
  deforming_.resize(n);
  ranks_of_mesh_.resize(n);
  std::vector<bool> deforms(n, false);
  for (const std::vector<Deformation>& frame : scene.deformations) {
    for (const Deformation& deformation : frame) deforms[deformation.mesh] = true;
  }
  parallel::for_each(n, [&](std::size_t i) {
    if (deforms[i]) {
      deforming_[i] = std::make_unique<DeformingMesh>(*scene.meshes[i]);
    } else {
      rigid_[i] = std::make_unique<const PreparedMesh>(*scene.meshes[i]);
    }
  });
  for (std::uint32_t i = 0; i < n; ++i) {
    prepared_.push_back(deforms[i] ? &deforming_[i]->prepared() : rigid_[i].get());
    radii_.push_back(prepared_.back()->tree().radius());
    if (deforms[i]) deforming_meshes_.push_back(i);
  }
}

Bodies::Change Bodies::deform(const Deformed& deformed, MeshUpdate how) {
  DeformingMesh& mesh = *deforming_[deformed.mesh];
  const bool was_solid = mesh.solid();
  const double motion = how == MeshUpdate::rule    ? mesh.update(deformed.vertices)
                        : how == MeshUpdate::refit ? mesh.refit(deformed.vertices)
                                                   : mesh.rebuild(deformed.vertices);
  radii_[deformed.mesh] = mesh.prepared().tree().radius();
  for (const std::uint32_t rank : ranks_of_mesh_[deformed.mesh]) {
    const Pose X_WB = poses_[rank];
    place(rank, X_WB);
  }
  return {motion * (1.0 + k_rounding), mesh.solid() != was_solid};
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
  for (const auto& mesh : rigid_) sum += mesh ? mesh->bytes() : 0;
  for (const auto& mesh : deforming_) sum += mesh ? mesh->bytes() : 0;
  return sum;
}

Wrenches::Wrenches(const Scene& scene, const Bodies& bodies) {
  solids_.resize(scene.meshes.size());
  shapes_.resize(scene.meshes.size());
  for (std::uint32_t r = 0; r < bodies.size(); ++r) {
    auto& solid = solids_[bodies.mesh_index(r)];
    if (!solid) solid = std::make_unique<const Solid>(*scene.meshes[bodies.mesh_index(r)], bodies.mesh(r).tree());
  }
}

void Wrenches::deform(const Scene& scene, const Bodies& bodies, const Deformed& deformed) {
  if (!solids_[deformed.mesh]) return;  // of no body
  std::vector<Vector3d> vertices(deformed.vertices.begin(), deformed.vertices.end());
  solids_[deformed.mesh].reset();
  shapes_[deformed.mesh] =
      std::make_unique<const Mesh>(scene.meshes[deformed.mesh]->with_vertices(std::move(vertices)));
  const Tree& tree = bodies.mesh(bodies.ranks_of(deformed.mesh).front()).tree();
  solids_[deformed.mesh] = std::make_unique<const Solid>(*shapes_[deformed.mesh], tree);
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
