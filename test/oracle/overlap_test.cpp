#include <sixdof/oracle/overlap.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "bodies.h"
#include "convex.h"
#include "instruction_sets.h"

namespace sixdof {
namespace {

constexpr double k_curvature_rounding = 1e-14;  // of a sum over the edges of the overlap

using bodies::Body;
using Eigen::Vector3d;

/// Rounding of integrals over bodies of size 1: some dozens of terms of 1e-16 each, relative to the bodies, not to
/// their overlap.
constexpr double k_rounding = 1e-14;
/// The same for thousands of terms.
constexpr double k_rounding_of_many = 2e-14;

Mesh tetrahedron(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-0.6, 0.6);
  std::vector<Vector3d> p;
  for (int i = 0; i < 4; ++i) p.emplace_back(u(random), u(random), u(random));
  if ((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) > 0.0) std::swap(p[1], p[2]);
  return Mesh::build(p, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}, "tetrahedron");
}

void expect_closed_form(const Body& a, const Body& b, const Pose& X_AB) {
  const Overlap o = bodies::overlap(a, b, X_AB);
  const convex::Common truth = convex::intersect(a.mesh, b.mesh, X_AB);
  EXPECT_NEAR(o.volume, truth.volume, k_rounding);
  EXPECT_LT((o.area - truth.area).norm(), k_rounding);
  EXPECT_LT((o.moment - (truth.moment - o.reference.cross(truth.area))).norm(), k_rounding);
  if (truth.volume > 0.0) {
    EXPECT_LT((o.centroid * o.volume - truth.first).norm(), k_rounding);
  }
}

TEST(Overlap, BoxesEqualClippingInClosedForm) {
  std::mt19937_64 random(20261121);
  const Body a(bodies::box({-0.51, -0.32, -0.43}, {0.37, 0.61, 0.29}));
  const Body b(bodies::box({-0.33, -0.42, -0.23}, {0.47, 0.31, 0.39}, true));
  for (int i = 0; i < 500; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.6);
    expect_closed_form(a, b, X_AB);
    expect_closed_form(b, a, X_AB);
  }
}

TEST(Overlap, TetrahedraEqualClippingInClosedForm) {
  std::mt19937_64 random(4);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Body a(tetrahedron(random)), b(tetrahedron(random));
    const Pose X_AB = bodies::random_pose(random, 0.3);
    expect_closed_form(a, b, X_AB);
    met += bodies::overlap(a, b, X_AB).volume > 0.0;
  }
  EXPECT_GT(met, 100);
}

class OverlapOfMeshes : public testing::Test {
 protected:
  Body sphere{bodies::bumpy_sphere(4)};
  Body torus{bodies::bumpy_torus(48, 20)};
  std::mt19937_64 random{99};
};

TEST_F(OverlapOfMeshes, VolumeEqualsTheMethodOfColumns) {
  for (int i = 0; i < 12; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    EXPECT_NEAR(bodies::overlap(sphere, torus, X_AB).volume, overlap_volume_by_columns(sphere.mesh, torus.mesh, X_AB),
                k_rounding_of_many);
    EXPECT_NEAR(bodies::overlap(torus, torus, X_AB).volume, overlap_volume_by_columns(torus.mesh, torus.mesh, X_AB),
                k_rounding_of_many);
  }
}

TEST_F(OverlapOfMeshes, ExchangeOfTheBodies) {
  for (int i = 0; i < 50; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    const Pose X_BA = X_AB.inverse();
    const Overlap ab = bodies::overlap(sphere, torus, X_AB);
    const Overlap ba = bodies::overlap(torus, sphere, X_BA);
    EXPECT_NEAR(ab.volume, ba.volume, k_rounding_of_many);
    // The surface of the intersection is closed: what is B's faces in one order is minus A's faces in the other.
    EXPECT_LT((ab.area + X_AB.R * ba.area).norm(), k_rounding_of_many);
    const Vector3d moment_about_origin = ab.moment + ab.reference.cross(ab.area);
    const Vector3d other = X_AB.R * ba.moment + (X_AB * ba.reference).cross(X_AB.R * ba.area);
    EXPECT_LT((moment_about_origin + other).norm(), k_rounding_of_many);
    if (ab.volume > 1e-3) {
      EXPECT_LT((ab.centroid - X_AB * ba.centroid).norm(), 1e3 * k_rounding_of_many);
    }
  }
}

