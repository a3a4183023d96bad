#include <sixdof/measure/contact_score.h>

#include <map>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/query/contacts.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;

constexpr double k_rounding = 1e-9;  // diagonals
constexpr double k_angle = 0.01;     // degrees

/// A box, and a bumpy ball that overlaps one of its edges, with contacts that are right.
class ContactScoreTest : public ::testing::Test {
 protected:
  ContactScoreTest() : truth_(a_, b_) {
    truth_.move_to(X_AB_);
    right_ = ask(a_, b_, X_AB_);
  }

  static Contacts ask(const Mesh& a, const Mesh& b, const Pose& X_AB) {
    const auto algorithm = make_exact_contacts_algorithm();
    return algorithm->prepare(a, b, algorithm->settings())->contacts(X_AB, 100'000).value;
  }

  template <class Change>
  ContactScore changed(const Change& change) {
    Contacts contacts = right_;
    for (Contact& each : contacts.list) change(each);
    return score_contacts(contacts, truth_);
  }

  static double mean_normal_angle(const ContactScore& score) {
    return score.normal_sum / static_cast<double>(score.judged);
  }

  const Mesh a_ = shapes::box({1.0, 0.8, 0.6});
  const Mesh b_ = shapes::bumpy_sphere(2, 0.1, 0.5);
  const Pose X_AB_{Eigen::AngleAxisd(0.9, Vector3d(0.36, 0.48, 0.8)).toRotationMatrix(), {0.13, 0.91, 0.74}};
  ContactTruth truth_;
  Contacts right_;
};

TEST_F(ContactScoreTest, OfRightContacts) {
  const ContactScore score = score_contacts(right_, truth_);
  EXPECT_GT(score.count, 20u);
  EXPECT_EQ(score.judged, score.count);
  EXPECT_LT(score.off_max, k_rounding);
  EXPECT_LT(score.normal_max, k_angle);
  EXPECT_EQ(score.off_bodies, 0u);
  EXPECT_EQ(score.reversed, 0u);
  EXPECT_NEAR(score.depth_sum, score.thickness_sum, 1e-6 * score.thickness_sum);
  ASSERT_TRUE(score.force_angle);
  EXPECT_LT(*score.force_angle, 45.0) << "normals of the region lie about the force";
  EXPECT_LT(score.uncovered, 0.05);
  EXPECT_LT(score.astray, 0.05);
  EXPECT_FALSE(score.is_faulty());
}

TEST_F(ContactScoreTest, ReversedNormalsAreFoundByTheirAngles) {
  const ContactScore right = score_contacts(right_, truth_);
  const ContactScore score = changed([](Contact& each) { each.normal *= -1.0; });
  // Where the surfaces cross at right angles, the reverse of a normal of one is not far from a normal of the other.
  EXPECT_GT(score.reversed, 5u);
  EXPECT_GT(mean_normal_angle(score), 80.0);
  EXPECT_NEAR(*score.force_angle, 180.0 - *right.force_angle, 1e-6);
  EXPECT_TRUE(score.is_faulty());
  EXPECT_LT(score.off_max, k_rounding) << "points are right";
  EXPECT_NEAR(score.depth_sum, score.thickness_sum, 1e-6 * score.thickness_sum) << "depths are right";
}

TEST_F(ContactScoreTest, PointsInTheFrameOfBAreFoundByTheirDistances) {
  const Pose X_BA = X_AB_.inverse();
  const ContactScore score = changed([&](Contact& each) { each.point = X_BA * each.point; });
  EXPECT_GT(score.off_max, 0.05);
  EXPECT_GT(score.astray, 0.05);
  EXPECT_GT(score.uncovered, 0.05);
}

TEST_F(ContactScoreTest, PointsOffBothBodiesAreFaults) {
  const ContactScore score = changed([](Contact& each) { each.point += Vector3d(0.0, 1.3, 0.9); });
  EXPECT_EQ(score.off_bodies, score.judged);
  EXPECT_TRUE(score.is_faulty());
}

TEST_F(ContactScoreTest, HalvedDepthsAreFoundByTheirRatio) {
  const ContactScore score = changed([](Contact& each) { each.depth *= 0.5; });
  EXPECT_NEAR(score.depth_sum, 0.5 * score.thickness_sum, 1e-6 * score.thickness_sum);
  EXPECT_FALSE(score.is_faulty()) << "a depth has many meanings";
  EXPECT_LT(score.normal_max, k_angle);
}

TEST_F(ContactScoreTest, FewContactsLeaveTheRegionUncovered) {
  Contacts few = right_;
  few.list.resize(1);
  EXPECT_GT(score_contacts(few, truth_).uncovered, 0.1);
  const ContactScore none = score_contacts({}, truth_);
  EXPECT_TRUE(none.is_faulty());
  EXPECT_FALSE(none.force_angle);
}

TEST_F(ContactScoreTest, ExchangeOfTheBodies) {
  const Contacts back = ask(b_, a_, X_AB_.inverse());
  const ContactChange right = compare_contacts(right_, exchanged(back, X_AB_), a_.diagonal());
  EXPECT_LT(right.points, k_rounding);
  EXPECT_LT(right.normal_angle, k_angle);
  EXPECT_EQ(right.flips, 0u);
  EXPECT_FALSE(right.is_other_number);
  // Normals that do not change sign with the order: those of (B, A) lead from A to B.
  Contacts wrong = back;
  for (Contact& each : wrong.list) each.normal *= -1.0;
  const ContactChange flipped = compare_contacts(right_, exchanged(wrong, X_AB_), a_.diagonal());
  EXPECT_NEAR(flipped.mean_normal_angle, 180.0, k_angle);
  EXPECT_GT(flipped.flips, right_.list.size() / 4);
  EXPECT_LT(flipped.points, k_rounding) << "points are right";
}

TEST_F(ContactScoreTest, PointsThatMove) {
  Contacts moved = right_;
  for (Contact& each : moved.list) each.point += Vector3d(0.0, 0.0, 0.01);
  const ContactChange change = compare_contacts(right_, moved, a_.diagonal());
  EXPECT_GT(change.points, 0.0);
  EXPECT_LE(change.points, 0.01 / a_.diagonal() + k_rounding) << "never farther than each contact";
  moved.list.pop_back();
  EXPECT_TRUE(compare_contacts(right_, moved, a_.diagonal()).is_other_number);
  EXPECT_FALSE(compare_contacts(right_, {}, a_.diagonal()).is_comparable);
}

TEST_F(ContactScoreTest, EveryCounterIsAMetric) {
  ContactScores scores;
  scores.add(score_contacts(right_, truth_));
  scores.add(changed([](Contact& each) { each.depth *= 0.5; }));
  const ContactChange change = compare_contacts(right_, right_, a_.diagonal());
  scores.add_exchange(change);
  scores.add_motion(change);
  scores.add_motion(std::nullopt);
  scores.add_step(change, 0.3, 0.001);
  std::map<std::string, double> values;
  scores.for_each([&](std::string_view counter, double value) {
    const Metric* const metric = find_metric(counter);
    ASSERT_NE(metric, nullptr) << counter;
    EXPECT_EQ(metric->name, counter);
    EXPECT_TRUE(values.try_emplace(std::string(counter), value).second) << counter;
  });
  EXPECT_NEAR(values.at("contact_depth_ratio"), 0.75, 1e-6);
  EXPECT_EQ(values.at("contacts_mean"), static_cast<double>(right_.list.size()));
  EXPECT_EQ(values.at("exchange_flips"), 0.0);
  EXPECT_EQ(values.at("exchange_failed"), 0.0);
  EXPECT_EQ(values.at("moved_failed"), 1.0);
  EXPECT_EQ(values.at("step_force_deg"), 0.3);
  EXPECT_EQ(scores.faulty(), 0u);
}

}  // namespace
}  // namespace sixdof
