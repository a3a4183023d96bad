#include <sixdof/algorithm/vps/vps.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/base/error.h>

#include "../closed_loop.h"
#include "bodies.h"

namespace sixdof {
namespace {

constexpr double k_layer_rounding = 1e-9;  // of a depth in voxels, which is a whole number

namespace fs = std::filesystem;
using vps_test::ball;
using vps_test::box;
using vps_test::generic_pose;
using vps_test::inside_out;
using vps_test::moved;

std::unique_ptr<Algorithm> make(const std::string& name) {
  return name == "vps" ? make_vps_algorithm() : make_vps_field_algorithm();
}

std::unique_ptr<Query> prepare(const std::string& name, const Mesh& a, const Mesh& b,
                               const std::vector<std::string>& assignments) {
  const auto algorithm = make(name);
  Settings settings = algorithm->settings();
  settings.set_all(assignments);
  return algorithm->prepare(a, b, settings);
}

double angle(const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

/// Without the cache on disk, unless a test sets it.
class Vps : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ::setenv("SIXDOF_CACHE", "off", 1); }
  void TearDown() override { ::unsetenv("SIXDOF_CACHE"); }
};

/// B pressed by `depth` into the middle of A's top face (+z), each body in a mesh frame of its own.
struct Pressed {
  Pressed(const Mesh& a_plain, const Mesh& b_plain, double b_bottom, double a_top, double depth) {
    const Pose to_a = generic_pose(51, 0.8), to_b = generic_pose(52, 0.6);
    a = std::make_unique<Mesh>(moved(a_plain, to_a));
    b = std::make_unique<Mesh>(moved(b_plain, to_b));
    const Pose plain{Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                     {0.05, -0.03, a_top - b_bottom - depth}};
    X = to_a * plain * to_b.inverse();
    up = to_a.R.col(2);
  }
  std::unique_ptr<Mesh> a, b;
  Pose X;
  Eigen::Vector3d up;  ///< A's outward normal there, in A's frame.
};

std::vector<std::string> resolution(double a, double b) {
  return {"voxel_size=" + std::to_string(a), "point_spacing=" + std::to_string(b)};
}

/// Largest error of a point's depth, in voxels: of its layer (vps), or of the rounded edges of the field.
double depth_error(const std::string& algorithm) { return algorithm == "vps" ? vps::VoxelMap::k_layer_error : 0.25; }

TEST_P(Vps, ABoxPressedIntoAFaceFeelsAreaTimesDepth) {
  const double depth = 0.12, area = 0.8 * 0.6, perimeter = 2.8;
  const Pressed scene(box({2.0, 1.6, 1.2}), box({0.8, 0.6, 0.7}), -0.35, 0.6, depth);
  // With layers the walls' forces are horizontal and cancel; with the field they are vertical, along its gradient.
  const double force = area * depth + (GetParam() == "vps" ? 0.0 : 0.5 * perimeter * depth * depth);
  std::vector<double> errors;
  for (const double voxel : {0.02, 0.01, 0.005}) {
    const double s = voxel * scene.a->diagonal(), error = depth_error(GetParam()) * s * area;
    const auto query = prepare(GetParam(), *scene.a, *scene.b, resolution(voxel, 0.02));
    const Response response = query->respond(scene.X).value;
    EXPECT_NEAR(response.force.norm(), force, error) << voxel;
    EXPECT_LT(angle(response.force, scene.up), error / force) << voxel;
    EXPECT_NEAR(response.penalty, depth, depth_error(GetParam()) * s) << voxel;
    EXPECT_LT(response.torque.norm(), error * scene.b->diagonal()) << voxel;
    EXPECT_TRUE(response.reference.isApprox(scene.X * scene.b->center(), 1e-12));
    EXPECT_TRUE(query->collide(scene.X).value);
    errors.push_back((response.force - force * scene.up).norm());
  }
  constexpr double k_quadrature = 1e-3;  // the cells of points at the borders of faces are cut off
  EXPECT_LT(errors.back(), std::max(0.5 * errors.front(), k_quadrature * force));
}

TEST_P(Vps, ABallAndAFaceFollowTheirClosedFormsInBothRoles) {
  const double R = 0.7, h = 0.25, c = R - h, pi = std::numbers::pi;
  const Pressed scene(box({2.4, 2.0, 1.4}), ball(R, 3000), -R, 0.7, h);
  // Points on the ball: depth below the face. Layers act along the ball's normals: the volume of the cap; the field
  // acts along the face's: the integral of depth over the cap's surface. Points on the face: depth R - r below the
  // ball's surface. Layers act along the face's normal, the field radially.
  const double cap = pi * h * h * (3.0 * R - h) / 3.0,
               disc = pi * (R * (R * R - c * c) - 2.0 / 3.0 * (R * R * R - c * c * c));
  const bool layers = GetParam() == "vps";
  const double on_ball = layers ? cap : pi * R * h * h, on_face = layers ? disc : pi * c * h * h;
  const double contact_area = 2.0 * pi * R * h;
  constexpr double k_mesh = 0.01;  // the mesh of 3000 triangles lies below the ball by 2 thousandths of R, of h / 2
  for (const double voxel : {0.01, 0.005}) {
    for (const bool swapped : {false, true}) {
      auto parameters = resolution(voxel, 0.01);
      if (swapped) parameters.push_back("pointshell=a");
      const double s = voxel * (swapped ? scene.b->diagonal() : scene.a->diagonal());
      const double force = swapped ? on_face : on_ball,
                   error = depth_error(GetParam()) * s * contact_area + k_mesh * force;
      const Response response = prepare(GetParam(), *scene.a, *scene.b, parameters)->respond(scene.X).value;
      EXPECT_NEAR(response.force.norm(), force, error) << voxel << swapped;
      EXPECT_LT(angle(response.force, scene.up), 0.5 * error / force) << voxel << swapped;
      EXPECT_LT(response.torque.norm(), 0.5 * error * R) << voxel << swapped;
      EXPECT_TRUE(response.reference.isApprox(scene.X * scene.b->center(), 1e-12));
    }
  }
}

TEST_P(Vps, SwappedBodiesWithTheSamePointsGiveTheReaction) {
  const Pressed scene(box({2.0, 1.6, 1.2}), make_bumpy_sphere({.radius = 0.5}, 300), -0.4, 0.6, 0.1);
  auto parameters = resolution(0.02, 0.02);
  const Response on_a = prepare(GetParam(), *scene.b, *scene.a, parameters)->respond(scene.X.inverse()).value;
  parameters.push_back("pointshell=a");
  const Response on_b = prepare(GetParam(), *scene.a, *scene.b, parameters)->respond(scene.X).value;
  const Response about_same = on_a.about(scene.b->center());
  ASSERT_GT(on_b.force.norm(), 1e-3);
  constexpr double k_rounding = 1e-12;  // of a few products in double precision
  EXPECT_LT((on_b.force + scene.X.R * about_same.force).norm(), k_rounding);
  EXPECT_LT((on_b.torque + scene.X.R * about_same.torque).norm(), k_rounding);
}

/// With the points on the other body the law is different, but for a face pressed slightly into a face both give area
/// times depth.
TEST_P(Vps, SwappedBodiesGiveTheReactionWithinTheResolution) {
  const double depth = 0.05, area = 0.8 * 0.6, perimeter = 2.8;
  const Pressed scene(box({2.0, 1.6, 1.2}), box({0.8, 0.6, 0.7}), -0.35, 0.6, depth);
  for (const double voxel : {0.01, 0.005}) {
    const auto parameters = resolution(voxel, 0.01);
    const Response on_b = prepare(GetParam(), *scene.a, *scene.b, parameters)->respond(scene.X).value;
    const Response on_a = prepare(GetParam(), *scene.b, *scene.a, parameters)->respond(scene.X.inverse()).value;
    const double size = voxel * (scene.a->diagonal() + scene.b->diagonal());
    // Points near B's walls are closest to the walls, with horizontal or smaller forces: a rim as wide as the depth.
    const double declared = depth_error(GetParam()) * size * area + perimeter * depth * depth;
    EXPECT_LT((on_b.force + scene.X.R * on_a.force).norm(), declared) << voxel;
    EXPECT_GT(on_b.force.norm(), 0.5 * area * depth) << voxel;
    const Response about_b = on_a.about(scene.b->center());
    EXPECT_LT((on_b.torque + scene.X.R * about_b.torque).norm(), declared * scene.b->diagonal()) << voxel;
  }
}

TEST_P(Vps, DoesNotDependOnTheUnitOfLength) {
  const double factor = 1e-6;
  const auto scaled = [&](const Mesh& mesh) {
    std::vector<Eigen::Vector3d> vertices = mesh.vertices();
    for (Eigen::Vector3d& v : vertices) v *= factor;
    return Mesh::build(vertices, mesh.triangles(), mesh.name());
  };
  const Mesh a = make_bumpy_sphere({}, 300), b = make_bumpy_sphere({.radius = 0.7}, 200);
  const Pose X = generic_pose(75, 1.2), small{X.R, factor * X.t};
  const auto parameters = resolution(0.02, 0.02);
  const Response large = prepare(GetParam(), a, b, parameters)->respond(X).value;
  const Response tiny = prepare(GetParam(), scaled(a), scaled(b), parameters)->respond(small).value;
  ASSERT_GT(large.force.norm(), 0.0);
  constexpr double k_single = 5e-3;  // rounding may move single points across a voxel's face
  // Area times depth, and once more a length for the torque.
  EXPECT_TRUE((tiny.force / std::pow(factor, 3)).isApprox(large.force, k_single));
  EXPECT_TRUE((tiny.torque / std::pow(factor, 4)).isApprox(large.torque, 10 * k_single));
  EXPECT_NEAR(tiny.penalty / factor, large.penalty, k_single * large.penalty);
}

TEST_P(Vps, DoesNotDependOnTheFrames) {
  const Mesh a = moved(make_bumpy_sphere({}, 500), generic_pose(61, 0.3));
  const Mesh b = moved(make_bumpy_sphere({.radius = 0.8}, 400), generic_pose(62, 0.2));
  const Pose X = generic_pose(63, 1.3);
  const auto parameters = resolution(0.02, 0.02);
  const Response plain = prepare(GetParam(), a, b, parameters)->respond(X).value;
  ASSERT_GT(plain.force.norm(), 0.01);
  // Coordinates in single precision: a relative error of 2^-24 of some hundred voxels. With `vps` rounding may move
  // single points of some hundred contacts across a voxel's face.
  const double tolerance = GetParam() == "vps" ? 5e-3 : 1e-4;

  const Pose shift_a{Eigen::Matrix3d::Identity(), {17.3, -5.1, 0.77}},
      shift_b{Eigen::Matrix3d::Identity(), {-3.9, 8.2, 2.6}};
  const Mesh a_shifted = moved(a, shift_a), b_shifted = moved(b, shift_b);
  const Response shifted =
      prepare(GetParam(), a_shifted, b_shifted, parameters)->respond(shift_a * X * shift_b.inverse()).value;
  const double force = tolerance * plain.force.norm(), torque = force * b.diagonal();
  EXPECT_LT((shifted.force - plain.force).norm(), force);
  EXPECT_LT((shifted.torque - plain.torque).norm(), torque);

  // A rotation by 90 degrees maps A's voxels to voxels.
  Pose quarter;
  quarter.R << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Mesh a_rotated = moved(a, quarter);
  const Response rotated = prepare(GetParam(), a_rotated, b, parameters)->respond(quarter * X).value;
  EXPECT_LT((rotated.force - quarter.R * plain.force).norm(), force);
  EXPECT_LT((rotated.torque - quarter.R * plain.torque).norm(), torque);

  // After a general rotation the voxels differ: the same within the resolution, here a voxel over the depth.
  const Pose any = generic_pose(64, 0.5);
  const Mesh a_any = moved(a, any);
  const Response other = prepare(GetParam(), a_any, b, parameters)->respond(any * X).value;
  EXPECT_TRUE(other.force.isApprox(any.R * plain.force, 0.02 * a.diagonal() / plain.penalty));
}

TEST_P(Vps, GivesNoForceApart) {
  const Mesh a = make_bumpy_sphere({}, 300), b = make_bumpy_sphere({.radius = 0.7}, 200);
  const auto query = prepare(GetParam(), a, b, resolution(0.02, 0.02));
  for (const double reach : {2.3, 10.0, 1e9, 1e300}) {
    const Pose X = generic_pose(71, reach);
    EXPECT_FALSE(query->collide(X).value);
    const Outcome<Response> outcome = query->respond(X);
    ASSERT_TRUE(outcome.ok());
    EXPECT_EQ(outcome.value.force, Eigen::Vector3d::Zero());
    EXPECT_EQ(outcome.value.torque, Eigen::Vector3d::Zero());
    EXPECT_EQ(outcome.value.penalty, 0.0);
  }
  Pose nowhere = generic_pose(72, 1.0);
  nowhere.t.y() = std::nan("");
  EXPECT_EQ(query->respond(nowhere).status, Status::non_finite);
  EXPECT_EQ(query->collide(nowhere).status, Status::non_finite);
  EXPECT_FALSE(query->diagnosis().empty());
  EXPECT_EQ(query->distance(generic_pose(73, 1.0)).status, Status::unsupported);
}

TEST_P(Vps, CullingChangesNoBitAndStiffnessIsAFactor) {
  const Mesh a = make_bumpy_sphere({}, 300), b = make_bumpy_sphere({.radius = 0.7}, 200);
  auto parameters = resolution(0.02, 0.02);
  const auto culled = prepare(GetParam(), a, b, parameters);
  parameters.push_back("culling=off");
  const auto whole = prepare(GetParam(), a, b, parameters);
  parameters.push_back("stiffness=2.5");
  const auto stiff = prepare(GetParam(), a, b, parameters);
  for (std::uint64_t seed = 80; seed < 100; ++seed) {
    const Pose X = generic_pose(seed, 1.2 + 0.04 * static_cast<double>(seed - 80));
    const Response x = culled->respond(X).value, y = whole->respond(X).value, z = stiff->respond(X).value;
    EXPECT_EQ(x.force, y.force);
    EXPECT_EQ(x.torque, y.torque);
    EXPECT_EQ(x.penalty, y.penalty);
    EXPECT_EQ(culled->collide(X).value, whole->collide(X).value);
    EXPECT_TRUE(z.force.isApprox(2.5 * x.force, 1e-14));
  }
}

TEST_P(Vps, WeightByContactsBoundsTheForceByTenPoints) {
  const Mesh a = make_bumpy_sphere({}, 300), b = make_bumpy_sphere({.radius = 0.7}, 200);
  auto parameters = resolution(0.02, 0.02);
  parameters.push_back("weight=contacts");
  const Response response = prepare(GetParam(), a, b, parameters)->respond(generic_pose(91, 1.2)).value;
  EXPECT_GT(response.penalty, 0.1);
  EXPECT_LT(response.force.norm(), 10.0 * response.penalty * 1.1);  // gradients may pass 1 by rounding of edges
  EXPECT_GT(response.force.norm(), response.penalty);               // more than one point
}

TEST_P(Vps, RefusesMeshesThatAreNotSolidWithTheReason) {
  const Mesh good = box({1.0, 0.8, 0.6}), bad = inside_out(good);
  const auto words = [&](const Mesh& a, const Mesh& b) -> std::string {
    try {
      prepare(GetParam(), a, b, {});
    } catch (const BadMesh& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(words(good, bad), ::testing::HasSubstr("inside-out box"));
  EXPECT_THAT(words(bad, good), ::testing::HasSubstr("inside out"));
}

TEST_P(Vps, CachedStructuresGiveTheSameBits) {
  std::string directory = (fs::temp_directory_path() / "sixdof-vps-XXXXXX").string();
  ASSERT_NE(::mkdtemp(directory.data()), nullptr);
  ::setenv("SIXDOF_CACHE", directory.c_str(), 1);
  const Mesh a = make_bumpy_sphere({}, 300), b = make_bumpy_sphere({.radius = 0.7}, 200);
  const Pose X = generic_pose(95, 1.3);
  const auto respond = [&] { return prepare(GetParam(), a, b, resolution(0.02, 0.02))->respond(X).value; };
  const auto expect_same = [](const Response& x, const Response& y) {
    EXPECT_EQ(x.force, y.force);
    EXPECT_EQ(x.torque, y.torque);
    EXPECT_EQ(x.penalty, y.penalty);
  };
  const auto write_times = [&] {
    std::map<std::string, fs::file_time_type> times;
    for (const auto& file : fs::directory_iterator(directory)) times[file.path()] = file.last_write_time();
    return times;
  };
  const Response built = respond();
  ASSERT_GT(built.force.norm(), 0.0);
  const auto first = write_times();
  EXPECT_EQ(first.size(), GetParam() == "vps" ? 2u : 3u);
  expect_same(respond(), built);
  EXPECT_EQ(write_times(), first);  // nothing was built

  for (const auto& [path, time] : first) {
    fs::resize_file(path, fs::file_size(path) - 1000);
  }
  const auto damaged = write_times();
  expect_same(respond(), built);
  for (const auto& [path, time] : write_times()) EXPECT_NE(time, damaged.at(path)) << path;
  fs::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, Vps, ::testing::Values("vps", "vps-field"), [](const auto& each) {
  return each.param == "vps" ? std::string("Layers") : std::string("Field");
});

TEST(VpsDepth, LayersAreWholeVoxelsAndGiveNoForceOnThinPlates) {
  ::setenv("SIXDOF_CACHE", "off", 1);
  const Mesh plate = moved(box({2.0, 1.6, 0.004}), generic_pose(96, 0.2)), b = box({0.8, 0.6, 0.7});
  const Pose X = generic_pose(96, 0.2) *
                 Pose{Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {0.0, 0.0, 0.348}};
  auto parameters = resolution(0.01, 0.01);
  const Response with_local = prepare("vps", plate, b, parameters)->respond(X).value;
  parameters.push_back("depth=layers");
  const auto by_layers = prepare("vps", plate, b, parameters);
  // A plate of a sixth of a voxel is layer 0: only the position in the voxel gives a penetration.
  EXPECT_GT(with_local.force.dot(generic_pose(96, 0.2).R.col(2)), 0.0);
  EXPECT_EQ(by_layers->respond(X).value.force, Eigen::Vector3d::Zero());
  EXPECT_TRUE(by_layers->collide(X).value);

  const Mesh a = box({2.0, 1.6, 1.2});
  const double s = 0.01 * a.diagonal();
  const double penalty = prepare("vps", a, b, parameters)->respond(generic_pose(97, 0.7)).value.penalty;
  EXPECT_GT(penalty, 0.0);
  EXPECT_NEAR(penalty / s, std::round(penalty / s), k_layer_rounding);
  ::unsetenv("SIXDOF_CACHE");
}

TEST(VpsField, DoesNoWorkOnAClosedLoop) {
  ::setenv("SIXDOF_CACHE", "off", 1);
  const Mesh a = make_bumpy_sphere({}, 500), b = make_bumpy_sphere({.radius = 0.7, .waves = 1.2}, 400);
  const auto query = prepare("vps-field", a, b, resolution(0.03, 0.03));
  const auto work = [&](int steps) { return test::loop_work(*query, b, {1.25, 0.0, 0.1}, 0.2, steps); };
  const double coarse = work(16), fine = work(256);
  EXPECT_LT(fine, 1e-5);  // relative rounding of sums in single precision: 10^-6
  EXPECT_LT(fine, 0.1 * coarse);
  ::unsetenv("SIXDOF_CACHE");
}

}  // namespace
}  // namespace sixdof
