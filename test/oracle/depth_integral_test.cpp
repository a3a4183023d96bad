// The law of depth against closed forms, against a plain quadrature that shares nothing with it but the definition, and
// against itself on finer meshes and after a motion.

#include <sixdof/oracle/depth_integral.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/models/recipe.h>

#include "bodies.h"

namespace sixdof {
namespace {

using bodies::box;
using bodies::moved;
using Eigen::Vector3d;

/// Of closed forms; quadratures are asked for a tenth of it, and their estimates are no bounds.
constexpr double k_closed_form = 1e-5;

DepthTolerance within(double relative) { return {.relative = relative, .most_pieces = 2'000'000}; }

/// Any rotation and translation: no axis of the bodies is one of the frame.
Pose generic_motion(std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  return bodies::random_pose(random, 0.7);
}

void expect_near(const Vector3d& measured, const Vector3d& wanted, double tolerance) {
  EXPECT_LE((measured - wanted).norm(), tolerance) << measured.transpose() << "\n" << wanted.transpose();
}

/// A mesh whose triangles are each split into four.
Mesh split(const Mesh& mesh) {
  std::vector<Vector3d> v = mesh.vertices();
  std::vector<Triangle> t;
  for (const Triangle& f : mesh.triangles()) {
    const auto n = static_cast<std::uint32_t>(v.size());  // Mesh::build() welds: both triangles have the same midpoint
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t low = std::min(f[k], f[(k + 1) % 3]), high = std::max(f[k], f[(k + 1) % 3]);
      v.push_back(0.5 * (mesh.vertices()[low] + mesh.vertices()[high]));
    }
    t.insert(t.end(), {{f[0], n, n + 2}, {f[1], n + 1, n}, {f[2], n + 2, n + 1}, {n, n + 1, n + 2}});
  }
  return Mesh::build(std::move(v), std::move(t), mesh.name());
}

/// The law by one point in the middle of each of 4^levels parts of each triangle of B, with distances to all triangles
/// of A and winding numbers by solid angles.
class PlainQuadrature {
 public:
  PlainQuadrature(const Mesh& a, const Mesh& b, const Pose& X, DepthDirection direction, int levels)
      : a_(a), direction_(direction), reference_(X * b.center()) {
    for (const Triangle& t : b.triangles()) {
      add(X * b.vertices()[t[0]], X * b.vertices()[t[1]], X * b.vertices()[t[2]], levels);
    }
  }
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();

 private:
  void add(const Vector3d& u, const Vector3d& v, const Vector3d& w, int levels) {
    if (levels > 0) {
      const Vector3d uv = 0.5 * (u + v), vw = 0.5 * (v + w), wu = 0.5 * (w + u);
      add(u, uv, wu, levels - 1);
      add(v, vw, uv, levels - 1);
      add(w, wu, vw, levels - 1);
      return add(uv, vw, wu, levels - 1);
    }
    const Vector3d p = (u + v + w) / 3.0, area = 0.5 * (v - u).cross(w - u);
    if (!a_.box().contains(p)) return;
    double winding = 0.0;
    Vector3d nearest = Vector3d::Constant(1e9);
    for (const Triangle& t : a_.triangles()) {
      const Vector3d x = a_.vertices()[t[0]] - p, y = a_.vertices()[t[1]] - p, z = a_.vertices()[t[2]] - p;
      const double i = x.norm(), j = y.norm(), k = z.norm();
      winding += std::atan2(x.dot(y.cross(z)), i * j * k + x.dot(y) * k + y.dot(z) * i + z.dot(x) * j);
      const Vector3d on = closest(x, y, z);
      if (on.norm() < nearest.norm()) nearest = on;
    }
    if (winding < std::numbers::pi) return;  // half of the solid angle of a point inside
    const Vector3d f =
        direction_ == DepthDirection::way_out ? Vector3d(area.norm() * nearest) : Vector3d(-nearest.norm() * area);
    force += f;
    torque += (p - reference_).cross(f);
  }

