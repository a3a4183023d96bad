#include <sixdof/algorithm/cgal/cgal.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/conformance.h>

#include "../volume_checks.h"

namespace sixdof {
namespace {

/// CGAL's new vertices are rounded to doubles: a few roundings, of volumes of a thousandth of the cube of the diagonal.
constexpr double k_rounding = 1e-9;

SIXDOF_CONFORMANCE(make_cgal_algorithm);

TEST(Cgal, AnswersAsExact) {
  test::expect_clear_yes_no(*make_cgal_algorithm());
  test::expect_close_yes_no(*make_cgal_algorithm());
  test::expect_touching_boxes_collide(*make_cgal_algorithm());
}

TEST(Cgal, GivesTheVolumeAndItsGradient) {
  test::expect_response_of_exact(*make_cgal_algorithm(), k_rounding);
  test::expect_volume_of_inner_body(*make_cgal_algorithm());
}

TEST(Cgal, RepeatsItself) { test::expect_repeatable(*make_cgal_algorithm()); }

TEST(Cgal, FailsOnAPoseThatIsNotFinite) { test::expect_no_answer_where_not_finite(*make_cgal_algorithm()); }

TEST(Cgal, CollidesSurfacesOnly) {
  const test::BallOnFace t;
  Pose inside = t.X_AB;
  inside.t.y() = -14.0;
  EXPECT_FALSE(test::prepare(*make_cgal_algorithm(), t.block, t.ball)->collide(inside).value);
}

TEST(Cgal, HasNoResponseOfAnOpenMesh) {
  const Mesh ball = sphere_solid(1.0, 8, RoundParts::inscribed, "ball");
  std::vector<Triangle> triangles = ball.triangles();
  triangles.pop_back();
  const Mesh open = Mesh::build(ball.vertices(), triangles, "open");
  const auto algorithm = make_cgal_algorithm();
  const auto query = test::prepare(*algorithm, open, ball);
  EXPECT_TRUE(query->collide({Eigen::Matrix3d::Identity(), {0.3, 0.2, 0.1}}).value);
  EXPECT_EQ(query->respond({Eigen::Matrix3d::Identity(), {0.3, 0.2, 0.1}}).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not closed"));
}

TEST(Cgal, SaysItsLicence) {
  EXPECT_THAT(make_cgal_algorithm()->traits().version, ::testing::HasSubstr("GPL"));
  EXPECT_THAT(make_cgal_algorithm()->traits().summary, ::testing::HasSubstr("GPL"));
  EXPECT_FALSE(make_cgal_algorithm()->traits().in_default_runs());
}

}  // namespace
}  // namespace sixdof
