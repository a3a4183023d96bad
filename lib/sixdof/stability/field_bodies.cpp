#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <sixdof/stability/field_case.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability::field {
namespace {

Eigen::Vector3d cube(double edge) { return Eigen::Vector3d::Constant(edge); }

/// Centre of the first body to the second's, as boxes along the axes.
Case boxes(std::string name, std::string thread, double parameter, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
           const Eigen::Vector3d& offset) {
  return member(std::move(name), std::move(thread), parameter, aligned_boxes(a, b, offset), true);
}

/// Along z; a repeated corner makes it that of a triangle.
MeshPointer prism(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r,
                  const Eigen::Vector2d& s, double half_height) {
  std::array<Eigen::Vector3d, 8> corners;
  const std::array around{p, q, s, r};
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector2d& c = around[i % 4];
    corners[i] = {c.x(), c.y(), i < 4 ? -half_height : half_height};
  }
  return hexahedron(corners);
}

/// A sphere whose pole touches what lies in a direction.
MeshPointer ball(double radius, const Eigen::Vector3d& towards) {
  return transformed(*sphere(radius, 24), z_to(towards));
}

}  // namespace

std::vector<Case> body_scales() {
  std::vector<Case> cases;
  for (const double edge : {1000.0, 100.0, 50.0, 10.0}) {  // in millimetres; 1e5 from the origin
    const Placement far = at(1e5, 1e5, 1e5);
    const Shot near = aligned_boxes(cube(edge), cube(edge), {1.5 * edge, 0.3 * edge, 0.2 * edge});
    cases.push_back(member(fmt::format("cubes of {} far away", edge), "jsk-ros-pkg/jsk_roseus#616", edge,
                           moved(near, far, far), true));
  }
  const Shot whole = aligned_boxes({2.0, 1.0, 1.0}, cube(1.0), {0.2, 0.1, 0.95});
  cases.push_back(same_answers("mesh at 5 %", 0.05, {whole, scaled(whole, 0.05)}, true, "jrouwe/JoltPhysics#2048"));
  for (const double factor : {1e-3, 1e-5}) {
    const Shot pair = aligned_boxes(cube(1.0), cube(0.5), {0.1, 0.2, 0.7});
    cases.push_back(same_answers(fmt::format("absolute tolerance at scale {}", factor), factor,
                                 {pair, scaled(pair, factor)}, true, "Genesis-Embodied-AI/genesis-world#3007"));
  }
  return cases;
}

std::vector<Case> body_sizes() {
  std::vector<Case> cases;
  for (const double size : {1.0, 10.0, 100.0}) {
    cases.push_back(boxes(fmt::format("body of {} on a plate of 0.1", size), "google-deepmind/mujoco_warp#1430", size,
                          {2.0 * size, 2.0 * size, 0.1}, cube(size), {0.1 * size, 0.0, 0.5 * size + 0.05 - 0.01}));
  }
  cases.push_back(boxes("small cube in a face", "google-deepmind/mujoco_warp gjk test", 1.577288e-5, {1.0, 1.0, 0.2},
                        cube(0.05), {0.135535001754761, -0.195535004138947, 0.124984227120876}));
  return cases;
}

std::vector<Case> body_offsets() {
  std::vector<Case> cases;
  for (const double y : {0.0, 1.0}) {
    const Shot near = aligned_boxes(cube(1.0), {0.4, 0.4, 0.4}, {0.2, 0.1, 0.7 - 0.08165});
    cases.push_back(member(fmt::format("contact at y = {}", y), "google-deepmind/mujoco_warp#1546", y,
                           moved(near, at(0.0, y, 0.0), at(0.0, y, 0.0)), true));
  }
  return cases;
}

