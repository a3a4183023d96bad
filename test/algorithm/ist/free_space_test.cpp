#include <sixdof/algorithm/ist/free_space.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/geometry/closest_point.h>
#include <sixdof/models/model_catalogue.h>
#include "random_spheres.h"

namespace sixdof::ist {
namespace {

/// A clearance by a search of all spheres and triangles.
double clearance_by_brute_force(const FreeSpace& space, const Eigen::Vector3d& p, double bound) {
  double least = bound;
  for (const Sphere& s : space.spheres.spheres()) least = std::min(least, (s.center - p).norm() - s.radius);
  for (const Tree::Corners& t : space.tree.corners()) {
    least = std::min(least, (closest_point_on_triangle(p, t) - p).norm());
  }
  return least;
}

/// Walks whose steps are about as long as the bounds, through few large triangles and through many small ones, with and
/// without spheres.
TEST(ClearanceQuery, OnWalksIsThatOfBruteForce) {
  std::size_t surface = 0, sphere = 0, none = 0;
  for (const char* name : {"torus-200", "torus-knot-2k"}) {
    const Mesh mesh = load_model(name);
    const Tree tree(mesh);
    const double size = 0.5 * mesh.diagonal();
    for (const std::size_t spheres : {0u, 300u}) {
      FreeSpace space{tree, SphereIndex(mesh.diagonal())};
      for (const Sphere& s : random_spheres(spheres, 5)) {
        space.spheres.insert({mesh.center() + size * s.center, 0.1 * size * s.radius});
      }
      Draws draws(7);
      ClearanceQuery query(space);
      for (int walk = 0; walk < 200; ++walk) {
        Eigen::Vector3d p = mesh.center() + draws.point(size);
        const double scale = size * std::pow(10.0, draws.uniform(-3.0, 0.0));
        query.reset();
        for (int step = 0; step < 20; ++step) {
          const double bound = scale * draws.uniform(0.1, 1.0);
          const auto found = query(p, bound);
          ASSERT_EQ(found.value, clearance_by_brute_force(space, p, bound)) << name << ", " << walk << ", " << step;
          if (found.value == bound) {
            ++none;
          } else {
            ++(found.obstacle.radius > 0.0 ? sphere : surface);
          }
          p += draws.uniform(0.0, 1.0) * draws.point(scale);
        }
      }
    }
  }
  EXPECT_GT(surface, 500u);
  EXPECT_GT(sphere, 500u);
  EXPECT_GT(none, 1000u);
}

TEST(ClearanceQuery, SeesASphereThatWasInsertedAfterAReset) {
  const Mesh mesh = load_model("torus-200");
  const Tree tree(mesh);
  FreeSpace space{tree, SphereIndex(mesh.diagonal())};
  ClearanceQuery query(space);
  const Eigen::Vector3d p = mesh.vertices()[0];
  EXPECT_EQ(query(p, 1.0).value, 0.0);
  const Eigen::Vector3d q = mesh.center();
  const double before = query(q, mesh.diagonal()).value;
  space.spheres.insert({q + Eigen::Vector3d(0.5 * before, 0.0, 0.0), 0.25 * before});
  query.reset();
  EXPECT_EQ(query(q, mesh.diagonal()).value, 0.25 * before);
}

}  // namespace
}  // namespace sixdof::ist