  /// The point of a triangle closest to the origin: on its plane if inside, else on a side.
  static Vector3d closest(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
    const Vector3d n = (y - x).cross(z - x);
    const Vector3d foot = n.dot(x) / n.squaredNorm() * n;
    const std::array<Vector3d, 3> c{x, y, z};
    bool inside = true;
    Vector3d best = Vector3d::Constant(1e9);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d side = c[(k + 1) % 3] - c[k];
      inside = inside && side.cross(foot - c[k]).dot(n) >= 0.0;
      const Vector3d on = c[k] + std::clamp(-c[k].dot(side) / side.squaredNorm(), 0.0, 1.0) * side;
      if (on.squaredNorm() < best.squaredNorm()) best = on;
    }
    return inside ? foot : best;
  }

  const Mesh& a_;
  DepthDirection direction_;
  Vector3d reference_;
};

/// Both meshes in frames of their own: X_AB is that of the bodies as given, seen from there.
struct Turned {
  Turned(const Mesh& mesh_a, const Mesh& mesh_b, const Pose& X)
      : in_a(generic_motion(1)), in_b(generic_motion(2)), a(moved(mesh_a, in_a)), b(moved(mesh_b, in_b)) {
    X_AB = in_a * X * in_b.inverse();
  }
  Pose in_a, in_b;
  Mesh a, b;
  Pose X_AB = {};
};

// A half-space z < 0 as a large box, and a ball of radius r whose centre is c above: F = V e_z, V the volume of the cap
// that is inside, since F = integral of -z (-n) dA over the cap's sphere = integral of grad z over the cap.
TEST(DepthIntegral, OfABallInAHalfSpaceIsTheVolumeOfTheCap) {
  const Mesh a = box({-40.0, -40.0, -80.0}, {40.0, 40.0, 0.0}), b = make_sphere({1.0}, 5120);
  const double c = 0.63;
  const Turned turned(a, b, {generic_motion().R, {0.31, -0.22, c}});
  const DepthOracle oracle(turned.a, turned.b);
  const DepthIntegral found = oracle.evaluate(turned.X_AB, DepthDirection::normal_of_b, within(0.1 * k_closed_form));
  EXPECT_TRUE(found.converged);
  // Of the polyhedron, exactly: overlap volume.
  const bodies::Body body_a(turned.a), body_b(turned.b);
  const double volume = bodies::overlap(body_a, body_b, turned.X_AB).volume;
  expect_near(found.force, turned.in_a.R * Vector3d(0.0, 0.0, volume), k_closed_form * volume);
  // Of the ball, up to its facets.
  const double h = 1.0 - c, cap = std::numbers::pi * h * h * (3.0 - h) / 3.0;
  EXPECT_NEAR(found.force.norm(), cap, 5e-3 * cap);
  EXPECT_NEAR(found.area, 2.0 * std::numbers::pi * h, 1e-2);
  EXPECT_NEAR(found.depth, h, 1e-2 * h);
}

