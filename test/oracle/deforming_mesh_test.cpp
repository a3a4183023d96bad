#include <sixdof/oracle/deforming_mesh.h>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/distance.h>

#include "../geometry/shapes.h"
#include "../geometry/tree_check.h"

namespace sixdof {
namespace {

using Vertices = std::vector<Eigen::Vector3d>;

Vertices bent(const Mesh& mesh, double by, double phase) {
  Vertices vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) {
    p += by * Eigen::Vector3d(std::sin(3.1 * p.y() + phase), std::cos(2.3 * p.z()), std::sin(4.7 * p.x() - phase));
  }
  return vertices;
}

/// Rises over a small part.
Vertices dented(const Mesh& mesh, double by) {
  Vertices vertices = mesh.vertices();
  const Eigen::Vector3d top = vertices[17];
  for (Eigen::Vector3d& p : vertices) {
    const double near = std::exp(-60.0 * (p - top).squaredNorm());
    p += by * near * Eigen::Vector3d(std::sin(40.0 * p.x()), std::sin(50.0 * p.y()), std::sin(60.0 * p.z()));
  }
  return vertices;
}

/// All that a scene asks of a pair, to be compared bit for bit.
struct Answers {
  double distance, limited;
  bool meet, nested;
  bool operator==(const Answers&) const = default;
};

Answers ask(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB) {
  NearQuery query;
  NearHint none, other, third;
  return {query.distance(a, b, X_AB, NearQuery::k_no_limit, none).value(),
          query.distance(a, b, X_AB, 0.3, other).value_or(-1.0), query.surfaces_meet(a, b, X_AB, third),
          query.is_nested(a, b, X_AB)};
}

class DeformingMeshTest : public ::testing::Test {
 protected:
  const Mesh a_ = shapes::bumpy_sphere(3, 0.2, 0.7, {0.3, -0.2, 0.9});
  const Mesh partner_ = shapes::bumpy_sphere(2, 0.3, 0.4);

