#include <sixdof/algorithm/bullet/bullet.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

TEST(Bullet, AnswersAsExactWhereItIsClear) { test::expect_clear_answers(*make_bullet_gimpact_algorithm()); }

TEST(Bullet, RepeatsItself) { test::expect_repeatable(*make_bullet_gimpact_algorithm()); }

TEST(Bullet, PushesABallOutOfAFace) {
  // GImpact also sees the facets that lie wholly below the face.
  test::expect_ball_pushed_out(*make_bullet_gimpact_algorithm(), 1.0 - 1e-6);
}

TEST(Bullet, FailsOnAPoseThatIsNotFinite) { test::expect_no_answer_where_not_finite(*make_bullet_gimpact_algorithm()); }

TEST(Bullet, KnowsSurfacesOnly) { test::expect_no_contact_inside(*make_bullet_gimpact_algorithm()); }

TEST(Bullet, ThickensTrianglesByTheMargin) {
  const test::BallOnFace t;
  Pose apart = t.X_AB;
  apart.t.y() = 3.3;
  const auto algorithm = make_bullet_gimpact_algorithm();
  EXPECT_FALSE(test::prepare(*algorithm, t.block, t.ball)->collide(apart).value);
  EXPECT_TRUE(test::prepare(*algorithm, t.block, t.ball, {"margin=0.2"})->collide(apart).value);
}

/// Known failure: the ball is apart from the tilted plate by twice its radius. Its facets are in front of the plate's
/// upper side, so behind the lower one, and inside the large boxes of the plate's triangles: GImpact calls that a
/// contact. The boxes of the plate that is not tilted are thin.
TEST(Bullet, TakesWhatIsBehindATriangleForAContact) {
  const Mesh plate = box_solid({-5.0, -0.1, -5.0}, {5.0, 0.0, 5.0}, "plate");
  const Mesh ball = sphere_solid(1.0, 24, RoundParts::inscribed, "ball");
  const Pose tilt{(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix(),
                  Eigen::Vector3d::Zero()};
  const Pose above{Eigen::Matrix3d::Identity(), {0.31, 3.0, 0.27}};
  const auto algorithm = make_bullet_gimpact_algorithm();
  EXPECT_FALSE(test::prepare(*algorithm, plate, ball)->collide(above).value);
  const Mesh tilted = test::moved(plate, tilt);
  EXPECT_TRUE(test::prepare(*algorithm, tilted, ball)->collide(tilt * above).value);
}

TEST(Bullet, SharesTheStructureOfEqualMeshes) {
  const Mesh a = load_model("cone-1k"), b = load_model("torus-1k");
  const auto algorithm = make_bullet_gimpact_algorithm();
  const auto triangles = [](const Query& query) { return query.footprint().counts.back().second; };
  EXPECT_EQ(triangles(*test::prepare(*algorithm, a, a)), static_cast<double>(a.triangles().size()));
  EXPECT_EQ(triangles(*test::prepare(*algorithm, a, b)),
            static_cast<double>(a.triangles().size() + b.triangles().size()));
}

TEST(Bullet, RegistersWithVersionAndPrecision) {
  Registry registry;
  register_bullet_algorithms(registry);
  EXPECT_THAT(registry.find("bullet-gimpact").traits().version, ::testing::MatchesRegex("[0-9.]+ double"));
}

}  // namespace
}  // namespace sixdof
