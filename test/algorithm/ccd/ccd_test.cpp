#include <sixdof/algorithm/ccd/ccd.h>

#include <sixdof/base/error.h>

#include "../hull_checks.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // of a sum over some triangles, of a volume of 48

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
  EXPECT_NEAR(convex_hull(box).volume(), 48.0, k_rounding);
}

TEST(ConvexHull, RefusesAFlatMesh) {
  const Mesh flat = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}, "flat");
  EXPECT_THROW(convex_hull(flat), BadMesh);
}

TEST(CcdHull, AnswersForTheHulls) {
  for (const std::string method : {"method=gjk", "method=mpr"}) {
    test::expect_answers_for_hulls(*make_ccd_hull_algorithm(), {method});
    test::expect_yes_where_meshes_are_apart(*make_ccd_hull_algorithm(), {method});
  }
}

TEST(CcdHull, IsLabelledAndFailsOnAPoseThatIsNotFinite) { test::expect_hull_manners(*make_ccd_hull_algorithm()); }

}  // namespace
}  // namespace sixdof
