#include <sixdof/algorithm/ist/ist.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

#include "../closed_loop.h"
#include "random_spheres.h"

namespace sixdof {
namespace {

constexpr double k_gaps = 0.1;             // part of a volume that the spheres do not fill
constexpr double k_near_rounding = 1e-12;  // of a sum over some hundred pairs of spheres
constexpr double k_slope_error = 1e-3;     // relative: of a slope from a finite step

constexpr double k_rounding = 1e-12;  // relative, of some hundred terms

class IstTest : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("SIXDOF_CACHE", "off", 1); }

  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const std::vector<std::string>& parameters) const {
    Settings settings = algorithm_->settings();
    settings.set_all(parameters);
    return algorithm_->prepare(a, b, settings);
  }

  std::unique_ptr<Query> prepare_descent(const Mesh& a, const Mesh& b,
                                         const std::vector<std::string>& parameters) const {
    Settings settings = descent_->settings();
    settings.set_all(parameters);
    return descent_->prepare(a, b, settings);
  }

  std::unique_ptr<Algorithm> algorithm_ = make_ist_algorithm(), descent_ = make_ist_descent_algorithm();
};

/// Two blocks without rotation: the overlap is a box, and the gradient of its volume has the areas of its faces.
TEST_F(IstTest, VolumeAndForceConvergeForTwoBlocks) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const Eigen::Vector3d shift(0.4, 0.15, 1.0);  // overlap 1.6 x 1.45 x 0.2
  const Pose X{Eigen::Matrix3d::Identity(), shift};
  const double volume = (2.0 - 0.4) * (1.6 - 0.15) * (1.2 - 1.0);
  const Eigen::Vector3d direction =
      Eigen::Vector3d(1.45 * 0.2, 1.6 * 0.2, 1.6 * 1.45).normalized();  // -grad V: areas of the faces
  double last_volume_error = 1.0, last_angle = 180.0;
  for (const char* spheres : {"spheres=100", "spheres=500", "spheres=2500"}) {
    const auto response = prepare(block, block, {spheres, "force=gradient", "correct_fill=on"})->respond(X);
    ASSERT_TRUE(response.ok());
    const double volume_error = std::abs(response.value.volume / volume - 1.0);
    const double angle = std::acos(response.value.force.normalized().dot(direction)) * 180.0 / std::numbers::pi;
    EXPECT_LT(volume_error, last_volume_error) << spheres;
    EXPECT_LT(angle, last_angle) << spheres;
    last_volume_error = volume_error;
    last_angle = angle;
    // Without the correction the volume is biased low.
    EXPECT_LT(prepare(block, block, {spheres})->respond(X).value.volume, volume);
  }
  EXPECT_LT(last_volume_error, 0.3);
  EXPECT_LT(last_angle, 10.0);
}

TEST_F(IstTest, ReactionIsOppositeToAction) {
  const Mesh a = load_model("torus-knot-1k"), b = load_model("bumpy-sphere-1k");
  const std::vector<std::string> spheres{"spheres=300"}, by_volume{"spheres=300", "force=volume"};
  const std::vector<std::string> more_in_b{"spheres=200", "spheres_b=300"}, more_in_a{"spheres=300", "spheres_b=200"};
  using Queries = std::pair<std::unique_ptr<Query>, std::unique_ptr<Query>>;
  for (const auto& [forward, backward] : {Queries{prepare(a, b, spheres), prepare(b, a, spheres)},
                                          Queries{prepare(a, b, more_in_b), prepare(b, a, more_in_a)},
                                          Queries{prepare(a, b, by_volume), prepare(b, a, by_volume)},
                                          Queries{prepare_descent(a, b, spheres), prepare_descent(b, a, spheres)}}) {
    std::mt19937_64 random(41);
    int touching = 0;
    for (int i = 0; i < 20; ++i) {
      const Pose X_AB = ist::random_pose(random, 0.5);
      const Response on_b = forward->respond(X_AB).value;
      const Response on_a_in_b = backward->respond(X_AB.inverse()).value;
      touching += on_b.volume > 0.0 ? 1 : 0;
      EXPECT_NEAR(on_b.volume, on_a_in_b.volume, k_near_rounding);
      EXPECT_LE((on_b.force + X_AB.R * on_a_in_b.force).norm(), 1e-12);
      const Response about_origin = on_b.about(Eigen::Vector3d::Zero());
      const Response reaction = on_a_in_b.about(X_AB.inverse() * Eigen::Vector3d::Zero());
      EXPECT_LE((about_origin.torque + X_AB.R * reaction.torque).norm(), 1e-12);
    }
    EXPECT_GT(touching, 5);
  }
}

