#include <sixdof/algorithm/ist/ist.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/models/boxes.h>
#include <sixdof/models/model_catalogue.h>

#include "../closed_loop.h"
#include "random_spheres.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // relative, of some hundred terms

class IstTest : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("SIXDOF_CACHE", "off", 1); }

  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const std::vector<std::string>& parameters) const {
    Settings settings = algorithm_->settings();
    settings.set_all(parameters);
    return algorithm_->prepare(a, b, settings);
  }

  std::unique_ptr<Algorithm> algorithm_ = make_ist_algorithm();
};

/// Two blocks without rotation: overlap volume and its gradient are a box and its face.
TEST_F(IstTest, VolumeAndForceApproachTheBlocksAsSpheresGrowInNumber) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const Eigen::Vector3d shift(0.4, 0.15, 1.0);  // overlap 1.6 x 1.45 x 0.2: the way out is along z
  const Pose X{Eigen::Matrix3d::Identity(), shift};
  const double volume = (2.0 - 0.4) * (1.6 - 0.15) * (1.2 - 1.0);
  const Eigen::Vector3d push =
      Eigen::Vector3d(1.45 * 0.2, 1.6 * 0.2, 1.6 * 1.45).normalized();  // -grad V: areas of the faces
  double last_volume_error = 1.0, last_angle = 180.0;
  for (const char* spheres : {"spheres=100", "spheres=500", "spheres=2500"}) {
    const auto response = prepare(block, block, {spheres, "force=gradient", "correct_fill=on"})->respond(X);
    ASSERT_TRUE(response.ok());
    const double volume_error = std::abs(response.value.volume / volume - 1.0);
    const double angle = std::acos(response.value.force.normalized().dot(push)) * 180.0 / std::numbers::pi;
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
  for (const std::vector<std::string>& parameters :
       {std::vector<std::string>{"spheres=300"}, {"spheres=300", "force=descent", "correct_fill=cells"}}) {
    const auto forward = prepare(a, b, parameters), backward = prepare(b, a, parameters);
    std::mt19937_64 random(41);
    int touching = 0;
    for (int i = 0; i < 20; ++i) {
      const Pose X_AB = ist::random_pose(random, 0.5);
      const Response on_b = forward->respond(X_AB).value;
      const Response on_a_in_b = backward->respond(X_AB.inverse()).value;
      touching += on_b.volume > 0.0 ? 1 : 0;
      EXPECT_NEAR(on_b.volume, on_a_in_b.volume, 1e-12);
      EXPECT_LE((on_b.force + X_AB.R * on_a_in_b.force).norm(), 1e-12);
      const Response about_origin = on_b.about(Eigen::Vector3d::Zero());
      const Response reaction = on_a_in_b.about(X_AB.inverse() * Eigen::Vector3d::Zero());
      EXPECT_LE((about_origin.torque + X_AB.R * reaction.torque).norm(), 1e-12);
    }
    EXPECT_GT(touching, 5);
  }
}

/// Blocks again: the overlap is a box, so its volume, its gradient and its place are known.
TEST_F(IstTest, DescentPushesWithTheVolumeAndTheGradientsDirection) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const std::vector<std::string> parameters{"spheres=3000", "correct_fill=cells"};
  const auto with = [&](const char* force) {
    std::vector<std::string> all = parameters;
    all.emplace_back(force);
    return prepare(block, block, all);
  };
  const auto descent = with("force=descent"), gradient = with("force=gradient");
  std::mt19937_64 random(43);
  std::uniform_real_distribution<double> overlap(0.2, 0.6);
  for (int i = 0; i < 6; ++i) {
    const double x = overlap(random), y = overlap(random), z = overlap(random);
    const Pose X{Eigen::Matrix3d::Identity(), {2.0 - x, 1.6 - y, 1.2 - z}};
    const Response push = descent->respond(X).value, slope = gradient->respond(X).value;
    const double volume = x * y * z;
    EXPECT_NEAR(push.volume, volume, 0.1 * volume);
    EXPECT_EQ(push.volume, slope.volume);
    // The gradient acts through the box's middle, nearly: hardly any of the magnitude goes into a torque.
    EXPECT_LE(push.force.norm(), push.volume * (1.0 + k_rounding));
    EXPECT_GT(push.force.norm(), 0.97 * push.volume);
    EXPECT_LE((push.force.normalized() - slope.force.normalized()).norm(), k_rounding);
    EXPECT_LE((push.torque / push.force.norm() - slope.torque / slope.force.norm()).norm(), k_rounding);
    const double angle = std::acos(push.force.normalized().dot(Eigen::Vector3d(y * z, x * z, x * y).normalized()));
    EXPECT_LT(angle, 10.0 * std::numbers::pi / 180.0);  // with 3,000 spheres; the paper's law: up to 40
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

/// Every pair's force is along the line of centres and depends on their distance alone, so both laws derive from an
/// energy: a closed loop of translations and turns costs nothing.
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
  EXPECT_GT(std::abs(counts[2].second - counts[3].second), 0.01);  // else the two could be mistaken
  const double gain = 1.0 / (counts[2].second * counts[3].second);
  const Response corrected = prepare(a, b, {"spheres=200", "correct_fill=on"})->respond(X).value;
  EXPECT_NEAR(corrected.volume, gain * response.volume, k_rounding * corrected.volume);
  EXPECT_LE((corrected.force - gain * response.force).norm(), k_rounding * corrected.force.norm());
  EXPECT_LE((corrected.torque - gain * response.torque).norm(), k_rounding * corrected.torque.norm());
  const Response stiff = prepare(a, b, {"spheres=200", "stiffness=2.5"})->respond(X).value;
  EXPECT_LE((stiff.force - 2.5 * response.force).norm(), k_rounding * stiff.force.norm());
  EXPECT_LE((stiff.torque - 2.5 * response.torque).norm(), k_rounding * stiff.torque.norm());
  EXPECT_EQ(stiff.volume, response.volume);
}