std::vector<Case> body_kissing() {
  const Placement first{
      {1.503354966, -0.8531707835, 0.7700092418},
      rotation({0.9999195703, 0.01021849413, 0.007512347878}, {-0.01021878248, 0.9999477869, -3.33e-17},
               {-0.007511955635, -7.676704888e-5, 0.9999717819})};
  const Placement second{
      {1.48838308, -1.102020834, 0.4497073799},
      rotation({0.9998670967, -0.01297708324, 0.009868343982}, {0.01297771517, 0.9999157859, 5.26e-17},
               {-0.009867512928, 0.0001280685574, 0.9999513067})};
  // In the first body's frame.
  const Pose X = first.pose().inverse() * second.pose();
  const Placement between{X.t, (first.q.conjugate() * second.q).normalized()};
  const Eigen::Vector2d beside(0.5419794018 - 0.6, -0.0621175025);
  const double angle = std::atan2(beside.y(), beside.x());
  const MeshPointer post =
      transformed(*cylinder(0.03, 0.325), {Eigen::Vector3d::Zero(), about(angle, Eigen::Vector3d::UnitZ())});
  Shot touching{.a = post,
                .b = ball(0.055, Eigen::Vector3d(-beside.x(), -beside.y(), 0.0)),
                .X_AB = at(beside.x(), beside.y(), 0.6016236576 - 0.325)};
  touching.truth.gap = beside.norm() - 0.085;  // -1.5334e-7
  touching.truth.distance = 0.0;
  Shot on_edge{.a = box(cube(0.1)),
               .b = ball(0.06, Eigen::Vector3d::UnitY()),
               .X_AB = at(1.7855e-10 - 0.05, 0.04 - 0.15, 0.33 - 0.35)};
  on_edge.truth.gap = on_edge.truth.distance = 0.0;
  return {
      member("boxes 3.6e-6 apart", "coal-library/coal#604", 3.57545e-6,
             apart(box({0.363, 0.277, 0.363}), box({0.363, 0.363, 0.277}), between), true),
      member("sphere in a cylinder by 1.5e-7", "flexible-collision-library/fcl#391", -1.5334e-7, touching),
      member("sphere that touches a cube", "flexible-collision-library/fcl#408", 0.0, on_edge),
      boxes("boxes that touch", "flexible-collision-library/fcl#493", 0.0, cube(0.3), {0.1, 0.2, 0.3},
            {0.2, 0.05, 0.1}),
      boxes("boxes a rounding apart", "flexible-collision-library/fcl#495", 3e-17, {0.3, 0.1, 0.7}, {0.1, 0.7, 0.3},
            {0.1, 0.4, 0.2}),
      boxes("overlap of 0.056 mm", "google-deepmind/mujoco#3476", -5.6e-5, cube(0.2), cube(0.1),
            {0.02, 0.01, 0.15 - 5.6e-5}),
      boxes("cubes that touch at x = 1", "dimforge/parry#315", 0.0, cube(1.0), cube(1.0), {1.0, 0.0, 0.0}),
      boxes("overlap of 2.5e-4", "google-deepmind/mujoco_warp#1526", -2.5e-4, cube(0.2), cube(0.2),
            {0.03, 0.02, 0.2 - 2.5e-4}),
  };
}

std::vector<Case> body_aligned() {
  const Placement yaw{{0.75, 0.0, 0.15}, about(std::acos(7.96326710733264e-4), Eigen::Vector3d::UnitZ())};
  const Placement turned{{0.75, 0.0, 0.15}, rotation({0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0})};
  const Pose X = yaw.pose().inverse() * turned.pose();
  const Shot bars = overlapping(box({0.05, 0.55, 0.3}), box({0.25, 0.2, 0.15}),
                                {X.t, (yaw.q.conjugate() * turned.q).normalized()}, 0.15005968, 2e-8);
  const Eigen::Quaterniond almost = about(4.6e-11, {0.6, 0.48, 0.64});
  return {
      member("bars at an angle of 8e-4", "RobotLocomotion/drake#21673", 7.96e-4, bars, true),
      member("nearly equal frames", "flexible-collision-library/fcl#445", 4.6e-11,
             above_face(box({0.3165, 0.2276, 0.1768}), 0.0884, box({0.4943, 0.3546, 0.0752}), almost, 0.05, 0.02, 1e-9),
             true),
      // Rotation and translation of a disc and a box, as printed by the reporter.
      member("cylinder tilted by 1e-3 on a box", "google-deepmind/mujoco_warp#657", -0.00166258,
             above_face(
                 box({2.0, 2.0, 0.2}), 0.1, cylinder(0.1, 0.2),
                 rotation({0.99996972, 0.00776371127, -0.000434333051}, {-0.00776385562, 0.99996984, -0.000330951589},
                          {0.000431750523, 0.000334313663, 0.99999988}),
                 0.1, 0.02, -0.00166258),
             true),
  };
}

std::vector<Case> body_parallel() {
  return {
      member("edges 1.7e-8 apart", "flexible-collision-library/fcl#390", 1.70822e-8,
             above_face(box({1.0, 1.0, 0.1}), 0.05, box({0.4, 0.3, 0.2}), about(1e-8, Eigen::Vector3d::UnitX()), 0.1,
                        0.1, 1.70822e-8),
             true),
  };
}

std::vector<Case> body_grazing() {
  const MeshPointer hull = tetrahedron({Eigen::Vector3d{1.0, 1.0, 1.0}, Eigen::Vector3d{2.0, 1.0, 1.0},
                                        Eigen::Vector3d{1.0, 2.0, 1.0}, Eigen::Vector3d{1.0, 1.0, 2.0}});
  Shot on_face = overlapping(hull, ball(1e-4, Eigen::Vector3d::UnitZ()), at(1.5, 1.25, 1.0), 1e-4, 1e-12);
  on_face.truth.push = -Eigen::Vector3d::UnitZ();
  return {
      member("tiny sphere on a face", "BerkeleyAutomation/python-fcl#54", 1e-4, on_face, true),
      boxes("box over a box", "flexible-collision-library/fcl#628", 0.0, cube(1.0), {1.0, 0.2, 1.0}, {0.0, 0.4, 0.0}),
  };
}