/// Many spheres with cones: by symmetry the force is along the face's normal, and along the line of centres of two
/// balls. The packings are not symmetric, so a few degrees remain.
TEST_F(IstTest, ConesPushABallOutOfAPlateAlongItsNormalAndAlongTheCentresOfTwoBalls) {
  const Mesh plate = make_box({.size = {4.0, 4.0, 1.0}}, 100), ball = load_model("sphere-1k");
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
  constexpr double k_packings = 8.0;  // degrees
  const auto degrees = [](const Response& r, const Eigen::Vector3d& direction) {
    return std::acos(r.force.normalized().dot(direction)) * 180.0 / std::numbers::pi;
  };
  const auto on_plate = prepare(plate, ball, {"spheres=1000"}), on_ball = prepare(ball, ball, {"spheres=1000"});
  for (const double depth : {0.05, 0.1, 0.2}) {
    for (const auto& [x, y] : {std::pair{0.13, -0.31}, {0.57, 0.22}, {-0.71, 0.45}}) {
      const Response response = on_plate->respond({R, {x, y, 1.5 - depth}}).value;
      EXPECT_LT(degrees(response, Eigen::Vector3d::UnitZ()), k_packings) << depth;
      EXPECT_LE(response.force.norm(), response.volume * (1.0 + k_rounding));
      const Eigen::Vector3d line = Eigen::Vector3d(x, y, 0.3).normalized();
      EXPECT_LT(degrees(on_ball->respond({R, (2.0 - depth) * line}).value, line), k_packings) << depth;
    }
  }
}

TEST_F(IstTest, BodiesMayHaveDifferentNumbersOfSpheres) {
  const Mesh a = load_model("torus-knot-1k"), b = load_model("bumpy-sphere-1k");
  const auto counts = [](const Query& query) {
    const auto found = query.footprint().counts;
    return std::pair(found[0].second, found[1].second);
  };
  EXPECT_EQ(counts(*prepare(a, b, {"spheres=120"})), std::pair(120.0, 120.0));
  EXPECT_EQ(counts(*prepare(a, b, {"spheres=120", "spheres_b=70"})), std::pair(120.0, 70.0));
  EXPECT_EQ(counts(*prepare_descent(a, b, {"spheres=120", "spheres_b=70"})), std::pair(120.0, 70.0));
  // Copies share a tree only if they have equally many.
  EXPECT_EQ(counts(*prepare(a, a, {"spheres=120", "spheres_b=70"})), std::pair(120.0, 70.0));
  const auto bytes = [&](const std::vector<std::string>& parameters) {
    return prepare(a, a, parameters)->footprint().bytes;
  };
  EXPECT_EQ(bytes({"spheres=120"}), bytes({"spheres=120", "spheres_b=120"}));
  EXPECT_GT(bytes({"spheres=120", "spheres_b=119"}), 1.5 * static_cast<double>(bytes({"spheres=120"})));
}

TEST_F(IstTest, SteepestDescentHasTheVolumeAsMagnitudeAndTheGradientsDirection) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const auto descent = prepare_descent(block, block, {"spheres=3000"});
  const auto gradient = prepare(block, block, {"spheres=3000", "force=gradient", "correct_fill=cells"});
  std::mt19937_64 random(43);
  std::uniform_real_distribution<double> overlap(0.2, 0.6);
  for (int i = 0; i < 6; ++i) {
    const double x = overlap(random), y = overlap(random), z = overlap(random);
    const Pose X{Eigen::Matrix3d::Identity(), {2.0 - x, 1.6 - y, 1.2 - z}};
    const Response steepest = descent->respond(X).value, slope = gradient->respond(X).value;
    const double volume = x * y * z;
    EXPECT_NEAR(steepest.volume, volume, k_gaps * volume);
    EXPECT_EQ(steepest.volume, slope.volume);
    // The gradient acts nearly through the centroid of the overlap, so its moment about it is small.
    EXPECT_LE(steepest.force.norm(), steepest.volume * (1.0 + k_rounding));
    EXPECT_GT(steepest.force.norm(), 0.97 * steepest.volume);
    EXPECT_LE((steepest.force.normalized() - slope.force.normalized()).norm(), k_rounding);
    EXPECT_LE((steepest.torque / steepest.force.norm() - slope.torque / slope.force.norm()).norm(), k_rounding);
    const double angle = std::acos(steepest.force.normalized().dot(Eigen::Vector3d(y * z, x * z, x * y).normalized()));
    EXPECT_LT(angle, 10.0 * std::numbers::pi / 180.0);  // with 3,000 spheres; force=volume: up to 40
  }
}

