#include <sixdof/algorithm/ccd/ccd.h>

#include <sixdof/algorithm/ccd/convex_hull.h>
#include <sixdof/base/error.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

TEST(ConvexHull, IsASolidThatHoldsEveryVertex) {
  for (const char* name : {"torus-1k", "cone-1k"}) {
    const Mesh mesh = load_model(name), hull = convex_hull(mesh);
    EXPECT_TRUE(hull.solid()) << hull.why_not_solid();
    EXPECT_TRUE(hull.topology().manifold);
    EXPECT_EQ(hull.topology().euler_characteristic, 2);
    EXPECT_GE(hull.volume(), mesh.volume() * (1.0 - 1e-12));
    double farthest = 0.0;
    for (const Triangle& t : hull.triangles()) {
      const Eigen::Vector3d p = hull.vertices()[t[0]];
      const Eigen::Vector3d normal = (hull.vertices()[t[1]] - p).cross(hull.vertices()[t[2]] - p).normalized();
      if (!normal.allFinite()) continue;
      for (const Eigen::Vector3d& v : mesh.vertices()) farthest = std::max(farthest, normal.dot(v - p));
    }
    // Qhull takes points within its tolerance for coplanar.
    EXPECT_LT(farthest, 1e-9 * mesh.diagonal());
  }
  const Mesh box = box_solid({-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}, "box");
  EXPECT_NEAR(convex_hull(box).volume(), 48.0, 1e-12);
}

TEST(ConvexHull, RefusesAFlatMesh) {
  const Mesh flat = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}, "flat");
  EXPECT_THROW(convex_hull(flat), BadMesh);
}

/// Of hulls and meshes that are clearly apart or clearly overlap, in both orders.
TEST(CcdHull, AnswersForTheHulls) {
  const Mesh a = load_model("torus-1k"), b = load_model("cone-1k");
  const Mesh hull_a = convex_hull(a), hull_b = convex_hull(b);
  const auto exact = make_exact_algorithm();
  const auto truth = test::prepare(*exact, hull_a, hull_b);
  for (const std::string method : {"method=gjk", "method=mpr"}) {
    const auto algorithm = make_ccd_hull_algorithm();
    const auto ab = test::prepare(*algorithm, a, b, {method}), ba = test::prepare(*algorithm, b, a, {method});
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> reach(0.1, 0.9);
    int apart = 0, overlapping = 0;
    while (apart + overlapping < 200) {
      const Pose X_AB = test::generic_pose(random, reach(random) * a.diagonal());
      const double distance = truth->distance(X_AB).value.distance;
      const double volume = truth->respond(X_AB).value.volume;
      const bool overlap = volume > 1e-4 * hull_a.volume();
      if (!overlap && distance < 1e-3 * a.diagonal()) continue;
      EXPECT_EQ(ab->collide(X_AB).value, overlap) << method;
      EXPECT_EQ(ba->collide(X_AB.inverse()).value, overlap) << method;
      (overlap ? overlapping : apart)++;
    }
    EXPECT_GT(apart, 40);
    EXPECT_GT(overlapping, 40);
  }
}

/// A ball in the hole of a torus.
TEST(CcdHull, SaysYesWhereMeshesAreApart) {
  const Mesh torus = load_model("torus-1k"), ball = sphere_solid(0.2, 12, RoundParts::inscribed, "ball");
  const Pose in_the_hole{Eigen::Matrix3d::Identity(), {0.05, 0.03, 0.02}};
  EXPECT_FALSE(test::prepare(*make_exact_algorithm(), torus, ball)->collide(in_the_hole).value);
  for (const std::string method : {"method=gjk", "method=mpr"}) {
    EXPECT_TRUE(test::prepare(*make_ccd_hull_algorithm(), torus, ball, {method})->collide(in_the_hole).value);
  }
}

TEST(CcdHull, IsLabelledAsAnotherQuestion) {
  const auto algorithm = make_ccd_hull_algorithm();
  EXPECT_EQ(algorithm->traits().body, Body::convex_hull);
  EXPECT_FALSE(algorithm->traits().in_default_runs());
}

TEST(CcdHull, FailsOnAPoseThatIsNotFinite) {
  const Mesh a = load_model("cone-1k");
  const auto algorithm = make_ccd_hull_algorithm();
  const auto query = test::prepare(*algorithm, a, a);
  Pose bad;
  bad.t.y() = std::nan("");
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not finite"));
  EXPECT_TRUE(query->collide(Pose()).value);
  EXPECT_EQ(query->distance(Pose()).status, Status::unsupported);
}

}  // namespace
}  // namespace sixdof