std::vector<Case> body_deep() {
  std::vector<Case> cases{
      boxes("cubes overlapping by 0.1", "danfis/libccd#25", 0.1, cube(2.0), cube(2.0), {0.0, 0.0, 1.9}),
      boxes("box in a box by z doubled", "flexible-collision-library/fcl#628, doubled", 0.2, {1.0, 1.0, 2.0},
            {1.0, 0.2, 2.0}, {0.0, 0.4, 0.0}),
      member("spheres 10 apart", "flexible-collision-library/fcl#275", 10.0,
             apart(ball(20.0, Eigen::Vector3d::UnitX()), ball(10.0, -Eigen::Vector3d::UnitX()), at(40.0, 0.0, 0.0)),
             true),
      member("sphere under a box", "flexible-collision-library/fcl#127", 3.0,
             apart(ball(1.0, Eigen::Vector3d::UnitY()), box({10.0, 2.0, 10.0}), at(0.0, 5.0, 3.0)), true),
      member("cylinder and cuboid", "dimforge/parry#157", 0.0195835,
             overlapping(transformed(*cylinder(0.5, 0.925, 96), z_to(Eigen::Vector3d::UnitY())), box({0.1, 1.5, 1.0}),
                         at(11.5 - 10.97, 0.75 - 0.925, 60.5 - 61.02), 0.0195835, 1e-3),
             true),
      boxes("depth of 0.607", "google-deepmind/mujoco#1800", 0.607368, {2.0, 2.0, 1.4}, {1.6, 1.8, 1.2},
            {0.1, 0.05, 1.3 - 0.607368}),
      boxes("small cube in a corner", "flexible-collision-library/fcl#545", 0.2, cube(1.0), cube(0.2), cube(0.4)),
      member("spheres 0.9 apart", "coal-library/coal#344", 0.1,
             overlapping(ball(0.5, Eigen::Vector3d::UnitX()), ball(0.5, -Eigen::Vector3d::UnitX()), at(0.9, 0.0, 0.0),
                         0.1, 1e-12),
             true),
      member("box under a capsule", "google-deepmind/mujoco#1473", 0.6,
             apart(box(cube(0.2)), capsule(0.15, 0.15), at(0.0, 0.0, 1.0)), true),
      member("disc over a capsule", "google-deepmind/mujoco#1857", 0.035,
             apart(transformed(*capsule(0.01, 0.05), z_to(Eigen::Vector3d::UnitX())), cylinder(0.2, 0.005),
                   at(0.1, 0.0, 0.05)),
             true),
  };
  cases.push_back(member(
      "prisms of a quadrilateral and a triangle", "MattiaMontanari/openGJK#3", 0.00720339,
      overlapping(
          prism({0.795121, -0.727851}, {-0.178424, -0.989183}, {-0.412644, -0.770664}, {0.566564, 0.548772}, 1.0),
          prism({-0.211223, -0.511346}, {-0.347973, 0.45872}, {0.277308, 0.969689}, {0.277308, 0.969689}, 0.9), {},
          0.00720339, 1e-8),
      true));
  for (const double margin : {0.0, 1.0, 5.0}) {
    // A sphere in a large box, its depth independent of any margin.
    Shot shot =
        overlapping(box(cube(20.0)), ball(1.0, -Eigen::Vector3d::UnitX()), at(10.5, 0.3 * margin, 0.2), 0.5, 1e-12);
    shot.truth.push = Eigen::Vector3d::UnitX();
    cases.push_back(member(fmt::format("sphere in a face, {} off the centre", 0.3 * margin),
                           "jrouwe/JoltPhysics discussion 1379", margin, shot, true));
  }
  return cases;
}

std::vector<Case> body_thin() {
  std::vector<Case> cases;
  for (const double part : {0.5, 0.9}) {
    cases.push_back(boxes(fmt::format("indentation of {} of a plate", part), "RobotLocomotion/drake#12441", part,
                          {1.0, 1.0, 0.01}, cube(0.2), {0.1, 0.0, 0.105 - 0.01 * part}));
  }
  cases.push_back(boxes("through the plate", "RobotLocomotion/drake#12441, deeper", 2.0, {1.0, 1.0, 0.01}, cube(0.2),
                        {0.1, 0.0, 0.0}));
  return cases;
}

}  // namespace sixdof::stability::field
