#include <sixdof/oracle/support_bound.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/models/recipe.h>

#include "../geometry/shapes.h"

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;
using shapes::Generator;

double farthest(const Mesh& mesh, const Vector3d& d) {
  double best = -1e300;
  for (const Vector3d& p : mesh.vertices()) best = std::max(best, d.dot(p - mesh.center()));
  return best;
}

SupportBound bound_of(const Mesh& mesh) { return SupportBound(Tree(mesh)); }

/// Of the surfaces, by all pairs of triangles.
double distance_by_all_pairs(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  double least = 1e300;
  for (const Triangle& s : a.triangles()) {
    for (const Triangle& t : b.triangles()) {
      const auto corner = [&](std::size_t k) { return Vector3d(X_AB * b.vertices()[t[k]]); };
      least = std::min(least, triangle_triangle_distance({a.vertices()[s[0]], a.vertices()[s[1]], a.vertices()[s[2]]},
                                                         {corner(0), corner(1), corner(2)})
                                  .distance);
    }
  }
  return least;
}

TEST(SupportBound, IsNeverBelowTheFarthestVertexAndLittleAboveIt) {
  Generator generator(3);
  const Mesh meshes[] = {shapes::bumpy_sphere(3, 0.3), make_sphere({}, 1280), shapes::rod(12, 0.1),
                         shapes::moved(shapes::box({0.5, 0.4, 0.01}), shapes::random_pose(generator, 30.0)),
                         make_torus({}, 2000)};
  for (const Mesh& mesh : meshes) {
    const SupportBound bound = bound_of(mesh);
    double sum = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3d d = shapes::uniform(generator, 0.1, 3.0) * shapes::unit_vector(generator);
      const SupportBound::Support support = bound.along(d);
      const double truth = farthest(mesh, d), scale = d.norm() * bound.radius();
      EXPECT_GE(support.height, truth - 1e-14 * scale) << mesh.name() << i;
      // h changes by no more than the radius times the distance of directions. That of the four grid directions is at
      // most 0.36 on average, weighted, and half of it is seen, at kinks of thin boxes.
      EXPECT_LE(support.height, truth + 0.2 * scale) << mesh.name() << i;
      EXPECT_NEAR(d.dot(support.point), support.height, 1e-13 * scale);
      sum += (support.height - truth) / scale;
    }
    EXPECT_LT(sum / 3000.0, 0.025) << mesh.name();
  }
}

TEST(SupportBound, OfABoxIsThatOfItsCorners) {
  const Mesh mesh = shapes::box({0.5, 0.4, 0.3}, {7.0, -2.0, 1.0});
  Generator generator(4);
  const SupportBound by_tree = bound_of(mesh), by_box(mesh.box());
  for (int i = 0; i < 1000; ++i) {
    const Vector3d d = shapes::unit_vector(generator);
    EXPECT_NEAR(by_tree.along(d).height, farthest(mesh, d), 1e-6);
    EXPECT_NEAR(by_box.along(d).height, farthest(mesh, d), 1e-6);
  }
  EXPECT_LT((by_tree.half() - Vector3d(0.5, 0.4, 0.3)).norm(), 1e-14);
  EXPECT_NEAR(by_box.radius(), by_tree.radius(), 1e-6);
}

