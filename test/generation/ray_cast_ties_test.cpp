#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/generation/ray_cast_traversal.h>
#include <sixdof/models/model_catalogue.h>

#include "../configuration/shapes.h"

namespace sixdof::ray_cast {
namespace {

using test::random_direction;
using test::random_rotation;

/// What heights may be off, in units of the tree's radius: k_height_room and k_height_rounding. It is less than the
/// half of what ties may be off (k_cast_tie) that cuts leave.
constexpr double k_same_height = 3e-15;
constexpr std::uint64_t k_plenty = 1'000'000'000;

CastTree turned(const Mesh& mesh, const Eigen::Matrix3d& M) {
  CastTree tree(std::make_shared<CastMesh>(std::make_shared<Tree>(mesh)));
  tree.turn(M);
  return tree;
}

Eigen::Matrix3d random_turn(std::mt19937_64& random) {
  const Eigen::Vector4d q = random_rotation(random);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// The least axis . p over the triangles below a child, one by one.
double least_height(const CastTree& tree, std::size_t node_and_lane, const Eigen::Vector3d& axis) {
  const Tree& below = tree.mesh().tree();
  const Tree::Child child = below.nodes()[node_and_lane / Tree::k_width].child[node_and_lane % Tree::k_width];
  const std::uint32_t first = child.is_leaf() ? child.first() : below.nodes()[child.node()].first_triangle;
  const std::uint32_t count = child.is_leaf() ? child.count() : below.nodes()[child.node()].triangle_count;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = first; t < first + count; ++t) {
    for (const Eigen::Vector3d& corner : tree.triangle(t)) least = std::min(least, axis.dot(corner));
  }
  return least;
}

/// All children of all nodes, in some order: what one finds the others may use.
std::vector<std::size_t> children_of(const CastTree& tree, std::mt19937_64& random) {
  std::vector<std::size_t> children;
  for (std::size_t node = 0; node < tree.nodes().size(); ++node) {
    for (std::size_t lane = 0; lane < tree.nodes()[node].child_count; ++lane) {
      children.push_back(Tree::k_width * node + lane);
    }
  }
  std::shuffle(children.begin(), children.end(), random);
  return children;
}

struct Body {
  Mesh mesh;
  /// Along which its faces, edges or corners tie.
  std::vector<Eigen::Vector3d> axes;
};

std::vector<Body> bodies(std::mt19937_64& random) {
  const std::vector<Eigen::Vector3d> right{Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY(),
                                           Eigen::Vector3d::UnitZ(), Eigen::Vector3d(1.0, 0.0, -1.0).normalized()};
  std::vector<Body> all;
  for (const char* name : {"box-2000", "circular-box-1000", "torus-2000", "bumpy-sphere-600"}) {
    all.push_back({load_model(name), right});
  }
  // Far from the frame's origin, too.
  all.push_back({test::boxes_mesh({{{30.1, -20.2, 10.3}, {1.0, 0.7, 1e-3}}}, "plate"), right});
  for (Body& body : all) {
    for (int i = 0; i < 3; ++i) body.axes.push_back(random_direction(random));
  }
  return all;
}

TEST(CastSupports, FindTheLeastHeightOfEverySubtree) {
  std::mt19937_64 random(61);
  for (const Body& body : bodies(random)) {
    const Eigen::Matrix3d R = random_turn(random);
    for (const Eigen::Matrix3d& M : {Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), R}) {
      const CastTree tree = turned(body.mesh, M);
      CastSupports supports(tree);
      for (const Eigen::Vector3d& of_mesh : body.axes) {
        const Eigen::Vector3d axis = (M * of_mesh).normalized();
        supports.set_axis(axis);
        for (const std::size_t child : children_of(tree, random)) {
          std::uint64_t credit = k_plenty;
          ASSERT_NEAR(supports.lowest(child, credit), least_height(tree, child, axis), k_same_height * tree.radius())
              << body.mesh.name() << ", child " << child << ", axis " << of_mesh.transpose();
        }
      }
    }
  }
}

TEST(CastSupports, AreNeverTooHighWhereCreditRunsOut) {
  std::mt19937_64 random(62);
  int short_of_credit = 0;
  for (const Body& body : bodies(random)) {
    const Eigen::Matrix3d R = random_turn(random);
    const CastTree tree = turned(body.mesh, R);
    CastSupports supports(tree);
    for (const Eigen::Vector3d& of_mesh : body.axes) {
      const Eigen::Vector3d axis = (R * of_mesh).normalized();
      for (const std::uint64_t most : {3u, 10u, 70u, 90u}) {
        supports.set_axis(axis);
        for (const std::size_t child : children_of(tree, random)) {
          std::uint64_t credit = most;
          const std::uint64_t before = supports.looked_at();
          const double low = supports.lowest(child, credit);
          EXPECT_LE(credit, most);
          EXPECT_LE(supports.looked_at() - before, most + Tree::k_width);  // a node's children are looked at together
          const double least = least_height(tree, child, axis);
          EXPECT_LE(low, least + k_same_height * tree.radius()) << body.mesh.name() << ", child " << child;
          if (std::isfinite(low) && low < least - k_same_height * tree.radius()) ++short_of_credit;
        }
      }
    }
  }
  EXPECT_GT(short_of_credit, 0);
}

TEST(CastSupports, TakeAFractionOfTheTriangles) {
  const Mesh box = load_model("box-20000");
  const CastTree tree = turned(box, -Eigen::Matrix3d::Identity());
  std::mt19937_64 random(63);
  std::vector<Eigen::Vector3d> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                    Eigen::Vector3d(0.6, 0.0, -0.8)};
  for (int i = 0; i < 10; ++i) axes.push_back(random_direction(random));
  CastSupports supports(tree);
  std::uint64_t before = 0;
  for (const Eigen::Vector3d& axis : axes) {
    supports.set_axis(axis);
    for (std::size_t lane = 0; lane < tree.nodes()[0].child_count; ++lane) {
      std::uint64_t credit = k_plenty;
      supports.lowest(lane, credit);
    }
    // Counts, the same on every machine: at most 249 here.
    EXPECT_LT(supports.looked_at() - before, box.triangles().size() / 40) << axis.transpose();
    before = supports.looked_at();
  }
}

TEST(CastTies, FindTheLeastHeightOfDifferences) {
  std::mt19937_64 random(64);
  const Mesh a = load_model("circular-box-1000");
  const Mesh b = load_model("box-2000");
  const CastTree tree_a = turned(a, -Eigen::Matrix3d::Identity());
  const CastTree tree_b = turned(b, random_turn(random));
  const double size = tree_a.radius() + tree_b.radius();
  CastTies ties(tree_a, tree_b);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d axis = random_direction(random);
    for (std::size_t lane_a = 0; lane_a < tree_a.nodes()[0].child_count; ++lane_a) {
      for (std::size_t lane_b = 0; lane_b < tree_b.nodes()[0].child_count; ++lane_b) {
        const double low = least_height(tree_a, lane_a, axis) + least_height(tree_b, lane_b, axis);
        EXPECT_NEAR(ties.lowest(lane_a, lane_b, axis, k_plenty), low, k_same_height * size);
      }
    }
  }
}

}  // namespace
}  // namespace sixdof::ray_cast
