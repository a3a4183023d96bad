#include "bench/harness/depth_truth.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/measure/direction.h>

#include "own_truths.h"

namespace sixdof::bench {
namespace {

struct OwnTruth : OwnTruths {
  OwnTruth() : OwnTruths("depth_truth_cache") {}
  std::size_t files() const {
    if (!std::filesystem::exists(cache)) return 0;
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(cache), std::filesystem::directory_iterator()));
  }
};

TEST_F(OwnTruth, IsWhatTheExactAlgorithmsOfDepthAnswer) {
  DepthTruths truths(a, b);
  for (const auto& algorithm : {make_exact_depth_algorithm(), make_exact_way_out_algorithm()}) {
    Settings settings = algorithm->settings();
    settings.set("tolerance", "0.005");  // as the truths have; both together are within what is judged
    const auto query = algorithm->prepare(a, b, settings);
    const std::vector<Pose> at = poses(3);
    const std::span<const DepthTruth> found = truths.at(at, algorithm->traits().law);
    ASSERT_EQ(found.size(), at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Outcome<Response> outcome = query->respond(at[i]);
      ASSERT_TRUE(outcome.ok()) << query->diagnosis();
      const Response& answer = outcome.value;
      ASSERT_TRUE(found[i].force_judged);
      EXPECT_LE((found[i].response.force - answer.force).norm(), DepthTruth::k_judged_error * answer.force.norm());
      EXPECT_EQ(found[i].response.reference, answer.reference);
    }
  }
}

TEST_F(OwnTruth, OfContactsIsThatOfDepth) {
  DepthTruths truths(a, b);
  const std::vector<Pose> at = poses(1);
  const DepthTruth depth = truths.at(at, ResponseLaw::depth).front();
  EXPECT_EQ(truths.at(at, ResponseLaw::contacts).front().response.force, depth.response.force);
  // The two directions are not the same law.
  const DepthTruth way_out = truths.at(at, ResponseLaw::way_out).front();
  EXPECT_GT(angle_degrees(way_out.response.force, depth.response.force), 0.5);
}

TEST_F(OwnTruth, IsReadFromTheCache) {
  const std::vector<Pose> at = poses(2), others = poses(3);
  const DepthTruth first = DepthTruths(a, b).at(at, ResponseLaw::depth).back();
  ASSERT_EQ(files(), 1u);
  const DepthTruth again = DepthTruths(a, b).at(at, ResponseLaw::depth).back();
  EXPECT_EQ(again.response.force, first.response.force);
  EXPECT_EQ(again.response.torque, first.response.torque);
  EXPECT_EQ(again.response.penalty, first.response.penalty);
  EXPECT_EQ(again.force_judged, first.force_judged);
  EXPECT_EQ(again.torque_judged, first.torque_judged);
  EXPECT_EQ(files(), 1u);
  DepthTruths(a, b).at(others, ResponseLaw::depth);
  DepthTruths(a, b).at(at, ResponseLaw::way_out);
  DepthTruths(b, a).at(at, ResponseLaw::depth);
  EXPECT_EQ(files(), 4u);
}

TEST_F(OwnTruth, IsOfTheFirstPosesOnly) {
  std::vector<Pose> far = poses(1);
  far.front().t.x() += 10.0;
  far.resize(DepthTruths::k_most + 5, far.front());
  DepthTruths truths(a, b);
  const std::span<const DepthTruth> found = truths.at(far, ResponseLaw::depth);
  EXPECT_EQ(found.size(), DepthTruths::k_most);
  // Known to be zero.
  EXPECT_TRUE(found.front().force_judged);
  EXPECT_EQ(found.front().response.force, Eigen::Vector3d::Zero());
}

TEST_F(OwnTruth, IsOfSolidsOnly) {
  std::vector<Triangle> t = a.triangles();
  t.pop_back();
  const Mesh open = Mesh::build(a.vertices(), std::move(t), "open");
  EXPECT_THROW(DepthTruths(open, b).at(poses(1), ResponseLaw::depth), BadMesh);
}

}  // namespace
}  // namespace sixdof::bench
