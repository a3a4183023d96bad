#include <sixdof/algorithm/simbody/simbody.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/conformance.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

constexpr double k_slope_error = 1e-6;  // relative: of a slope from a central difference

SIXDOF_CONFORMANCE(make_simbody_algorithm);

TEST(Simbody, AnswersAsExactWhereItIsClear) { test::expect_clear_yes_no(*make_simbody_algorithm()); }

TEST(Simbody, RepeatsItself) { test::expect_repeatable(*make_simbody_algorithm()); }

TEST(Simbody, FailsOnAPoseThatIsNotFinite) { test::expect_no_answer_where_not_finite(*make_simbody_algorithm()); }

TEST(Simbody, KnowsSurfacesOnly) { test::expect_no_contact_inside(*make_simbody_algorithm()); }

/// Simbody halves the areas where both bodies have springs.
constexpr double k_area_factor = 0.5;

/// The ball's springs push along the face's normal; none of the block's large triangles has its centroid in the ball.
TEST(Simbody, PushesABallOutOfAFaceByTheSumOfAreaTimesDepth) {
  const test::BallOnFace t;
  double sum = 0.0;
  for (const Triangle& triangle : t.ball.triangles()) {
    const Eigen::Vector3d p = t.X_AB * t.ball.vertices()[triangle[0]], q = t.X_AB * t.ball.vertices()[triangle[1]],
                          r = t.X_AB * t.ball.vertices()[triangle[2]];
    sum += k_area_factor * 0.5 * (q - p).cross(r - p).norm() * std::max(0.0, -(p + q + r).y() / 3.0);
  }
  constexpr double k_rounding = 1e-9;
  for (const bool block_first : {true, false}) {
    const auto query = block_first ? test::prepare(*make_simbody_algorithm(), t.block, t.ball)
                                   : test::prepare(*make_simbody_algorithm(), t.ball, t.block);
    const auto outcome = query->respond(block_first ? t.X_AB : t.X_AB.inverse());
    ASSERT_TRUE(outcome.ok()) << query->diagnosis();
    const Response r = outcome.value.about(block_first ? t.X_AB * t.ball.center() : t.ball.center());
    const Eigen::Vector3d on_ball = block_first ? r.force : Eigen::Vector3d(-(t.X_AB.R * r.force));
    EXPECT_LT((on_ball - Eigen::Vector3d(0.0, sum, 0.0)).norm(), k_rounding * sum);
    EXPECT_LT(r.torque.norm(), test::BallOnFace::k_edge * test::BallOnFace::k_radius * sum);
  }
}

/// The penalty stands for the energy: its derivative along a translation is minus the force.
TEST(Simbody, ForceIsTheDerivativeOfTheEnergyOnAFlatFace) {
  const test::BallOnFace t;
  const auto query = test::prepare(*make_simbody_algorithm(), t.block, t.ball);
  const auto energy = [&](double y) {
    Pose X_AB = t.X_AB;
    X_AB.t.y() += y;
    const double depth = query->respond(X_AB).value.penalty;
    return 0.5 * k_area_factor * depth * depth * (t.block.area() + t.ball.area());
  };
  constexpr double k_step = 1e-5;
  const double force = query->respond(t.X_AB).value.force.y();
  EXPECT_NEAR((energy(-k_step) - energy(k_step)) / (2.0 * k_step), force, k_slope_error * force);
}

TEST(Simbody, RefusesAnOpenMesh) {
  const Mesh ball = sphere_solid(1.0, 8, RoundParts::inscribed, "ball");
  std::vector<Triangle> triangles = ball.triangles();
  triangles.pop_back();
  const Mesh open = Mesh::build(ball.vertices(), triangles, "open");
  EXPECT_THROW(test::prepare(*make_simbody_algorithm(), open, ball), BadMesh);
  EXPECT_THROW(test::prepare(*make_simbody_algorithm(), ball, open), BadMesh);
}

}  // namespace
}  // namespace sixdof