/// Two spheres, whose overlap, force and torque are known in closed form.
TEST_F(IstTest, TwoBallsPushEachOtherAlongTheirCentres) {
  const Mesh ball = load_model("sphere-2k");
  const auto query = prepare(ball, ball, {"spheres=1"});
  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {1.1, 0.7, -0.4});
  const Response response = query->respond(X).value;
  const double d = X.t.norm(), r = 1.0, full = std::numbers::pi * std::pow(2 * r - d, 2) * (d + 4 * r) / 12.0;
  constexpr double k_inscribed = 0.1;  // the largest ball in a mesh of 2,000 triangles has a radius of 0.99
  EXPECT_NEAR(response.volume, full, k_inscribed * full);
  EXPECT_LT(response.volume, full);
  EXPECT_NEAR(response.force.dot(X.t) / d, response.volume, 1e-3 * response.volume);  // on B, away from A
  EXPECT_LT(response.torque.norm(), 0.02 * response.force.norm());
}

TEST_F(IstTest, DistanceIsFromAboveAndWitnessesRealiseIt) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 100);
  const auto query = prepare(block, block, {"spheres=3000"});
  const Pose X{Eigen::Matrix3d::Identity(), {0.1, 0.2, 1.5}};  // true gap 0.3
  const auto gap = query->distance(X);
  ASSERT_TRUE(gap.ok());
  EXPECT_GT(gap.value.distance, 0.3);
  EXPECT_LT(gap.value.distance, 0.4);
  EXPECT_NEAR((gap.value.witness_a - gap.value.witness_b).norm(), gap.value.distance, 1e-12);
  EXPECT_FALSE(query->collide(X).value);
  EXPECT_TRUE(query->collide({Eigen::Matrix3d::Identity(), {0.1, 0.2, 1.0}}).value);
}

TEST_F(IstTest, FarApartThereIsNothingAndAPoseThatIsNotFiniteIsAFailure) {
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

TEST_F(IstTest, KeptPackingGivesTheSameAnswer) {
  const std::string cache = ::testing::TempDir() + "/sixdof_ist_cache";
  std::filesystem::remove_all(cache);
  ::setenv("SIXDOF_CACHE", cache.c_str(), 1);
  const Mesh mesh = load_model("torus-knot-1k");
  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.3, 0.4, 0.2});
  const Response made = prepare(mesh, mesh, {"spheres=150"})->respond(X).value;
  const std::vector<std::string> shared{"spheres=150", "correct_fill=cells"};
  const Response weighed = prepare(mesh, mesh, shared)->respond(X).value;
  EXPECT_GT(weighed.volume, made.volume);
  EXPECT_EQ(prepare(mesh, mesh, shared)->respond(X).value.force, weighed.force);
  ASSERT_FALSE(std::filesystem::is_empty(cache));
  const Response kept = prepare(mesh, mesh, {"spheres=150"})->respond(X).value;
  EXPECT_EQ(made.volume, kept.volume);
  EXPECT_EQ(made.force, kept.force);
  EXPECT_EQ(made.torque, kept.torque);
  EXPECT_GT(made.volume, 0.0);
  // A damaged file is no entry: the packing is made again, and kept.
  for (const auto& file : std::filesystem::directory_iterator(cache)) {
    std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) - 500);
  }
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=150"})->respond(X).value.force, made.force);
  for (const auto& file : std::filesystem::directory_iterator(cache)) {
    std::fstream bytes(file.path(), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file.path()) / 2));
    bytes.put('\x5a');
  }
  EXPECT_EQ(prepare(mesh, mesh, shared)->respond(X).value.force, weighed.force);
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=150"})->respond(X).value.force, made.force);
  EXPECT_EQ(prepare(mesh, mesh, {"spheres=151"})->footprint().counts.front().second, 151.0);  // another key
  std::filesystem::remove_all(cache);
}

}  // namespace
}  // namespace sixdof