// All directions of the way out are the half-space's normal: F = e_z integral of depth dA, on a sphere 2 pi r times
// the integral of depth over height.
TEST(DepthIntegral, ByTheWayOutOfABallInAHalfSpaceHasAClosedForm) {
  const Mesh a = box({-40.0, -40.0, -80.0}, {40.0, 40.0, 0.0}), b = make_sphere({1.0}, 81'920);
  const double c = 0.4, h = 1.0 - c, wanted = std::numbers::pi * h * h;
  const DepthIntegral found =
      DepthOracle(a, b).evaluate({generic_motion().R, {0.31, -0.22, c}}, DepthDirection::way_out, within(1e-5));
  EXPECT_TRUE(found.converged);
  expect_near(found.force, {0.0, 0.0, wanted}, 1e-3 * wanted);  // facets
  EXPECT_NEAR(found.depth_integral, found.force.norm(), 1e-6 * wanted);
}

// A wedge of angle 2 w with its ridge along x at the origin, opening downwards; a box comes from above, its lower face
// at z = -d and wider than the wedge there. On that face depth(y) = (d tan w - |y|) cos w, the distance to a flank; the
// box's length is l, the wedge is longer. Area 2 d tan w l, mean depth d sin w / 2.
TEST(DepthIntegral, OfABoxOnAWedgeHasAClosedForm) {
  const double w = 0.6, d = 0.2, l = 0.8, deep = 4.0, x = 6.0;
  const double y = deep * std::tan(w);
  const Mesh wedge =
      Mesh::build({{-x, 0, 0}, {x, 0, 0}, {-x, -y, -deep}, {x, -y, -deep}, {-x, y, -deep}, {x, y, -deep}},
                  {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}}, "wedge");
  ASSERT_TRUE(wedge.solid());
  const Mesh b = box({-0.5 * l + 0.07, -1.1, -d}, {0.5 * l + 0.07, 0.9, 1.0});
  const Turned turned(wedge, b, {});
  const DepthIntegral found =
      DepthOracle(turned.a, turned.b).evaluate(turned.X_AB, DepthDirection::normal_of_b, within(0.1 * k_closed_form));
  EXPECT_TRUE(found.converged);
  const double area = 2.0 * d * std::tan(w) * l, force = area * 0.5 * d * std::sin(w);
  expect_near(found.force, turned.in_a.R * Vector3d(0.0, 0.0, force), k_closed_form * force);
  // It acts at (0.07, 0, -d), the centre of the box is at (0.07, -0.1, (1 - d) / 2).
  const Vector3d torque = Vector3d(0.0, 0.1, -d - 0.5 * (1.0 - d)).cross(Vector3d(0.0, 0.0, force));
  expect_near(found.torque, turned.in_a.R * torque, k_closed_form * torque.norm());
  EXPECT_NEAR(found.depth, d * std::sin(w), 1e-3 * d);  // of nodes, none of which is below the ridge
  // The ends of the box are pressed, too, with opposite forces.
  EXPECT_GT(found.area, area);
}

// Two boxes: a corner of B in the middle of a large face of A; B's edges are parallel to A's. Each of B's three faces
// holds a rectangle; that below has the depth d everywhere, the others one from 0 to d.
TEST(DepthIntegral, OfTwoBoxesHasAClosedForm) {
  const double d = 0.3;
  const Mesh a = box({-2.0, -2.0, -2.0}, {2.0, 2.0, 0.0});
  const Mesh b = box({-0.4, -0.5, -d}, {0.7, 0.6, 1.0});
  const Turned turned(a, b, {});
  const DepthIntegral found =
      DepthOracle(turned.a, turned.b).evaluate(turned.X_AB, DepthDirection::normal_of_b, within(0.1 * k_closed_form));
  EXPECT_TRUE(found.converged);
  const double force = 1.1 * 1.1 * d;
  expect_near(found.force, turned.in_a.R * Vector3d(0.0, 0.0, force), k_closed_form * force);
  EXPECT_LE(found.torque.norm(), k_closed_form * force);
  EXPECT_NEAR(found.area, 1.1 * 1.1 + 4.0 * 1.1 * d, 1e-3);
  EXPECT_NEAR(found.depth_integral, force + 4.0 * 1.1 * 0.5 * d * d, k_closed_form);
  EXPECT_NEAR(found.depth, d, 1e-12);
}

// A box with its lower corner outside A's edge: of the face, the part inside has depths up to two of A's faces.
TEST(DepthIntegral, FollowsTheKinkBetweenTwoFaces) {
  const Mesh a = box({-3.0, -2.0, -2.0}, {0.0, 2.0, 0.0});
  const double d = 0.3;
  const Mesh b = box({-0.8, -0.5, -d}, {0.6, 0.7, 1.0});
  const Turned turned(a, b, {});
  const DepthIntegral found =
      DepthOracle(turned.a, turned.b).evaluate(turned.X_AB, DepthDirection::normal_of_b, within(0.1 * k_closed_form));
  EXPECT_TRUE(found.converged);
  // Lower face: depth = min(-x, d) over x in -0.8 .. 0. Face x = -0.8 is min(-z, 0.8) deep: towards +x.
  const double up = 1.2 * (0.5 * d * d + (0.8 - d) * d), along = 1.2 * 0.5 * d * d;
  expect_near(found.force, turned.in_a.R * Vector3d(along, 0.0, up), k_closed_form * up);
}

