#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>

#include "bodies.h"

/// Poses at which predicates tie: equal faces, shared vertices, touching, slivers, duplicates; and lengths far from 1.
namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rounding of integrals over bodies of size 1.
constexpr double k_rounding = 1e-14;

Pose shift(const Vector3d& t) { return {Matrix3d::Identity(), t}; }

/// The 24 rotations that map axes to axes.
std::vector<Matrix3d> right_angles() {
  std::vector<Matrix3d> result;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x == y) continue;
      for (const double sx : {-1.0, 1.0}) {
        for (const double sy : {-1.0, 1.0}) {
          Matrix3d R = Matrix3d::Zero();
          R(x, 0) = sx;
          R(y, 1) = sy;
          R.col(2) = R.col(0).cross(R.col(1));
          result.push_back(R);
        }
      }
    }
  }
  return result;
}

double interval_overlap(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

/// Of axis-parallel boxes, in closed form.
double box_overlap(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  Eigen::AlignedBox3d moved(Vector3d(X_AB * b.box().min()));
  moved.extend(X_AB * b.box().max());
  double v = 1.0;
  for (int k = 0; k < 3; ++k) v *= interval_overlap(a.box().min()[k], a.box().max()[k], moved.min()[k], moved.max()[k]);
  return v;
}

/// A corner of a box that is barely under another one's face, far from where curves usually are: the force's direction
/// is the face's normal, and both orders have one area.
TEST(OverlapDegenerate, ACornerJustUnderAFaceIsPushedAlongItsNormal) {
  const Body large(bodies::box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6})),
      small(bodies::box({-0.35, -0.25, -0.2}, {0.35, 0.25, 0.2}));
  const Matrix3d R = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.41).normalized().toRotationMatrix();
  double low = 0.0;
  for (const Vector3d& p : small.mesh.vertices()) low = std::min(low, (R * p).z());
  for (const double depth : {1e-6, 1e-8, 4e-10}) {
    const Pose X{R, {0.21, -0.13, 0.6 - low - depth}};
    const Overlap one = bodies::overlap(large, small, X), other = bodies::overlap(small, large, X.inverse());
    // Ends of segments are off by a few 1e-16, the sides of the cap are as long as it is deep at least.
    const double allowed = 1e-14 / depth;
    ASSERT_GT(one.area.norm(), 0.0);
    EXPECT_LT((one.area.normalized() + Vector3d::UnitZ()).norm(), allowed) << depth;
    EXPECT_LT((R * other.area + one.area).norm() / one.area.norm(), allowed) << depth;
  }
}

TEST(OverlapDegenerate, ABodyAndItself) {
  const Body box(bodies::box({-0.51, -0.32, -0.43}, {0.37, 0.61, 0.29}));
  const Body sphere(bodies::bumpy_sphere(3)), torus(bodies::bumpy_torus(24, 12));
  std::mt19937_64 random(8);
  for (const Body* body : {&box, &sphere, &torus}) {
    OverlapQuery query(body->solid, body->solid);
    const double whole = body->mesh.volume();
    const double area = body->mesh.area();
    for (const double s : {0.0, 1e-16, 1e-12, 1e-6}) {
      for (int i = 0; i < 5; ++i) {
        const Vector3d u = bodies::random_pose(random, 1.0).R.col(1);
        const Overlap o = query.evaluate(shift(s * u));
        // Half of the projected area, both ways, is swept out of the intersection; at most the area's quarter.
        EXPECT_NEAR(o.volume, whole, k_rounding + 0.5 * area * s);
        EXPECT_LE(o.volume, whole + k_rounding);
        EXPECT_LT((o.centroid - body->mesh.centroid()).norm(), 1e-12 + 2.0 * s);
      }
    }
    // The same body under another rotation of both: equal vertices up to rounding.
    for (int i = 0; i < 5; ++i) {
      const Pose X_AB = bodies::random_pose(random, 0.5);
      const Body moved(bodies::moved(body->mesh, X_AB));
      EXPECT_NEAR(bodies::overlap(moved, *body, X_AB).volume, whole, k_rounding);
      EXPECT_NEAR(bodies::overlap(*body, moved, X_AB.inverse()).volume, whole, k_rounding);
    }
  }
}