TEST_F(OverlapOfMeshes, ABodyOfTwoPartsOverlapsAsItsPartsDo) {
  // Split along a plane into two boxes that share a face, and two pieces of one mesh far apart.
  const Body left(bodies::box({-0.41, -0.23, -0.31}, {0.07, 0.37, 0.29}));
  const Body right(bodies::box({0.07, -0.23, -0.31}, {0.53, 0.37, 0.29}, true));
  const Body whole(bodies::box({-0.41, -0.23, -0.31}, {0.53, 0.37, 0.29}));
  const Body far(bodies::moved(sphere.mesh, {Eigen::Matrix3d::Identity(), {0.9, 0.1, 0.2}}, 0.5));
  const Body near(bodies::moved(torus.mesh, {Eigen::Matrix3d::Identity(), {-0.3, 0.0, 0.1}}, 0.6));
  const Body both(bodies::together(far.mesh, near.mesh));
  const auto sum_is = [&](const Body& one, const Body& other, const Body& all, const Pose& X_AB) {
    const Overlap x = bodies::overlap(torus, one, X_AB), y = bodies::overlap(torus, other, X_AB);
    const Overlap z = bodies::overlap(torus, all, X_AB);
    EXPECT_NEAR(x.volume + y.volume, z.volume, k_rounding_of_many);
    EXPECT_LT((x.area + y.area - z.area).norm(), k_rounding_of_many);
    const auto about_origin = [](const Overlap& o) -> Vector3d { return o.moment + o.reference.cross(o.area); };
    EXPECT_LT((about_origin(x) + about_origin(y) - about_origin(z)).norm(), k_rounding_of_many);
  };
  for (int i = 0; i < 30; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    sum_is(left, right, whole, X_AB);
    sum_is(far, near, both, X_AB);
    // The body that is split may be the fixed one as well.
    EXPECT_NEAR(bodies::overlap(left, torus, X_AB).volume + bodies::overlap(right, torus, X_AB).volume,
                bodies::overlap(whole, torus, X_AB).volume, k_rounding_of_many);
  }
}

TEST_F(OverlapOfMeshes, VertexOrderChangesAnswersByRoundingOnly) {
  std::vector<Vector3d> vertices = torus.mesh.vertices();
  std::vector<Triangle> triangles = torus.mesh.triangles();
  std::vector<std::uint32_t> new_index(vertices.size());
  for (std::uint32_t i = 0; i < new_index.size(); ++i) new_index[i] = i;
  std::shuffle(new_index.begin(), new_index.end(), random);
  for (std::uint32_t i = 0; i < new_index.size(); ++i) vertices[new_index[i]] = torus.mesh.vertices()[i];
  for (Triangle& t : triangles) t = {new_index[t[1]], new_index[t[2]], new_index[t[0]]};
  std::shuffle(triangles.begin(), triangles.end(), random);
  const Body shuffled(Mesh::build(vertices, triangles, "shuffled torus"));
  for (int i = 0; i < 30; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    const Overlap x = bodies::overlap(sphere, torus, X_AB), y = bodies::overlap(sphere, shuffled, X_AB);
    EXPECT_NEAR(x.volume, y.volume, k_rounding_of_many);
    EXPECT_LT((x.moment - y.moment).norm(), k_rounding_of_many);
    EXPECT_EQ(x.crossings, y.crossings);
  }
}

/// Error of the central difference of V along a motion of B, against the derivative `exact`.
template <class Move>
double difference_error(OverlapQuery& query, const Move& move, double step, double exact) {
  const double slope = (query.evaluate(move(step)).volume - query.evaluate(move(-step)).volume) / (2.0 * step);
  return std::abs(slope - exact);
}