TEST_F(IstTest, CellsMeasureVolumesBetterThanFillRates) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const auto even = prepare(block, block, {"spheres=1000", "correct_fill=on"});
  const auto cells = prepare(block, block, {"spheres=1000", "correct_fill=cells"});
  std::mt19937_64 random(44);
  std::uniform_real_distribution<double> overlap(0.1, 0.7);
  double even_error = 0.0, cells_error = 0.0;
  constexpr int k_poses = 30;
  for (int i = 0; i < k_poses; ++i) {
    const double x = overlap(random), y = overlap(random), z = overlap(random);
    const Pose X{Eigen::Matrix3d::Identity(), {2.0 - x, 1.6 - y, 1.2 - z}};
    even_error += std::abs(even->respond(X).value.volume / (x * y * z) - 1.0) / k_poses;
    cells_error += std::abs(cells->respond(X).value.volume / (x * y * z) - 1.0) / k_poses;
  }
  EXPECT_LT(cells_error, 0.5 * even_error);
  EXPECT_LT(cells_error, 0.2);
}

/// A pair's force along the line of centres depends on their distance only, so these two laws derive from an energy.
TEST_F(IstTest, IsConservativeOnAClosedLoop) {
  const Mesh a = load_model("torus-knot-1k"), b = load_model("bumpy-sphere-1k");
  for (const char* law : {"force=gradient", "force=volume"}) {
    const auto query = prepare(a, b, {"spheres=200", law});
    const auto work = [&](int steps) { return test::loop_work(*query, b, {0.3, 0.1, 0.0}, 0.4, steps); };
    const double coarse = work(16), fine = work(800);
    EXPECT_LT(fine, 1e-4) << law;
    EXPECT_LT(fine, 0.2 * coarse) << law;
  }
}

TEST_F(IstTest, CorrectionDividesByBothFillRatesAndStiffnessIsAFactor) {
  const Mesh a = load_model("torus-knot-1k"), b = load_model("bumpy-sphere-1k");
  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.3, 0.4, 0.2});
  const auto plain = prepare(a, b, {"spheres=200"});
  const Response response = plain->respond(X).value;
  ASSERT_GT(response.volume, 0.0);
  const auto counts = plain->footprint().counts;
  ASSERT_EQ(counts[2].first, "fill_a");
  ASSERT_EQ(counts[3].first, "fill_b");
  EXPECT_GT(std::abs(counts[2].second - counts[3].second), 0.01);  // else the test could not tell them apart
  const double correction = 1.0 / (counts[2].second * counts[3].second);
  const Response corrected = prepare(a, b, {"spheres=200", "correct_fill=on"})->respond(X).value;
  EXPECT_NEAR(corrected.volume, correction * response.volume, k_rounding * corrected.volume);
  EXPECT_LE((corrected.force - correction * response.force).norm(), k_rounding * corrected.force.norm());
  EXPECT_LE((corrected.torque - correction * response.torque).norm(), k_rounding * corrected.torque.norm());
  const Response stiff = prepare(a, b, {"spheres=200", "stiffness=2.5"})->respond(X).value;
  EXPECT_LE((stiff.force - 2.5 * response.force).norm(), k_rounding * stiff.force.norm());
  EXPECT_LE((stiff.torque - 2.5 * response.torque).norm(), k_rounding * stiff.torque.norm());
  EXPECT_EQ(stiff.volume, response.volume);
}

/// Two spheres: overlap, force and torque are known in closed form.
TEST_F(IstTest, TwoBallsPushEachOtherAlongTheirCentres) {
  const Mesh ball = load_model("sphere-2k");
  const auto query = prepare(ball, ball, {"spheres=1"});
  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {1.1, 0.7, -0.4});
  const Response response = query->respond(X).value;
  const double d = X.t.norm(), r = 1.0, full = std::numbers::pi * std::pow(2 * r - d, 2) * (d + 4 * r) / 12.0;
  constexpr double k_inscribed = 0.1;  // the largest ball in a mesh of 2,000 triangles has a radius of 0.99
  EXPECT_NEAR(response.volume, full, k_inscribed * full);
  EXPECT_LT(response.volume, full);
  EXPECT_NEAR(response.force.dot(X.t) / d, response.volume, k_slope_error * response.volume);  // on B, away from A
  EXPECT_LT(response.torque.norm(), 0.02 * response.force.norm());
}

