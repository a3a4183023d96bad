#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/generation/ray_cast_search.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/models/model_catalogue.h>

#include "../configuration/shapes.h"

namespace sixdof::ray_cast {
namespace {

using test::random_direction;
using test::random_rotation;

/// Error of support values, in units of the tree's radius: k_support_tolerance and k_support_rounding. Less than half
/// of k_cast_tie, which culls allow for.
constexpr double k_support_error = 3e-15;
constexpr std::uint64_t k_plenty = 1'000'000'000;

CastTree transformed(const Mesh& mesh, const Eigen::Matrix3d& M) {
  CastTree tree(std::make_shared<CastMesh>(std::make_shared<Tree>(mesh)));
  tree.transform(M);
  return tree;
}

Eigen::Matrix3d random_matrix(std::mt19937_64& random) {
  const Eigen::Vector4d q = random_rotation(random);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// The least axis . p over the triangles below a child, one by one.
double least_projection(const CastTree& tree, std::size_t slot, const Eigen::Vector3d& axis) {
  const Tree& below = tree.mesh().tree();
  const Tree::Child child = below.nodes()[slot / Tree::k_width].child[slot % Tree::k_width];
  const std::uint32_t first = child.is_leaf() ? child.first() : below.nodes()[child.node()].first_triangle;
  const std::uint32_t count = child.is_leaf() ? child.count() : below.nodes()[child.node()].triangle_count;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = first; t < first + count; ++t) {
    for (const Eigen::Vector3d& corner : tree.triangle(t)) least = std::min(least, axis.dot(corner));
  }
  return least;
}

/// The slots of all children of all nodes, shuffled: values found for one may be used for others.
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
  /// Along some of them its faces, edges or corners tie.
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

TEST(TreeSupport, FindsTheSupportValueOfEverySubtree) {
  std::mt19937_64 random(61);
  for (const Body& body : bodies(random)) {
    const Eigen::Matrix3d R = random_matrix(random);
    for (const Eigen::Matrix3d& M : {Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), R}) {
      const CastTree tree = transformed(body.mesh, M);
      TreeSupport support(tree);
      for (const Eigen::Vector3d& of_mesh : body.axes) {
        const Eigen::Vector3d axis = (M * of_mesh).normalized();
        support.set_axis(axis);
        for (const std::size_t child : children_of(tree, random)) {
          std::uint64_t budget = k_plenty;
          ASSERT_NEAR(support.support_value(child, budget), least_projection(tree, child, axis),
                      k_support_error * tree.radius())
              << body.mesh.name() << ", child " << child << ", axis " << of_mesh.transpose();
        }
      }
    }
  }
}

TEST(TreeSupport, IsNeverTooLargeWhereTheBudgetRunsOut) {
  std::mt19937_64 random(62);
  int cut_short = 0;
  for (const Body& body : bodies(random)) {
    const Eigen::Matrix3d R = random_matrix(random);
    const CastTree tree = transformed(body.mesh, R);
    TreeSupport support(tree);
    for (const Eigen::Vector3d& of_mesh : body.axes) {
      const Eigen::Vector3d axis = (R * of_mesh).normalized();
      for (const std::uint64_t most : {3u, 10u, 70u, 90u}) {
        support.set_axis(axis);
        for (const std::size_t child : children_of(tree, random)) {
          std::uint64_t budget = most;
          const std::uint64_t before = support.evaluations();
          const double value = support.support_value(child, budget);
          EXPECT_LE(budget, most);
          // The children of a node are evaluated together.
          EXPECT_LE(support.evaluations() - before, most + Tree::k_width);
          const double least = least_projection(tree, child, axis);
          EXPECT_LE(value, least + k_support_error * tree.radius()) << body.mesh.name() << ", child " << child;
          if (std::isfinite(value) && value < least - k_support_error * tree.radius()) ++cut_short;
        }
      }
    }
  }
  EXPECT_GT(cut_short, 0);
}

TEST(TreeSupport, EvaluatesAFractionOfTheTriangles) {
  const Mesh box = load_model("box-20000");
  const CastTree tree = transformed(box, -Eigen::Matrix3d::Identity());
  std::mt19937_64 random(63);
  std::vector<Eigen::Vector3d> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                    Eigen::Vector3d(0.6, 0.0, -0.8)};
  for (int i = 0; i < 10; ++i) axes.push_back(random_direction(random));
  TreeSupport support(tree);
  std::uint64_t before = 0;
  for (const Eigen::Vector3d& axis : axes) {
    support.set_axis(axis);
    for (std::size_t lane = 0; lane < tree.nodes()[0].child_count; ++lane) {
      std::uint64_t budget = k_plenty;
      support.support_value(lane, budget);
    }
    // Counts are the same on every machine: at most 249.
    EXPECT_LT(support.evaluations() - before, box.triangles().size() / 40) << axis.transpose();
    before = support.evaluations();
  }
}