struct Errors {
  std::vector<double> coarse_to_fine, finest;
};

void expect_second_order(Errors errors) {
  std::sort(errors.coarse_to_fine.begin(), errors.coarse_to_fine.end());
  std::sort(errors.finest.begin(), errors.finest.end());
  // Halving the step quarters the error of a second-order formula; at some poses a vertex passes a face in between.
  const double median = errors.coarse_to_fine[errors.coarse_to_fine.size() / 2];
  EXPECT_GT(median, 3.5);
  EXPECT_LT(median, 4.5);
  // Third derivatives of some tens times step^2.
  EXPECT_LT(errors.finest[errors.finest.size() / 2], 1e-6);
}

void expect_gradient(const Body& a, const Body& b, unsigned seed) {
  constexpr double k_step = 0x1p-10;
  std::mt19937_64 random(seed);
  OverlapQuery query(a.solid, b.solid);
  Errors of_area, of_moment;
  while (of_area.finest.size() < 31) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Vector3d u = bodies::random_pose(random, 1.0).R.col(0);
    const Vector3d about(0.3, -0.2, 0.7);
    const Overlap o = query.evaluate(X_AB, about);
    if (o.crossings == 0) continue;
    const auto translate = [&](double s) { return Pose{X_AB.R, X_AB.t + s * u}; };
    const auto rotate = [&](double s) {
      const Eigen::Matrix3d R = Eigen::AngleAxisd(s, u).toRotationMatrix();
      return Pose{R * X_AB.R, about + R * (X_AB.t - about)};
    };
    const auto record = [&](Errors& errors, const auto& move, double exact) {
      const double coarse = difference_error(query, move, 4.0 * k_step, exact);
      const double fine = difference_error(query, move, 2.0 * k_step, exact);
      errors.coarse_to_fine.push_back(coarse / fine);
      errors.finest.push_back(difference_error(query, move, k_step, exact));
    };
    record(of_area, translate, o.area.dot(u));
    record(of_moment, rotate, o.moment.dot(u));
  }
  expect_second_order(of_area);
  expect_second_order(of_moment);
}

TEST(Overlap, AreaAndMomentAreTheGradientOfVolume) {
  const Body a(bodies::box({-0.51, -0.32, -0.43}, {0.37, 0.61, 0.29}));
  const Body b(bodies::box({-0.33, -0.42, -0.23}, {0.47, 0.31, 0.39}, true));
  expect_gradient(a, b, 11);
}

TEST_F(OverlapOfMeshes, AreaAndMomentAreTheGradientOfVolume) {
  expect_gradient(sphere, torus, 12);
  expect_gradient(torus, sphere, 13);
}

/// The overlap with its curvature along u.
Overlap curved(OverlapQuery& query, const Body& a, const Body& b, const Pose& X_AB, const Vector3d& u) {
  CandidateScratch scratch;
  std::vector<TrianglePair> pairs;
  find_candidates(a.tree, b.tree, X_AB, scratch, pairs);
  return query.evaluate(X_AB, Vector3d::Zero(), pairs, u);
}

