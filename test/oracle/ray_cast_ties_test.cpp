#include <sixdof/oracle/ray_cast_ties.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/ray_cast_search.h>

#include "../configuration/shapes.h"
#include "triangles_of.h"

namespace sixdof::ray_cast {
namespace {

using test::least_distance;
using test::random_direction;
using test::random_rotation;
using test::triangles_of;

/// Error of support values, in units of the tree's radius: k_support_tolerance and k_support_rounding. Less than half
/// of k_cast_tie, which culls allow for.
constexpr double k_support_error = 3e-15;
constexpr std::uint64_t k_plenty = 1'000'000'000;

Eigen::Matrix3d random_matrix(std::mt19937_64& random) {
  const Eigen::Vector4d q = random_rotation(random);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

std::uint32_t child_of(const Tree& tree, std::size_t lane) {
  return detail::CloseVolume::child_of(tree.nodes()[0], lane).volume;
}

/// The least axis . p over the triangles of a volume, one by one.
double least_projection(const CastMesh& mesh, std::uint32_t volume, const Eigen::Vector3d& axis) {
  const auto [first, count] = triangles_of(mesh.tree(), volume);
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = first; t < first + count; ++t) {
    for (const Eigen::Vector3d& corner : mesh.triangle(t)) least = std::min(least, axis.dot(corner));
  }
  return least;
}

/// All nodes and leaves, shuffled: values found for one may be used for others.
std::vector<std::uint32_t> volumes_of(const CastMesh& mesh, std::mt19937_64& random) {
  std::vector<std::uint32_t> volumes;
  for (std::uint32_t node = 0; node < mesh.tree().nodes().size(); ++node) volumes.push_back(node);
  for (std::uint32_t leaf = 0; leaf < mesh.tree().leaves().size(); ++leaf) {
    volumes.push_back(detail::CloseVolume::k_leaf + leaf);
  }
  std::shuffle(volumes.begin(), volumes.end(), random);
  return volumes;
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
    const CastMesh mesh(std::make_shared<Tree>(body.mesh));
    TreeSupport support(mesh);
    const Eigen::Matrix3d R = random_matrix(random);
    for (const Eigen::Matrix3d& M : {Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), R}) {
      for (const Eigen::Vector3d& along : body.axes) {
        const Eigen::Vector3d axis = M.transpose() * (M * along).normalized();  // with the rounding of a rotation
        support.set_axis(axis);
        for (const std::uint32_t volume : volumes_of(mesh, random)) {
          std::uint64_t budget = k_plenty;
          ASSERT_NEAR(support.support_value(volume, budget), least_projection(mesh, volume, axis),
                      k_support_error * mesh.tree().radius())
              << body.mesh.name() << ", volume " << volume << ", axis " << along.transpose();
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
    const CastMesh mesh(std::make_shared<Tree>(body.mesh));
    const double error = k_support_error * mesh.tree().radius();
    TreeSupport support(mesh);
    for (const Eigen::Vector3d& along : body.axes) {
      const Eigen::Vector3d axis = R.transpose() * (R * along).normalized();
      for (const std::uint64_t most : {3u, 10u, 70u, 90u}) {
        support.set_axis(axis);
        for (const std::uint32_t volume : volumes_of(mesh, random)) {
          std::uint64_t budget = most;
          const std::uint64_t before = support.evaluations();
          const double value = support.support_value(volume, budget);
          EXPECT_LE(budget, most);
          // The children of a node are evaluated together.
          EXPECT_LE(support.evaluations() - before, most + Tree::k_width);
          const double least = least_projection(mesh, volume, axis);
          EXPECT_LE(value, least + error) << body.mesh.name() << ", volume " << volume;
          if (std::isfinite(value) && value < least - error) ++cut_short;
        }
      }
    }
  }
  EXPECT_GT(cut_short, 0);
}

TEST(TreeSupport, EvaluatesAFractionOfTheTriangles) {
  const Mesh box = load_model("box-20000");
  const CastMesh mesh(std::make_shared<Tree>(box));
  const Tree& tree = mesh.tree();
  std::mt19937_64 random(63);
  std::vector<Eigen::Vector3d> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                    Eigen::Vector3d(0.6, 0.0, -0.8)};
  for (int i = 0; i < 10; ++i) axes.push_back(random_direction(random));
  TreeSupport support(mesh);
  std::uint64_t before = 0;
  for (const Eigen::Vector3d& axis : axes) {
    support.set_axis(axis);
    for (std::size_t lane = 0; lane < tree.nodes()[0].child_count; ++lane) {
      std::uint64_t budget = k_plenty;
      support.support_value(child_of(tree, lane), budget);
    }
    // Counts are the same on every machine: at most 249.
    EXPECT_LT(support.evaluations() - before, box.triangles().size() / 40) << axis.transpose();
    before = support.evaluations();
  }
}

TEST(DifferenceSupport, FindsTheSupportValueOfDifferences) {
  std::mt19937_64 random(64);
  const CastMesh a(std::make_shared<Tree>(load_model("circular-box-1000")));
  const CastMesh b(std::make_shared<Tree>(load_model("box-2000")));
  const double size = a.tree().radius() + b.tree().radius();
  const Eigen::Matrix3d R = random_matrix(random);
  DifferenceSupport support(a, b);
  support.set_rotation(R);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d axis = random_direction(random);
    for (std::size_t lane_a = 0; lane_a < a.tree().nodes()[0].child_count; ++lane_a) {
      for (std::size_t lane_b = 0; lane_b < b.tree().nodes()[0].child_count; ++lane_b) {
        const std::uint32_t child_a = child_of(a.tree(), lane_a), child_b = child_of(b.tree(), lane_b);
        const double expected =
            least_projection(a, child_a, -axis) + least_projection(b, child_b, R.transpose() * axis);
        EXPECT_NEAR(support.support_value(child_a, child_b, axis, k_plenty), expected, k_support_error * size);
      }
    }
  }
}

TEST(SeparatedInDouble, HoldsForAllTrianglesAndLargerTranslations) {
  std::mt19937_64 random(65);
  const CastMesh a(std::make_shared<Tree>(load_model("bumpy-sphere-600")));
  const CastMesh b(std::make_shared<Tree>(load_model("torus-2000")));
  const double diagonal = 2.0 * a.tree().radius();
  const Eigen::Matrix3d R = random_matrix(random);
  const std::vector<std::uint32_t> of_a = volumes_of(a, random), of_b = volumes_of(b, random);
  int separated = 0, hits = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    Cast cast(a, b);
    cast.set_rotation(R);
    const std::uint32_t volume_a = of_a[i % of_a.size()], volume_b = of_b[(7 * i) % of_b.size()];
    // A leaf with a large node: all pairs of triangles would take long.
    const auto is_leaf = [](std::uint32_t volume) { return volume >= detail::CloseVolume::k_leaf; };
    if (is_leaf(volume_a) != is_leaf(volume_b)) continue;
    cast.direction = random_direction(random);
    cast.target = (i % 2 == 0 ? 0.2 : 1e-3) * diagonal;
    cast.best = {.translation = 0.1 * static_cast<double>(i % 8) * diagonal,
                 .pair = TrianglePair{0, 0},
                 .axis = random_direction(random),
                 .separating_axis = cast.direction};
    const bool is_separated = separated_in_double(cast, volume_a, volume_b);
    double least = std::numeric_limits<double>::infinity();
    for (const double later : {0.0, 0.05, 0.2, 0.5, 1.0}) {
      least = std::min(least, least_distance(cast, volume_a, volume_b, cast.best.translation + later * diagonal));
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