TEST(OverlapDegenerate, BoxesAtRightAngles) {
  const Body a(bodies::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Body same(bodies::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, true));
  const Body flat(bodies::box({-0.5, -0.25, -0.125}, {0.5, 0.25, 0.375}, true));
  for (const Matrix3d& R : right_angles()) {
    for (const Body* b : {&a, &same, &flat}) {
      // Lattice shifts: faces, edges and vertices coincide, or the boxes only touch.
      for (int i = 0; i < 27; ++i) {
        const Vector3d t = 0.25 * Vector3d(i % 3, i / 3 % 3, i / 9) * (i % 2 ? 2.0 : 1.0);
        const Pose X_AB{R, t};
        const double truth = box_overlap(a.mesh, b->mesh, X_AB);
        EXPECT_NEAR(bodies::overlap(a, *b, X_AB).volume, truth, k_rounding) << i;
        EXPECT_NEAR(bodies::overlap(*b, a, X_AB.inverse()).volume, truth, k_rounding) << i;
      }
    }
  }
}

TEST(OverlapDegenerate, AMeshRotatedByRightAnglesIntoItself) {
  // The octahedron's sphere without bumps maps to itself, triangles to triangles.
  const Body sphere(bodies::bumpy_sphere(3, 0.0));
  for (const Matrix3d& R : right_angles()) {
    EXPECT_NEAR(bodies::overlap(sphere, sphere, {R, Vector3d::Zero()}).volume, sphere.mesh.volume(), k_rounding);
  }
}

TEST(OverlapDegenerate, BodiesThatTouchHaveNothingInCommon) {
  const Body a(bodies::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Body b(bodies::box({-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}));
  for (const double sign : {-1.0, 1.0}) {
    for (const Vector3d& t : {Vector3d(0.75, 0.125, 0.0625), Vector3d(0.0, 0.75, 0.25), Vector3d(0.25, 0.25, 0.75),
                              Vector3d(0.75, 0.75, 0.125), Vector3d(0.0, 0.75, 0.75), Vector3d(0.75, 0.75, 0.75),
                              Vector3d(1.0, 0.0, 0.0)}) {
      // Exact zero within the rounding of two faces' worth of terms.
      EXPECT_NEAR(bodies::overlap(a, b, shift(sign * t)).volume, 0.0, k_rounding) << t.transpose();
      EXPECT_NEAR(bodies::overlap(b, a, shift(sign * t)).volume, 0.0, k_rounding) << t.transpose();
    }
  }
  // A vertex on a face, an edge across an edge, an edge on a face: a box on its corner and on its edge.
  const Matrix3d on_edge = Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3d::UnitY()).toRotationMatrix();
  const Body diamond(Mesh::build(
      {{0.5, 0.0, 0.0}, {-0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, -0.5, 0.0}, {0.0, 0.0, 0.5}, {0.0, 0.0, -0.5}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}, "diamond"));
  EXPECT_NEAR(bodies::overlap(a, diamond, shift({0.125, 0.25, 1.0})).volume, 0.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(diamond, a, shift({0.0, 0.0, -1.0})).volume, 0.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(diamond, diamond, shift({0.0, 1.0, 0.0})).volume, 0.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(diamond, diamond, shift({0.5, 0.5, 0.0})).volume, 0.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(a, b, {on_edge, {0.0, 0.0, 0.5 + 0.25 * std::sqrt(2.0)}}).volume, 0.0, k_rounding);
}

