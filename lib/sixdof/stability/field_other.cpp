#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <sixdof/stability/field_case.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability::field {
namespace {

MeshPointer inverted(const Mesh& mesh) {
  std::vector<Triangle> triangles = mesh.triangles();
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return std::make_shared<const Mesh>(Mesh::build(mesh.vertices(), std::move(triangles), mesh.name()));
}

/// Every triangle twice, the second time turned over.
MeshPointer doubled(const Mesh& mesh) {
  std::vector<Triangle> triangles = mesh.triangles();
  for (const Triangle& t : mesh.triangles()) triangles.push_back({t[0], t[2], t[1]});
  return std::make_shared<const Mesh>(Mesh::build(mesh.vertices(), std::move(triangles), mesh.name()));
}

/// A body above a plate.
Shot standing(double gap) {
  return above_face(box({2.0, 1.6, 1.2}), 0.6, box({0.5, 0.4, 0.3}),
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.6, 0.48, 0.64))), 0.1, 0.05, gap);
}

Case moving(std::string name, std::string thread, double parameter, const Shot& shot, const Eigen::Vector3d& motion,
            double contact_time) {
  return {.name = std::move(name),
          .thread = std::move(thread),
          .parameter = parameter,
          .relation = Relation::sweep,
          .shots = {shot},
          .convex = true,
          .motion = motion,
          .contact_time = contact_time};
}

}  // namespace

std::vector<Case> retriangulations() {
  std::vector<Case> cases;
  for (const std::size_t sides : {8, 16, 32}) {
    cases.push_back(member(fmt::format("unit spheres of {} segments", sides), "gkjohnson/three-mesh-bvh#386",
                           static_cast<double>(sides), apart(sphere(1.0, sides), sphere(1.0, sides), at(3.0, 0.0, 0.0)),
                           true));
  }
  return cases;
}

std::vector<Case> damaged() {
  Shot mirrored = standing(0.05);
  mirrored.a = inverted(*mirrored.a);
  Shot twice = standing(0.05);
  twice.a = doubled(*twice.a);
  Shot inside_out = standing(-0.05);
  inside_out.b = inverted(*inside_out.b);
  inside_out.truth.push.reset();
  return {member("mirrored mesh, normals inwards", "google-deepmind/mujoco#3604", 1.0, mirrored),
          member("mirrored moving mesh in contact", "google-deepmind/mujoco#3604, moving", 1.0, inside_out),
          member("every face twice", "libigl/libigl#644", 1.0, twice)};
}

std::vector<Case> fast() {
  // Open pyramids, tips towards each other.
  const MeshPointer pyramid = triangles({{0.0, 0.0, 0.0},
                                         {-1.0, -1.0, 1.0},
                                         {1.0, -1.0, 1.0},
                                         {0.0, 0.0, 0.0},
                                         {1.0, -1.0, 1.0},
                                         {0.0, 1.0, 1.0},
                                         {0.0, 0.0, 0.0},
                                         {0.0, 1.0, 1.0},
                                         {-1.0, -1.0, 1.0}});
  const Placement opposite{{0.0, 0.0, -1000.0}, Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0)};
  const Shot pyramids = apart(pyramid, pyramid, opposite);
  // A box that falls on a plate in steps of more than half its height.
  const Shot box_falls = aligned_boxes({40.0, 40.0, 0.05}, {0.9, 1.42552, 1.0}, {0.0, 0.0, 0.025 + 0.5 + 0.2});
  const Shot crossing = aligned_boxes({0.02, 2.0, 2.0}, {0.1, 0.1, 0.1}, {-3.0, 0.1, 0.2});
  const Shot big = apart(transformed(*capsule(7.19732189, 2.03114343, 24), z_to(Eigen::Vector3d::UnitY())),
                         transformed(*cylinder(0.4975, 0.3, 24), z_to(Eigen::Vector3d::UnitY())),
                         at(-0.951660156, -2.09155273, -7.73));
  return {
      moving("pyramids 1000 apart at speed 1e5", "dimforge/parry#194", 1e5, pyramids, {0.0, 0.0, 1e5}, 0.01),
      moving("box at 20.4 m/s, steps of 0.02 s", "NVIDIA-Omniverse/PhysX#509", 20.427 * 0.02, box_falls,
             {0.0, 0.0, -20.427}, 0.2 / 20.427),
      moving("small box across a wall", "flexible-collision-library/fcl#555", 100.0, crossing, {100.0, 0.0, 0.0},
             (3.0 - 0.06) / 100.0),
      moving("separating capsule and cylinder", "jrouwe/JoltPhysics#2103", 1.0, big, {0.0, 0.0, -0.0029296875},
             std::numeric_limits<double>::infinity()),
  };
}

