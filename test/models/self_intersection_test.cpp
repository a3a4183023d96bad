#include <cgal_overlap.h>
#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>
#include <sixdof/models/refine.h>

/// No model's surface intersects itself, by CGAL's exact predicates.
namespace sixdof {
namespace {

std::size_t crossings(const Mesh& mesh) { return reference::count_self_intersections(reference::to_cgal(mesh)); }

TEST(SelfIntersection, NotInRecipes) {
  for (const Recipe& recipe : recipes()) {
    for (const std::size_t triangles : {recipe.minimum, std::size_t{1000}, std::size_t{10'000}}) {
      EXPECT_EQ(crossings(recipe.make(triangles)), 0U) << recipe.name << ' ' << triangles;
    }
  }
}

/// Midpoints of edges are rounded, which could make neighbours cross.
TEST(SelfIntersection, NotInSubdivisions) {
  for (const Recipe& recipe : recipes()) {
    EXPECT_EQ(crossings(subdivide(recipe.make(1000), 5000, "finer")), 0U) << recipe.name;
  }
}

TEST(SelfIntersection, IsFoundInCrossingBoxes) {
  const Mesh block = make_box({.size = {2.0, 1.6, 1.2}}, 12);
  std::vector<Eigen::Vector3d> vertices = block.vertices();
  std::vector<Triangle> triangles = block.triangles();
  const auto count = static_cast<std::uint32_t>(vertices.size());
  for (const Eigen::Vector3d& p : block.vertices()) vertices.push_back(p + Eigen::Vector3d(0.3, 0.5, 0.7));
  for (const Triangle& t : block.triangles()) triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  EXPECT_GT(crossings(Mesh::build(vertices, triangles, "crossing")), 10U);
}

}  // namespace
}  // namespace sixdof