TEST(CertainlyApart, NeverWhereSurfacesTouchOrNestAndInBothOrders) {
  Generator generator(5);
  const Mesh meshes[] = {shapes::bumpy_sphere(1, 0.3), shapes::rod(6, 0.1), shapes::box({0.9, 0.01, 0.6}),
                         shapes::box({0.5, 0.5, 0.5}, {3.0, 0.0, 0.0}), shapes::soup(generator, 40, 0.8, 0.3)};
  int apart = 0, together = 0;
  for (int i = 0; i < 2000; ++i) {
    const Mesh &a = meshes[i % 5], &b = meshes[(i / 5) % 5];
    Pose X_AB = shapes::random_pose(generator, 0.0);
    const double size = 0.5 * (a.diagonal() + b.diagonal());
    X_AB.t =
        a.center() + shapes::uniform(generator, 0.0, 1.3) * size * shapes::unit_vector(generator) - X_AB.R * b.center();
    const SupportBound of_a = bound_of(a), of_b = bound_of(b);
    const bool is_apart = certainly_apart(of_a, of_b, X_AB);
    const bool either_order = is_apart || certainly_apart(of_b, of_a, X_AB.inverse());
    ++(either_order ? apart : together);
    if (either_order) EXPECT_GT(distance_by_all_pairs(a, b, X_AB), 0.0) << i;
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(together, 500);
  const SupportBound large = bound_of(make_sphere({.radius = 2.0}, 320)),
                     small = bound_of(make_sphere({.radius = 0.3}, 80));
  EXPECT_FALSE(certainly_apart(large, small, {.t = {0.8, 0.0, 0.0}}));
  EXPECT_FALSE(certainly_apart(small, large, {.t = {-0.8, 0.0, 0.0}}));
}

/// How close convex bodies may be and are still told apart.
TEST(CertainlyApart, BallsPlatesAndCubesAtTwoPercentOfTheirDiagonal) {
  Generator generator(6);
  const SupportBound ball = bound_of(make_sphere({}, 1280));
  for (int i = 0; i < 200; ++i) {
    Pose X_AB = shapes::random_pose(generator, 0.0);
    X_AB.t = (1.0 + 0.02 * std::sqrt(3.0)) * 2.0 * ball.radius() * shapes::unit_vector(generator);
    EXPECT_TRUE(certainly_apart(ball, ball, X_AB)) << i;
  }
  for (const Mesh& mesh : {shapes::box({0.9, 0.01, 0.6}), shapes::box({0.5, 0.5, 0.5})}) {
    const SupportBound bound = bound_of(mesh);
    int told = 0;
    for (int i = 0; i < 200; ++i) {
      Pose X_AB = shapes::random_pose(generator, 0.0);
      const Vector3d way = shapes::unit_vector(generator);
      double low = 0.0, high = 2.0 * mesh.diagonal();
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        X_AB.t = middle * way;
        (distance_by_all_pairs(mesh, mesh, X_AB) < 0.02 * mesh.diagonal() ? low : high) = middle;
      }
      X_AB.t = high * way;
      told += certainly_apart(bound, bound, X_AB);
    }
    EXPECT_GT(told, 190) << mesh.diagonal();
  }
}

TEST(CertainlyApart, BoxesFaceToFaceAtTheGapOfContacts) {
  const Mesh cube = shapes::box({0.5, 0.5, 0.5}), plate = shapes::box({0.3, 0.9, 0.2}, {40.0, 0.0, 0.0});
  const SupportBound of_cube = bound_of(cube), of_plate = bound_of(plate);
  for (const double angle : {0.0, 0.3, 1.2}) {
    const auto at = [&](double gap) {
      Pose X_AB{Eigen::AngleAxisd(angle, Vector3d::UnitX()).matrix(), {0.8 + gap, 0.0, 0.0}};
      X_AB.t -= X_AB.R * plate.center();
      return X_AB;
    };
    EXPECT_TRUE(certainly_apart(of_cube, of_plate, at(1e-11)));
    EXPECT_TRUE(certainly_apart(of_plate, of_cube, at(1e-11).inverse()));
    EXPECT_FALSE(certainly_apart(of_cube, of_plate, at(0.0)));
    EXPECT_FALSE(certainly_apart(of_plate, of_cube, at(-1e-9).inverse()));
  }
}

TEST(CertainlyApart, MatricesThatAreRotationsUpToRounding) {
  const SupportBound cube = bound_of(shapes::box({0.5, 0.5, 0.5}));
  // B reaches 2e-10 farther than a cube that is turned only.
  const Eigen::Matrix3d R = (1.0 + 4e-10) * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(certainly_apart(cube, cube, {R, {1.0 + 1e-10, 0.0, 0.0}}));
  EXPECT_TRUE(certainly_apart(cube, cube, {R, {1.0 + 3e-10, 0.0, 0.0}}));
}

TEST(CertainlyApart, SaysNothingWithoutABoundOrOfCoordinatesThatOverflow) {
  const SupportBound cube = bound_of(shapes::box({0.5, 0.5, 0.5}));
  EXPECT_FALSE(certainly_apart(SupportBound(), cube, {.t = {9.0, 0.0, 0.0}}));
  EXPECT_TRUE(certainly_apart(cube, cube, {.t = {9.0, 0.0, 0.0}}));
  EXPECT_TRUE(certainly_apart(cube, cube, {.t = {1e100, 0.0, 0.0}}));
  EXPECT_FALSE(certainly_apart(cube, cube, {.t = {std::nan(""), 0.0, 0.0}}));
  EXPECT_FALSE(certainly_apart(cube, cube, {}));
}

}  // namespace
}  // namespace sixdof::detail