/// Tolerance of the tests: directions jump between any two faces of A, so that `way_out` costs more.
double usual(DepthDirection direction) { return direction == DepthDirection::way_out ? 4e-3 : 2e-4; }

class DepthDirections : public ::testing::TestWithParam<DepthDirection> {};
INSTANTIATE_TEST_SUITE_P(Both, DepthDirections,
                         ::testing::Values(DepthDirection::normal_of_b, DepthDirection::way_out));

TEST_P(DepthDirections, AgreeWithAPlainQuadrature) {
  const Mesh a = bodies::bumpy_torus(14, 8), b = bodies::bumpy_sphere(2);
  std::mt19937_64 random(11);
  // Where directions jump, between any two faces of A, the plain quadrature's error falls as the size: it is a force
  // somewhere on B's surface, which has a torque of that force times B's size.
  const bool jumps = GetParam() == DepthDirection::way_out;
  for (int i = 0; i < 2; ++i) {
    Pose X = bodies::random_pose(random, 0.1);
    X.t += Vector3d(0.6, 0.1, 0.25);
    const DepthIntegral found = DepthOracle(a, b).evaluate(X, GetParam(), within(jumps ? 3e-3 : 1e-3));
    ASSERT_TRUE(found.converged);
    ASSERT_GT(found.area, 0.02);
    const PlainQuadrature plain(a, b, X, GetParam(), jumps ? 6 : 4);
    const double allowed = jumps ? 1e-2 : 4e-3;
    expect_near(found.force, plain.force, allowed * found.force.norm());
    const double lever = jumps ? 0.5 * b.diagonal() : 0.2;
    expect_near(found.torque, plain.torque, allowed * std::max(found.torque.norm(), lever * found.force.norm()));
  }
}

// The estimate is checked by a far finer quadrature: the error is no larger.
TEST_P(DepthDirections, KeepTheirTolerance) {
  const Mesh a = make_torus_knot({}, 1000), b = make_bumpy_sphere({}, 1000);
  const DepthOracle oracle(a, b);
  std::mt19937_64 random(5);
  for (int i = 0; i < 4; ++i) {
    Pose X = bodies::random_pose(random, 0.2);
    X.t += Vector3d(1.1, 0.8, 0.2);
    const DepthIntegral fine = oracle.evaluate(X, GetParam(), within(usual(GetParam())));
    ASSERT_TRUE(fine.converged);
    for (const double factor : {25.0, 5.0}) {
      const double relative = factor * usual(GetParam());
      const DepthIntegral found = oracle.evaluate(X, GetParam(), within(relative));
      EXPECT_TRUE(found.converged);
      EXPECT_LE(found.force_error, relative * found.force.norm());
      EXPECT_LE((found.force - fine.force).norm(), found.force_error + fine.force_error);
      EXPECT_LE((found.torque - fine.torque).norm(), found.torque_error + fine.torque_error);
      EXPECT_LT(found.pieces, fine.pieces);
    }
  }
}

// Splitting the triangles of either mesh changes no surface.
TEST_P(DepthDirections, DependOnNoTriangulation) {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  Pose X = generic_motion(3);
  X.t = {1.0, 0.7, 0.1};
  const auto at = [&](const Mesh& of_a, const Mesh& of_b) {
    return DepthOracle(of_a, of_b).evaluate(X, GetParam(), within(usual(GetParam())));
  };
  const DepthIntegral found = at(a, b);
  ASSERT_TRUE(found.converged);
  for (const DepthIntegral& other : {at(split(a), b), at(a, split(b)), at(split(a), split(split(b)))}) {
    EXPECT_TRUE(other.converged);
    expect_near(other.force, found.force, found.force_error + other.force_error);
    expect_near(other.torque, found.torque, found.torque_error + other.torque_error);
  }
}