TEST(Overlap, CurvatureOfBoxesInClosedForm) {
  // Edges of the overlap: x + t u_x, y + t u_y, z + t u_z.
  const Body a(bodies::box({-1.0, -1.0, -1.0}, {0.0, 0.0, 0.0})), b(bodies::box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
  const Vector3d edges(0.31, 0.42, 0.27), u = Vector3d(-2, 1, 3).normalized();
  const Pose X_AB{Eigen::Matrix3d::Identity(), -edges};
  const Pose X_BA{Eigen::Matrix3d::Identity(), edges};
  const double expected = 2.0 * (u.x() * u.y() * edges.z() + u.y() * u.z() * edges.x() + u.z() * u.x() * edges.y());
  OverlapQuery query(a.solid, b.solid), exchanged(b.solid, a.solid);
  EXPECT_NEAR(curved(query, a, b, X_AB, u).curvature, expected, k_curvature_rounding);
  EXPECT_NEAR(curved(exchanged, b, a, X_BA, u).curvature, expected, k_curvature_rounding);
  EXPECT_EQ(curved(query, a, b, X_AB, Vector3d::Zero()).curvature, 0.0);
}

/// The curvature against central differences of the gradient.
void expect_curvature(const Body& a, const Body& b, unsigned seed) {
  constexpr double k_step = 0x1p-20;
  std::mt19937_64 random(seed);
  OverlapQuery query(a.solid, b.solid);
  std::vector<double> errors;
  while (errors.size() < 31) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Vector3d u = bodies::random_pose(random, 1.0).R.col(0);
    const Overlap o = curved(query, a, b, X_AB, u);
    if (o.crossings == 0) continue;
    const auto slope = [&](double s) { return query.evaluate({X_AB.R, X_AB.t + s * u}).area.dot(u); };
    errors.push_back(std::abs((slope(k_step) - slope(-k_step)) / (2.0 * k_step) - o.curvature));
  }
  std::sort(errors.begin(), errors.end());
  // At some poses a vertex passes a face in between. The median of lengths of about 1 is rounded by 1e-16 / step.
  EXPECT_LT(errors[errors.size() / 2], 1e-8);
}

TEST_F(OverlapOfMeshes, CurvatureIsTheSecondDerivativeOfVolume) {
  expect_curvature(sphere, torus, 14);
  expect_curvature(torus, sphere, 15);
}

TEST(Overlap, ErrorIsRelativeToTheTrianglesThatAreCrossed) {
  // A vertex inside a face. The error is that of fluxes through the triangles that are crossed, which have size 1 here,
  // however small the volume is.
  constexpr double k_crossed_area_rounding = 2e-16;
  const Body a(bodies::box({-0.51, -0.32, -0.43}, {0.37, 0.61, 0.29}));
  const Body b(bodies::box({-0.33, -0.42, -0.23}, {0.47, 0.31, 0.39}, true));
  std::mt19937_64 random(77);
  for (int i = 0; i < 40; ++i) {
    Pose X_AB = bodies::random_pose(random, 0.0);
    // B's vertex of least z just below the middle of A's upper face.
    Vector3d low = Vector3d::Constant(1e9);
    for (const Vector3d& v : b.mesh.vertices()) {
      if ((X_AB.R * v).z() < low.z()) low = X_AB.R * v;
    }
    for (const double depth : {1e-2, 1e-4, 1e-6}) {
      X_AB.t = Vector3d(0.031, 0.077, 0.29 - depth) - low;
      const double truth = convex::intersect(a.mesh, b.mesh, X_AB).volume;
      EXPECT_NEAR(bodies::overlap(a, b, X_AB).volume, truth, k_crossed_area_rounding) << depth;
      EXPECT_NEAR(bodies::overlap(b, a, X_AB.inverse()).volume, truth, k_crossed_area_rounding) << depth;
    }
  }
}

TEST_F(OverlapOfMeshes, SolidsAreSharedByThreads) {
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(bodies::random_pose(random, 0.5));
  std::vector<double> truth;
  for (const Pose& X_AB : poses) truth.push_back(bodies::overlap(sphere, torus, X_AB).volume);
  std::vector<std::vector<double>> found(4);
  {
    std::vector<std::jthread> threads;
    for (std::vector<double>& mine : found) {
      threads.emplace_back([&] {
        OverlapQuery query(sphere.solid, torus.solid);
        for (const Pose& X_AB : poses) mine.push_back(query.evaluate(X_AB).volume);
      });
    }
  }
  for (const std::vector<double>& mine : found) EXPECT_EQ(mine, truth);
}

TEST_F(OverlapOfMeshes, QueriesReuseTheirScratch) {
  OverlapQuery query(sphere.solid, torus.solid);
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(bodies::random_pose(random, 0.5));
  for (const Pose& X_AB : poses) query.evaluate(X_AB);
  const std::size_t bytes = query.bytes();
  for (const Pose& X_AB : poses) query.evaluate(X_AB);
  EXPECT_EQ(query.bytes(), bytes);
  EXPECT_GT(bytes, 0u);
}