TEST(OverlapDegenerate, NestedBodies) {
  const Body outer(bodies::bumpy_torus(40, 20)), inner(bodies::bumpy_sphere(3, 0.1, 0.1));
  const Body box(bodies::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}));
  const Pose X_AB = shift({0.49, 0.03, 0.02});
  const Overlap o = bodies::overlap(outer, inner, X_AB);
  EXPECT_NEAR(o.volume, inner.mesh.volume(), k_rounding);
  EXPECT_LT((o.centroid - (X_AB * inner.mesh.centroid())).norm(), 1e-12);
  EXPECT_EQ(o.area, Vector3d::Zero());
  EXPECT_NEAR(bodies::overlap(inner, outer, X_AB.inverse()).volume, inner.mesh.volume(), k_rounding);
  EXPECT_NEAR(bodies::overlap(box, outer, shift({0.2, 0.03, 0.02})).volume, outer.mesh.volume(), k_rounding);
  EXPECT_NEAR(bodies::overlap(outer, inner, shift({0.02, 0.03, 0.02})).volume, 0.0, k_rounding);  // in the hole
  // Nested and touching from inside: one face, and one vertex.
  const Body half(bodies::box({0.0, -0.5, -0.5}, {1.0, 0.5, 0.5}));
  EXPECT_NEAR(bodies::overlap(box, half, Pose{}).volume, half.mesh.volume(), k_rounding);
  EXPECT_NEAR(bodies::overlap(half, box, Pose{}).volume, half.mesh.volume(), k_rounding);
}

TEST(OverlapDegenerate, SliversAndFlatTriangles) {
  // A box whose top carries a vertex in the middle of an edge (a triangle with collinear corners) and needles.
  const Mesh plain = bodies::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  std::vector<Vector3d> p = plain.vertices();
  std::vector<Triangle> t = plain.triangles();
  for (const double where : {0.0, 1e-9, 0.25}) {
    // Split the first triangle's first side only on one side of the edge; a flat triangle closes the gap.
    const Triangle f = t[0];
    const auto n = static_cast<std::uint32_t>(p.size());
    p.push_back(p[f[0]] + (0.5 + where) * (p[f[1]] - p[f[0]]));
    t[0] = {f[0], n, f[2]};
    t.push_back({n, f[1], f[2]});
    t.push_back({f[0], f[1], n});  // no area
  }
  const Body split(Mesh::build(p, t, "split box"));
  ASSERT_TRUE(split.mesh.solid()) << split.mesh.why_not_solid();
  EXPECT_GE(split.mesh.repairs().zero_area_triangles.size(), 2u);
  const Body box(plain), torus(bodies::bumpy_torus(24, 12));
  std::mt19937_64 random(12);
  for (int i = 0; i < 60; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    EXPECT_NEAR(bodies::overlap(split, torus, X_AB).volume, bodies::overlap(box, torus, X_AB).volume, k_rounding);
    EXPECT_NEAR(bodies::overlap(torus, split, X_AB).volume, bodies::overlap(torus, box, X_AB).volume, k_rounding);
    EXPECT_NEAR(bodies::overlap(split, split, X_AB).volume, bodies::overlap(box, box, X_AB).volume, k_rounding);
  }
  for (const Matrix3d& R : right_angles()) {
    const Pose X_AB{R, {0.25, 0.5, 0.0}};
    EXPECT_NEAR(bodies::overlap(split, split, X_AB).volume, 0.375, k_rounding);
  }
}