TEST_P(DepthDirections, MoveWithTheBodies) {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  Pose X = generic_motion(4);
  X.t = {1.0, 0.6, 0.2};
  const Turned turned(a, b, X);
  const DepthIntegral found = DepthOracle(a, b).evaluate(X, GetParam(), within(usual(GetParam())));
  const DepthIntegral other =
      DepthOracle(turned.a, turned.b).evaluate(turned.X_AB, GetParam(), within(usual(GetParam())));
  expect_near(other.force, turned.in_a.R * found.force, found.force_error + other.force_error);
  // About the centre of another box.
  const Vector3d torque = found.torque + (found.reference - turned.in_a.inverse() * other.reference).cross(found.force);
  const double lever = (found.reference - turned.in_a.inverse() * other.reference).norm();
  expect_near(other.torque, turned.in_a.R * torque,
              found.torque_error + other.torque_error + lever * found.force_error);
}

// A needle of A between the nodes of a large triangle of B.
TEST(DepthIntegral, SeesASpikeBetweenNodes) {
  const Mesh needle = Mesh::build({{-0.01, -0.01, -1.0}, {0.01, -0.01, -1.0}, {0.0, 0.012, -1.0}, {0.0, 0.0, 0.4}},
                                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, "needle");
  ASSERT_TRUE(needle.solid());
  const Mesh b = box({-0.913, -0.871, 0.0}, {1.117, 1.033, 1.2});
  const DepthIntegral found = DepthOracle(needle, b).evaluate({}, DepthDirection::normal_of_b, within(1e-3));
  EXPECT_TRUE(found.converged);
  const PlainQuadrature plain(needle, box({-0.02, -0.02, 0.0}, {0.02, 0.02, 1.2}), {}, DepthDirection::normal_of_b, 6);
  EXPECT_GT(plain.force.norm(), 0.0);
  expect_near(found.force, plain.force, 0.02 * plain.force.norm());
}

TEST(DepthIntegral, IsTheSameForEveryNumberOfThreads) {
  const Mesh a = make_torus_knot({}, 1000), b = make_bumpy_sphere({}, 1000);
  const DepthOracle oracle(a, b);
  const Pose X{generic_motion(9).R, {1.1, 0.7, 0.2}};
  DepthIntegral one, all;
  parallel::with_threads(1, [&] { one = oracle.evaluate(X); });
  parallel::with_threads(0, [&] { all = oracle.evaluate(X); });
  EXPECT_EQ(one.force, all.force);
  EXPECT_EQ(one.torque, all.torque);
  EXPECT_EQ(one.area, all.area);
  EXPECT_EQ(one.pieces, all.pieces);
}

TEST(DepthIntegral, SaysIfItDidNotConverge) {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  const DepthIntegral found = DepthOracle(a, b).evaluate(
      {generic_motion().R, {1.0, 0.6, 0.2}}, DepthDirection::normal_of_b, {.relative = 1e-6, .most_pieces = 3000});
  EXPECT_FALSE(found.converged);
  EXPECT_LE(found.pieces, 3000u);
  EXPECT_GT(found.force_error, 1e-6 * found.force.norm());
}

TEST(DepthIntegral, OfBodiesApartIsZero) {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  const DepthIntegral found = DepthOracle(a, b).evaluate({generic_motion().R, {4.0, 1.0, 0.3}});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.force, Vector3d::Zero());
  EXPECT_EQ(found.depth, 0.0);
  EXPECT_EQ(found.pieces, 0u);
}

TEST(DepthIntegral, IsOfSolidsOnly) {
  const Mesh solid = box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
  std::vector<Triangle> t = solid.triangles();
  t.pop_back();
  const Mesh open = Mesh::build(solid.vertices(), std::move(t), "open box");
  EXPECT_THROW(DepthOracle(open, solid), BadMesh);
  EXPECT_THROW(DepthOracle(solid, open), BadMesh);
}

}  // namespace
}  // namespace sixdof