  /// Poses that touch, overlap, are nested, and are apart.
  static Pose pose(shapes::Generator& generator, int i) {
    Pose pose = shapes::random_pose(generator, 1.0);
    pose.t = Eigen::Vector3d(0.3, -0.2, 0.9) + (0.2 * i) * shapes::unit_vector(generator);
    return pose;
  }
};

TEST_F(DeformingMeshTest, AnswersOfEveryUpdateHaveTheBitsOfARebuild) {
  DeformingMesh refitted(a_), updated(a_), rebuilt(a_);
  const PreparedMesh partner(partner_);
  shapes::Generator generator(3);
  for (int frame = 1; frame <= 12; ++frame) {
    const Vertices vertices = bent(a_, 0.03 * frame, 0.2 * frame);
    refitted.refit(vertices);
    updated.note_work(1e9);
    updated.update(vertices);
    rebuilt.rebuild(vertices);
    const DeformingMesh anew(a_.with_vertices(vertices));
    for (int i = 0; i < 12; ++i) {
      const Pose X_AB = pose(generator, i);
      const Answers truth = ask(anew.prepared(), partner, X_AB);
      EXPECT_EQ(ask(rebuilt.prepared(), partner, X_AB), truth);
      EXPECT_EQ(ask(refitted.prepared(), partner, X_AB), truth) << "frame " << frame << ", pose " << i;
      EXPECT_EQ(ask(updated.prepared(), partner, X_AB), truth) << "frame " << frame << ", pose " << i;
      // And as the moving body, against another one that deforms.
      EXPECT_EQ(ask(updated.prepared(), refitted.prepared(), X_AB), ask(anew.prepared(), rebuilt.prepared(), X_AB));
    }
  }
  EXPECT_EQ(refitted.built_triangles(), 0u);
  EXPECT_GT(updated.built_triangles(), 0u);
}

TEST_F(DeformingMeshTest, AnswersAreThoseOfTheMesh) {
  DeformingMesh deforming(a_);
  const Mesh moved = a_.with_vertices(bent(a_, 0.2, 1.0));
  deforming.refit(moved.vertices());
  EXPECT_EQ(deforming.solid(), moved.solid());
  const DistanceOracle oracle(moved, partner_);
  DistanceQuery query(oracle);
  const PreparedMesh partner(partner_);
  shapes::Generator generator(4);
  for (int i = 0; i < 40; ++i) {
    const Pose X_AB = pose(generator, i % 12);
    const Answers here = ask(deforming.prepared(), partner, X_AB);
    // The width of ties, of which a mesh that deforms always has one: 1e-14 of the sizes.
    EXPECT_NEAR(here.distance, query.distance(X_AB).distance, 1e-13);
    EXPECT_EQ(here.meet || here.nested, query.collide(X_AB));
  }
}

TEST_F(DeformingMeshTest, FlatPartsDoNotDependOnThePartition) {
  // A plate whose middle rises: parts stay flat, so that thousands of distances tie.
  shapes::Generator generator(5);
  Vertices vertices;
  std::vector<Triangle> triangles;
  constexpr std::uint32_t k_cells = 24;
  for (std::uint32_t j = 0; j <= k_cells; ++j) {
    for (std::uint32_t i = 0; i <= k_cells; ++i) {
      vertices.emplace_back(i / 24.0, j / 24.0, 0.3);
      if (i == k_cells || j == k_cells) continue;
      const std::uint32_t v = j * (k_cells + 1) + i, w = v + k_cells + 1;
      triangles.push_back({v, v + 1, w + 1});
      triangles.push_back({v, w + 1, w});
    }
  }
  const Mesh plate = Mesh::build(vertices, triangles);
  DeformingMesh refitted(plate);
  const PreparedMesh partner(plate);
  for (const double by : {0.05, 0.1, 0.4}) {
    Vertices moved = plate.vertices();
    for (Eigen::Vector3d& p : moved) {
      const double r = (p - Eigen::Vector3d(0.5, 0.5, 0.3)).squaredNorm();
      if (r < 0.04) p += by * Eigen::Vector3d(p.y(), -p.x(), 0.04 - r);
    }
    refitted.refit(moved);
    const DeformingMesh anew(plate.with_vertices(moved));
    for (const double height : {0.1, 0.25}) {
      const Pose X_AB{Eigen::Matrix3d::Identity(), {0.013, 0.021, height}};
      EXPECT_EQ(ask(refitted.prepared(), partner, X_AB), ask(anew.prepared(), partner, X_AB));
    }
    const Pose turned = shapes::random_pose(generator, 1.0);
    EXPECT_EQ(ask(refitted.prepared(), partner, turned), ask(anew.prepared(), partner, turned));
  }
}

TEST_F(DeformingMeshTest, BoundsHowFarItsPointsHaveMoved) {
  DeformingMesh deforming(a_);
  for (const double by : {1e-9, 1e-3, 0.4}) {
    const Vertices before(deforming.vertices().begin(), deforming.vertices().end()), after = bent(a_, by, 0.7);
    double largest = 0.0;
    for (std::size_t i = 0; i < after.size(); ++i) largest = std::max(largest, (after[i] - before[i]).norm());
    const double bound = deforming.refit(after);
    EXPECT_GE(bound, largest);
    EXPECT_LT(bound, largest * (1.0 + 1e-12) + 1e-14);
  }
}

TEST_F(DeformingMeshTest, RuleBuildsNothingWhereVolumesDoNotGrow) {
  DeformingMesh deforming(a_);
  Vertices vertices = a_.vertices();
  for (int frame = 0; frame < 20; ++frame) {
    for (Eigen::Vector3d& p : vertices) p *= 1.01;
    deforming.note_work(1e6);
    deforming.update(vertices);
  }
  EXPECT_EQ(deforming.built_triangles(), 0u);
}

TEST_F(DeformingMeshTest, RuleWaitsUntilTheWorkWastedPaysForBuilding) {
  const Vertices vertices = bent(a_, 0.5, 0.3);
  DeformingMesh idle(a_), busy(a_);
  for (int frame = 0; frame < 20; ++frame) {
    idle.update(vertices);
    busy.note_work(1e9);
    busy.update(vertices);
  }
  EXPECT_EQ(idle.built_triangles(), 0u);
  EXPECT_GT(busy.built_triangles(), 0u);
  // Once all is built where it is now, part after part, there is nothing to gain.
  const std::uint64_t built = busy.built_triangles();
  for (int frame = 0; frame < 20; ++frame) {
    busy.note_work(1e9);
    busy.update(vertices);
  }
  EXPECT_EQ(busy.built_triangles(), built);
}

TEST_F(DeformingMeshTest, RuleBuildsThePartThatDeforms) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.1);
  DeformingMesh deforming(mesh);
  deforming.refit(dented(mesh, 0.5));
  deforming.note_work(1e9);
  const Mesh moved = mesh.with_vertices(dented(mesh, 0.5));
  deforming.update(moved.vertices());
  EXPECT_GT(deforming.built_triangles(), 0u);
  EXPECT_LT(2 * deforming.built_triangles(), mesh.triangles().size());
  check_tree(moved, deforming.prepared().tree());
}

TEST_F(DeformingMeshTest, IsMadeFreshOnlyIfItIsNot) {
  DeformingMesh deforming(a_);
  deforming.make_fresh();
  EXPECT_EQ(deforming.built_triangles(), 0u);
  deforming.refit(bent(a_, 0.1, 0.2));
  deforming.make_fresh();
  EXPECT_EQ(deforming.built_triangles(), a_.triangles().size());
}

TEST_F(DeformingMeshTest, IsNoBodyWhenTurnedInsideOut) {
  DeformingMesh deforming(a_);
  EXPECT_TRUE(deforming.solid());
  Vertices vertices = a_.vertices();
  for (Eigen::Vector3d& p : vertices) p.x() = -p.x();
  deforming.refit(vertices);
  EXPECT_FALSE(deforming.solid());
}

TEST_F(DeformingMeshTest, RefusesWhatHasNoRoomAndKeepsItsVertices) {
  DeformingMesh deforming(a_);
  Vertices vertices = a_.vertices();
  for (Eigen::Vector3d& p : vertices) p *= 1e30;
  EXPECT_THROW(deforming.refit(vertices), BadMesh);
  EXPECT_THROW(deforming.rebuild(vertices), BadMesh);
  EXPECT_EQ(deforming.vertices()[5], a_.vertices()[5]);
  check_tree(a_, deforming.prepared().tree());
}

}  // namespace
}  // namespace sixdof