std::vector<Case> inputs() {
  Shot half = standing(-0.05);
  half.truth = {};
  // The matrix of the quaternion (0.707107, 0, 0, 0), taken as if it had norm 1: half a unit matrix.
  half.raw = half.X_AB.pose();
  half.raw->R = 0.5 * Eigen::Matrix3d::Identity();
  Shot nan = half;
  nan.raw->R.setConstant(std::numeric_limits<double>::quiet_NaN());
  return {{.name = "quaternion of norm 0.707107",
           .thread = "flexible-collision-library/fcl#567",
           .parameter = 0.707107,
           .relation = Relation::bad,
           .shots = {half}},
          {.name = "box of NaN",
           .thread = "flexible-collision-library/fcl#567, NaN",
           .parameter = 0.0,
           .relation = Relation::bad,
           .shots = {nan}}};
}

std::vector<Case> repeats() {
  Case order{.name = "contacts in the same order",
             .thread = "sofa-framework/sofa#6231",
             .parameter = 8,
             .relation = Relation::repeat,
             .shots = {}};
  Case endless{.name = "turned by small angles",
               .thread = "flexible-collision-library/fcl#578",
               .parameter = 8,
               .relation = Relation::repeat,
               .shots = {}};
  Case apart_hulls{.name = "separated bodies",
                   .thread = "google-deepmind/mujoco#3383",
                   .parameter = 8,
                   .relation = Relation::repeat,
                   .shots = {}};
  Case touching{.name = "bodies in contact",
                .thread = "danfis/libccd#7",
                .parameter = 8,
                .relation = Relation::repeat,
                .shots = {}};
  for (int i = 0; i < 8; ++i) {
    const double step = 0.01 * (i + 1);
    order.shots.push_back(standing(-step));
    apart_hulls.shots.push_back(standing(step));
    touching.shots.push_back(standing(0.0));
    const Eigen::Quaterniond q(Eigen::AngleAxisd(1e-9 * (i + 1), Eigen::Vector3d(0.6, 0.48, 0.64)));
    endless.shots.push_back(above_face(box({2.0, 1.6, 1.2}), 0.6, box({0.5, 0.4, 0.3}), q, 0.1, 0.05, 1e-9));
  }
  return {order, endless, apart_hulls, touching};
}

std::vector<Case> motions() {
  // Distances of a pair of hulls that depended on which one came first.
  const MeshPointer a = tetrahedron({Eigen::Vector3d{0.1, 0.2, 0.3}, Eigen::Vector3d{2.2, 0.1, 0.4},
                                     Eigen::Vector3d{0.3, 1.7, 0.2}, Eigen::Vector3d{0.5, 0.4, 1.9}});
  const MeshPointer b = tetrahedron({Eigen::Vector3d{-0.9, 0.1, 0.2}, Eigen::Vector3d{1.1, -0.2, 0.1},
                                     Eigen::Vector3d{0.1, 1.2, -0.3}, Eigen::Vector3d{0.2, 0.3, 1.4}});
  const Eigen::Quaterniond q(Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.6, 0.48, 0.64)));
  return {member("exchange of the bodies", "dimforge/parry#431", 3.7, apart(a, b, {{3.1, 2.2, 2.7}, q}), true)};
}

}  // namespace sixdof::stability::field