TEST_F(IstTest, DistanceIsAnUpperBoundAndThatOfTheWitnesses) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const auto query = prepare(block, block, {"spheres=3000"});
  const Pose X{Eigen::Matrix3d::Identity(), {0.1, 0.2, 1.5}};  // true gap 0.3
  const auto gap = query->distance(X);
  ASSERT_TRUE(gap.ok());
  EXPECT_GT(gap.value.distance, 0.3);
  EXPECT_LT(gap.value.distance, 0.4);
  EXPECT_NEAR((gap.value.witness_a - gap.value.witness_b).norm(), gap.value.distance, k_near_rounding);
  EXPECT_FALSE(query->collide(X).value);
  EXPECT_TRUE(query->collide({Eigen::Matrix3d::Identity(), {0.1, 0.2, 1.0}}).value);
}

TEST_F(IstTest, GivesNoForceFarApartAndFailsForAPoseThatIsNotFinite) {
  const Mesh mesh = load_model("torus-knot-1k");
  const auto query = prepare(mesh, mesh, {"spheres=100"});
  for (const double reach : {3.0, 1e9, 1e300}) {
    const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.0, reach, 0.0});
    EXPECT_FALSE(query->collide(X).value) << reach;
    const auto response = query->respond(X);
    ASSERT_TRUE(response.ok()) << reach;
    EXPECT_EQ(response.value.force, Eigen::Vector3d::Zero()) << reach;
    EXPECT_EQ(response.value.volume, 0.0) << reach;
  }
  Pose nowhere = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.3, 0.4, 0.2});
  nowhere.R(1, 2) = std::nan("");
  EXPECT_EQ(query->collide(nowhere).status, Status::non_finite);
  EXPECT_EQ(query->distance(nowhere).status, Status::non_finite);
  EXPECT_EQ(query->respond(nowhere).status, Status::non_finite);
  EXPECT_FALSE(query->diagnosis().empty());
}

TEST_F(IstTest, CachedPackingGivesTheSameAnswer) {
  const std::string cache = ::testing::TempDir() + "/sixdof_ist_cache" + std::to_string(::getpid());
  std::filesystem::remove_all(cache);
  ::setenv("SIXDOF_CACHE", cache.c_str(), 1);
  const Mesh mesh = load_model("torus-knot-1k");
  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.3, 0.4, 0.2});
  const Response built = prepare(mesh, mesh, {"spheres=150"})->respond(X).value;
  const std::vector<std::string> cells{"spheres=150", "correct_fill=cells"};
  const Response weighted = prepare(mesh, mesh, cells)->respond(X).value;
  EXPECT_GT(weighted.volume, built.volume);
  EXPECT_EQ(prepare(mesh, mesh, cells)->respond(X).value.force, weighted.force);
  ASSERT_FALSE(std::filesystem::is_empty(cache));
  const Response cached = prepare(mesh, mesh, {"spheres=150"})->respond(X).value;
  EXPECT_EQ(built.volume, cached.volume);
  EXPECT_EQ(built.force, cached.force);
  EXPECT_EQ(built.torque, cached.torque);
  EXPECT_GT(built.volume, 0.0);
  EXPECT_EQ(prepare_descent(mesh, mesh, {"spheres=150"})->respond(X).value.volume, weighted.volume);
  // A damaged entry is built and stored again.
  for (const auto& file : std::filesystem::directory_iterator(cache)) {
    std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) - 500);
  }
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=150"})->respond(X).value.force, built.force);
  for (const auto& file : std::filesystem::directory_iterator(cache)) {
    std::fstream bytes(file.path(), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file.path()) / 2));
    bytes.put('\x5a');
  }
  EXPECT_EQ(prepare(mesh, mesh, cells)->respond(X).value.force, weighted.force);
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=150"})->respond(X).value.force, built.force);
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=151"})->footprint().counts.front().second, 151.0);  // another key
  std::filesystem::remove_all(cache);
}

}  // namespace
}  // namespace sixdof
