#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <sixdof/stability/field_case.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability::field {
namespace {

/// Every triangle turned over or, if `twice`, once as it is and once turned over.
MeshPointer turned_over(const Mesh& mesh, bool twice) {
  std::vector<Triangle> triangles;
  if (twice) triangles = mesh.triangles();
  for (const Triangle& t : mesh.triangles()) triangles.push_back({t[0], t[2], t[1]});
  return built(mesh.vertices(), std::move(triangles));
}

/// A body above a plate.
Shot standing(double gap) {
  return above_face(box({2.0, 1.6, 1.2}), 0.6, box({0.5, 0.4, 0.3}), about(0.7, {0.6, 0.48, 0.64}), 0.1, 0.05, gap);
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
  mirrored.a = turned_over(*mirrored.a, false);
  Shot twice = standing(0.05);
  twice.a = turned_over(*twice.a, true);
  Shot inside_out = standing(-0.05);
  inside_out.b = turned_over(*inside_out.b, false);
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
  const auto bad = [](const char* name, const char* thread, double parameter, const Shot& shot) {
    return Case{.name = name, .thread = thread, .parameter = parameter, .relation = Relation::bad, .shots = {shot}};
  };
  return {bad("quaternion of norm 0.707107", "flexible-collision-library/fcl#567", 0.707107, half),
          bad("box of NaN", "flexible-collision-library/fcl#567, NaN", 0.0, nan)};
}

std::vector<Case> repeats() {
  const auto repeated = [](const char* name, const char* thread, const auto& shot) {
    Case result{.name = name, .thread = thread, .parameter = 8, .relation = Relation::repeat};
    for (int i = 1; i <= 8; ++i) result.shots.push_back(shot(i));
    return result;
  };
  const auto turned = [](int i) {
    return above_face(box({2.0, 1.6, 1.2}), 0.6, box({0.5, 0.4, 0.3}), about(1e-9 * i, {0.6, 0.48, 0.64}), 0.1, 0.05,
                      1e-9);
  };
  return {repeated("contacts in the same order", "sofa-framework/sofa#6231", [](int i) { return standing(-0.01 * i); }),
          repeated("turned by small angles", "flexible-collision-library/fcl#578", turned),
          repeated("separated bodies", "google-deepmind/mujoco#3383", [](int i) { return standing(0.01 * i); }),
          repeated("bodies in contact", "danfis/libccd#7", [](int) { return standing(0.0); })};
}

std::vector<Case> motions() {
  // Distances of a pair of hulls that depended on which one came first.
  const MeshPointer a = tetrahedron({Eigen::Vector3d{0.1, 0.2, 0.3}, Eigen::Vector3d{2.2, 0.1, 0.4},
                                     Eigen::Vector3d{0.3, 1.7, 0.2}, Eigen::Vector3d{0.5, 0.4, 1.9}});
  const MeshPointer b = tetrahedron({Eigen::Vector3d{-0.9, 0.1, 0.2}, Eigen::Vector3d{1.1, -0.2, 0.1},
                                     Eigen::Vector3d{0.1, 1.2, -0.3}, Eigen::Vector3d{0.2, 0.3, 1.4}});
  const Placement X_AB{{3.1, 2.2, 2.7}, about(1.1, {0.6, 0.48, 0.64})};
  return {member("exchange of the bodies", "dimforge/parry#431", 3.7, apart(a, b, X_AB), true)};
}

}  // namespace sixdof::stability::field
