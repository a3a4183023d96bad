#include <sixdof/algorithm/coal/coal.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

class Coal : public ::testing::TestWithParam<const char*> {
 protected:
  const std::unique_ptr<Algorithm> algorithm = make_coal_obbrss_algorithm();
  const std::vector<std::string> parameters = {std::string("profile=") + GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Profiles, Coal, ::testing::Values("default", "tuned"),
                         [](const auto& profile) { return std::string(profile.param); });

TEST_P(Coal, AnswersYesNoAsExactWhereItIsClear) { test::expect_clear_yes_no(*algorithm, parameters); }

TEST_P(Coal, GivesTheDistanceOfExact) {
  // Coal's default tolerance of GJK, of distances of about the size of the bodies.
  constexpr double k_tolerance = 1e-5;
  const test::ClearPoses clear(40);
  const auto exact = make_exact_algorithm();
  const auto truth = test::prepare(*exact, clear.a, clear.b);
  const auto ab = test::prepare(*algorithm, clear.a, clear.b, parameters),
             ba = test::prepare(*algorithm, clear.b, clear.a, parameters);
  for (const auto& [X_AB, overlap] : clear.poses) {
    const double expected = truth->distance(X_AB).value.distance;
    const auto forth = ab->distance(X_AB), back = ba->distance(X_AB.inverse());
    ASSERT_TRUE(forth.ok() && back.ok()) << ab->diagnosis() << ba->diagnosis();
    EXPECT_NEAR(forth.value.distance, expected, k_tolerance);
    EXPECT_NEAR(back.value.distance, expected, k_tolerance);
    if (!forth.value.has_witnesses) continue;
    EXPECT_NEAR((forth.value.witness_a - forth.value.witness_b).norm(), expected, k_tolerance);
  }
}

TEST_P(Coal, FailsOnAPoseThatIsNotFinite) {
  const test::BallOnFace t;
  const auto query = test::prepare(*algorithm, t.block, t.ball, parameters);
  Pose bad = t.X_AB;
  bad.R(2, 1) = std::nan("");
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_EQ(query->distance(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not finite"));
  EXPECT_TRUE(query->collide(t.X_AB).value);
}

/// The sign of Coal's depth and the direction of its normal.
TEST(CoalContacts, PushABallOutOfAFace) {
  const test::BallOnFace t;
  const auto outcome = test::prepare(*make_coal_contacts_algorithm(), t.block, t.ball)->respond(t.X_AB);
  ASSERT_TRUE(outcome.ok());
  EXPECT_GT(outcome.value.force.normalized().y(), 0.98);
  EXPECT_GT(outcome.value.penalty, 0.5 * t.depth());
  EXPECT_LT(outcome.value.penalty, 1.01 * t.depth());
}

}  // namespace
}  // namespace sixdof
