#include <sixdof/geometry/closest_point.h>

#include <random>

#include <gtest/gtest.h>

#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-14;

double brute_force(const Mesh& mesh, const Eigen::Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles()) {
    const auto& v = mesh.vertices();
    best = std::min(best, triangle_triangle_distance({p, p, p}, {v[t[0]], v[t[1]], v[t[2]]}).distance);
  }
  return best;
}

TEST(ClosestPoint, AgreesWithTheClosestOfAllTriangles) {
  for (const double offset : {0.0, 1e5}) {
    const Mesh base = load_model("torus-knot-1k");
    std::vector<Eigen::Vector3d> vertices = base.vertices();
    for (auto& p : vertices) p += Eigen::Vector3d(offset, -2.0 * offset, 0.5 * offset);
    const Mesh mesh = Mesh::build(vertices, base.triangles());
    const Tree tree(mesh);
    std::mt19937_64 random(51);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 300; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      const Eigen::Vector3d p = mesh.center() + (i % 3 + 0.1) * Eigen::Vector3d(x, y, z);
      const double truth = brute_force(mesh, p);
      const auto found = closest_point(tree, p);
      ASSERT_TRUE(found.has_value());
      const double tolerance = k_rounding * (1.0 + truth + 4.0 * offset);
      EXPECT_NEAR(found->distance, truth, tolerance);
      EXPECT_NEAR((found->point - p).norm(), truth, tolerance);
      const Triangle& t = mesh.triangles()[found->triangle];
      const auto& v = mesh.vertices();
      EXPECT_NEAR(
          triangle_triangle_distance({found->point, found->point, found->point}, {v[t[0]], v[t[1]], v[t[2]]}).distance,
          0.0, tolerance);
      EXPECT_TRUE(closest_point(tree, p, truth * (1.0 + 1e-9) + tolerance).has_value());
      EXPECT_FALSE(closest_point(tree, p, truth * (1.0 - 1e-9) - tolerance).has_value());
    }
  }
}

}  // namespace
}  // namespace sixdof