TEST(DifferenceSupport, FindsTheSupportValueOfDifferences) {
  std::mt19937_64 random(64);
  const Mesh a = load_model("circular-box-1000");
  const Mesh b = load_model("box-2000");
  const CastTree tree_a = transformed(a, -Eigen::Matrix3d::Identity());
  const CastTree tree_b = transformed(b, random_matrix(random));
  const double size = tree_a.radius() + tree_b.radius();
  DifferenceSupport support(tree_a, tree_b);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d axis = random_direction(random);
    for (std::size_t lane_a = 0; lane_a < tree_a.nodes()[0].child_count; ++lane_a) {
      for (std::size_t lane_b = 0; lane_b < tree_b.nodes()[0].child_count; ++lane_b) {
        const double expected = least_projection(tree_a, lane_a, axis) + least_projection(tree_b, lane_b, axis);
        EXPECT_NEAR(support.support_value(lane_a, lane_b, axis, k_plenty), expected, k_support_error * size);
      }
    }
  }
}

/// The least distance of the triangles below two children, B's translated by t u.
double least_distance(const Cast& cast, std::size_t a, std::size_t b, double t) {
  const auto triangles_below = [](const CastTree& tree, std::size_t slot) {
    const Tree& below = tree.mesh().tree();
    const Tree::Child child = below.nodes()[slot / Tree::k_width].child[slot % Tree::k_width];
    const std::uint32_t first = child.is_leaf() ? child.first() : below.nodes()[child.node()].first_triangle;
    const std::uint32_t count = child.is_leaf() ? child.count() : below.nodes()[child.node()].triangle_count;
    std::vector<TriangleCorners> list;
    for (std::uint32_t i = first; i < first + count; ++i) list.push_back(tree.triangle(i));
    return list;
  };
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleCorners& reflected : triangles_below(cast.a, a)) {
    for (TriangleCorners moved : triangles_below(cast.b, b)) {
      for (Eigen::Vector3d& corner : moved) corner += t * cast.direction;
      const TriangleCorners from{-reflected[0], -reflected[1], -reflected[2]};
      least = std::min(least, triangle_triangle_distance(from, moved).distance);
    }
  }
  return least;
}

TEST(SeparatedInDouble, HoldsForAllTrianglesAndLargerTranslations) {
  std::mt19937_64 random(65);
  const Mesh a = load_model("bumpy-sphere-600");
  const Mesh b = load_model("torus-2000");
  const CastTree tree_a = transformed(a, -Eigen::Matrix3d::Identity());
  const CastTree tree_b = transformed(b, random_matrix(random));
  const std::vector<std::size_t> of_a = children_of(tree_a, random), of_b = children_of(tree_b, random);
  int separated = 0, hits = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    Cast cast(tree_a, tree_b);
    const auto slot_a = static_cast<std::uint32_t>(of_a[i % of_a.size()]);
    const auto slot_b = static_cast<std::uint32_t>(of_b[(7 * i) % of_b.size()]);
    const auto is_leaf = [](const CastTree& tree, std::size_t slot) {
      return child_of(tree.nodes()[slot / Tree::k_width], slot % Tree::k_width).is_leaf();
    };
    if (is_leaf(tree_a, slot_a) != is_leaf(tree_b, slot_b)) continue;
    cast.direction = random_direction(random);
    cast.target = (i % 2 == 0 ? 0.2 : 1e-3) * a.diagonal();
    cast.best = {.translation = 0.1 * static_cast<double>(i % 8) * a.diagonal(),
                 .pair = TrianglePair{0, 0},
                 .axis = random_direction(random),
                 .separating_axis = cast.direction};
    const bool is_separated = separated_in_double(cast, slot_a, slot_b);
    double least = std::numeric_limits<double>::infinity();
    for (const double later : {0.0, 0.05, 0.2, 0.5, 1.0}) {
      least = std::min(least, least_distance(cast, slot_a, slot_b, cast.best.translation + later * a.diagonal()));
    }
    if (is_separated) {
      ++separated;
      ASSERT_GE(least, cast.target - k_cast_tie * cast.size()) << "pair " << i;
    } else if (least < cast.target) {
      ++hits;
    }
  }
  EXPECT_GT(separated, 100);
  EXPECT_GT(hits, 20);
}

}  // namespace
}  // namespace sixdof::ray_cast