TEST(Overlap, SurfacesThatDoNotIntersectHaveNoGradient) {
  // A cavity: a small sphere inside out within a big one. A body inside the cavity has nothing in common with the
  // shell; one around the cavity has all but the cavity.
  const Mesh inner = bodies::bumpy_sphere(2, 0.1, 0.3);
  const Body shell(bodies::together(bodies::bumpy_sphere(3, 0.05, 1.0), bodies::inside_out(inner)));
  const Body mote(bodies::bumpy_sphere(2, 0.1, 0.1));
  const Body filler(bodies::bumpy_sphere(3, 0.1, 0.6));
  std::mt19937_64 random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.05);
    for (const bool shell_is_a : {true, false}) {
      const auto both = [&](const Body& other) {
        return shell_is_a ? bodies::overlap(shell, other, X_AB) : bodies::overlap(other, shell, X_AB);
      };
      const Overlap floating = both(mote);
      EXPECT_NEAR(floating.volume, 0.0, k_rounding);
      EXPECT_EQ(floating.crossings, 0u);
      const Overlap filling = both(filler);
      EXPECT_NEAR(filling.volume, filler.mesh.volume() - inner.volume(), k_rounding);
      EXPECT_EQ(filling.area, Vector3d::Zero());
      EXPECT_EQ(filling.moment, Vector3d::Zero());
    }
  }
}

TEST_F(OverlapOfMeshes, AnswersAreTheSameBitsOnEveryInstructionSetAndInEveryOrder) {
  std::vector<Pose> poses;
  for (int i = 0; i < 20; ++i) poses.push_back(bodies::random_pose(random, 0.5));
  OverlapQuery query(sphere.solid, torus.solid);
  const Vector3d u = Vector3d(3, -1, 2).normalized();
  std::vector<Overlap> truth;
  std::vector<double> curvatures;
  for (const Pose& X_AB : poses) {
    truth.push_back(query.evaluate(X_AB));
    curvatures.push_back(curved(query, sphere, torus, X_AB, u).curvature);
  }
  const int sets = for_each_instruction_set([&] {
    for (std::size_t i = poses.size(); i-- > 0;) {
      const Overlap o = query.evaluate(poses[i]);
      EXPECT_EQ(o.volume, truth[i].volume);
      EXPECT_EQ(o.area, truth[i].area);
      EXPECT_EQ(o.moment, truth[i].moment);
      EXPECT_EQ(o.crossings, truth[i].crossings);
      EXPECT_EQ(curved(query, sphere, torus, poses[i], u).curvature, curvatures[i]);
    }
  });
  EXPECT_GE(sets, 2);  // at least a SIMD and a scalar path
}

TEST(Overlap, MeshesThatAreNotSolidAreRefused) {
  Mesh open = bodies::bumpy_sphere(2);
  std::vector<Triangle> t = open.triangles();
  t.pop_back();
  const Mesh with_hole = Mesh::build(open.vertices(), t, "hole");
  const Tree tree(with_hole);
  try {
    const Solid solid(with_hole, tree);
    FAIL() << "an open mesh was accepted";
  } catch (const BadMesh& e) {
    EXPECT_EQ(std::string(e.what()), "hole: " + with_hole.why_not_solid() + k_repair_hint);
  }
  t = open.triangles();
  std::swap(t[5][0], t[5][1]);
  const Mesh flipped = Mesh::build(open.vertices(), t, "flipped");
  const Tree flipped_tree(flipped);
  EXPECT_THROW(Solid(flipped, flipped_tree), BadMesh);
}

TEST(Overlap, PosesThatAreNotFiniteAreRefused) {
  const Body a(bodies::bumpy_sphere(1));
  OverlapQuery query(a.solid, a.solid);
  Pose X_AB;
  X_AB.t.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(query.evaluate(X_AB), BadArgument);
  X_AB.t.x() = 1e300;  // finite, however far: apart
  EXPECT_EQ(query.evaluate(X_AB).volume, 0.0);
}

}  // namespace
}  // namespace sixdof