TEST(OverlapDegenerate, DuplicateTrianglesAndBodiesThatShareAnEdge) {
  const Mesh plain = bodies::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  // A triangle twice more, once each way: a pocket without volume. Its edges have four triangles.
  std::vector<Triangle> t = plain.triangles();
  const Triangle f = t[3];
  t.push_back(f);
  t.push_back({f[1], f[0], f[2]});
  const Body pocket(Mesh::build(plain.vertices(), t, "pocket"));
  // Two boxes with a common edge.
  const Body twins(bodies::together(plain, bodies::moved(plain, shift({1.0, 1.0, 0.0}))));
  ASSERT_GT(pocket.mesh.topology().nonmanifold_edges, 0u);
  ASSERT_GT(twins.mesh.topology().nonmanifold_edges, 0u);
  // The same box twice: a body of winding number 2.
  const Body box(plain);
  const Body torus(bodies::bumpy_torus(24, 12));
  std::mt19937_64 random(13);
  for (int i = 0; i < 60; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    const double truth = bodies::overlap(torus, box, X_AB).volume;
    EXPECT_NEAR(bodies::overlap(torus, pocket, X_AB).volume, truth, k_rounding);
    Pose second = X_AB;
    second.t += X_AB.R * Vector3d(1.0, 1.0, 0.0);
    EXPECT_NEAR(bodies::overlap(torus, twins, X_AB).volume, truth + bodies::overlap(torus, box, second).volume,
                k_rounding);
  }
  EXPECT_NEAR(bodies::overlap(pocket, pocket, Pose{}).volume, 1.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(twins, twins, Pose{}).volume, 2.0, k_rounding);
  EXPECT_NEAR(bodies::overlap(twins, twins, shift({1.0, 1.0, 0.0})).volume, 1.0, k_rounding);
}

TEST(OverlapDegenerate, AnyScale) {
  std::mt19937_64 random(21);
  const Mesh sphere = bodies::bumpy_sphere(3), torus = bodies::bumpy_torus(24, 12);
  const Body a(sphere), b(torus);
  for (int i = 0; i < 10; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Overlap unit = bodies::overlap(a, b, X_AB);
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
      const Body scaled_a(bodies::moved(sphere, Pose{}, scale)), scaled_b(bodies::moved(torus, Pose{}, scale));
      const Overlap o = bodies::overlap(scaled_a, scaled_b, {X_AB.R, scale * X_AB.t});
      EXPECT_NEAR(o.volume / (scale * scale * scale), unit.volume, k_rounding);
      EXPECT_LT((o.area / (scale * scale) - unit.area).norm(), k_rounding);
      EXPECT_LT((o.moment / (scale * scale * scale) - unit.moment).norm(), k_rounding);
    }
    // A large body against a small one.
    const Body grain(bodies::moved(torus, Pose{}, 1e-6));
    const Pose at_surface{X_AB.R, sphere.vertices()[17] + 1e-7 * X_AB.t};
    const Overlap o = bodies::overlap(a, grain, at_surface);
    EXPECT_GT(o.crossings, 0u);
    EXPECT_GT(o.volume, 0.0);
    EXPECT_LT(o.volume, grain.mesh.volume());
  }
}

TEST(OverlapDegenerate, ErrorGrowsLinearlyWithTheOffset) {
  // Vertices at distance D are rounded to D * 1e-16, which moves the surfaces by as much.
  std::mt19937_64 random(22);
  const Mesh sphere = bodies::bumpy_sphere(3), torus = bodies::bumpy_torus(24, 12);
  const Body a(sphere), b(torus);
  for (int i = 0; i < 10; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Overlap truth = bodies::overlap(a, b, X_AB);
    for (const double offset : {1e2, 1e4, 1e6}) {
      // Offsets are whole numbers of a coarse grid, so that moving the mesh there is all that rounds.
      const Vector3d there(offset, -0.5 * offset, 0.25 * offset);
      const double tolerance = k_rounding + 4e-16 * offset * std::min(sphere.area(), torus.area());
      const auto compare = [&](const Overlap& o, const Vector3d& shifted_by) {
        EXPECT_NEAR(o.volume, truth.volume, tolerance) << offset;
        EXPECT_LT((o.centroid - truth.centroid - shifted_by).norm() * truth.volume, 4.0 * tolerance) << offset;
      };
      const Body far_a(bodies::moved(sphere, shift(there)));
      compare(bodies::overlap(far_a, b, {X_AB.R, X_AB.t + there}), there);
      const Body far_b(bodies::moved(torus, shift(there)));
      compare(bodies::overlap(a, far_b, {X_AB.R, X_AB.t - X_AB.R * there}), Vector3d::Zero());
    }
  }
}

}  // namespace
}  // namespace sixdof
