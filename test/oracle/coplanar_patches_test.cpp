#include <sixdof/oracle/coplanar_patches.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

constexpr double k_near_rounding = 1e-15;  // of the length of a unit vector

using detail::CloseVolume;
using detail::CoplanarPatches;
using Eigen::Vector3d;
using shapes::Generator;
using shapes::uniform;

/// Checks what the doc comments state of one node or leaf. Returns the number of its triangles if it lies in a patch.
std::uint32_t check_volume(const Mesh& mesh, const Tree& tree, const CoplanarPatches::Plane* plane,
                           std::uint32_t smallest_index, std::uint32_t first, std::uint32_t count) {
  const auto triangles = tree.mesh_triangle().subspan(first, count);
  EXPECT_EQ(smallest_index, *std::min_element(triangles.begin(), triangles.end()));
  if (!plane) return 0;
  EXPECT_NEAR(plane->normal.norm(), 1.0, k_near_rounding);
  EXPECT_GT(plane->upper, plane->lower);
  EXPECT_LE(plane->upper - plane->lower, 1e-14 * (mesh.diagonal() + mesh.center().norm()));
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : mesh.triangles()[t]) {
      const double offset = plane->normal.dot(mesh.vertices()[v] - tree.center());
      EXPECT_LT(plane->lower, offset);
      EXPECT_GT(plane->upper, offset);
    }
  }
  return count;
}

/// Returns how many triangles lie in patches.
std::uint32_t check_patches(const Mesh& mesh) {
  const Tree tree(mesh);
  const CoplanarPatches patches(tree);
  EXPECT_FALSE(patches.empty());
  std::uint32_t in_patches = 0;
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const Tree::Node& node = tree.nodes()[i];
    check_volume(mesh, tree, patches.of(i), patches.smallest_index(i), node.first_triangle, node.triangle_count);
    if (!patches.of(i)) continue;
    for (std::uint32_t k = 0; k < node.child_count; ++k) {  // all below lies in the same plane
      EXPECT_EQ(patches.of(CloseVolume::child_of(node, k).volume), patches.of(i));
    }
  }
  for (std::uint32_t i = 0; i < tree.leaves().size(); ++i) {
    const Tree::Child leaf = tree.leaves()[i].child;
    const std::uint32_t volume = CloseVolume::k_leaf + i;
    in_patches +=
        check_volume(mesh, tree, patches.of(volume), patches.smallest_index(volume), leaf.first(), leaf.count());
  }
  EXPECT_GE(patches.bytes(), 8 * (tree.nodes().size() + tree.leaves().size()));
  return in_patches;
}

TEST(CoplanarPatches, ContainNearlyAllOfABlockAnywhere) {
  Generator generator(1);
  for (const double offset : {0.0, 0.5, 20.0}) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
      Pose pose = shapes::random_pose(generator, offset);
      pose.R *= scale;
      pose.t *= scale;
      // Leaves across an edge of the block hold two planes.
      EXPECT_GT(check_patches(shapes::moved(make_box({}, 3000), pose)), 2400u) << offset << " " << scale;
    }
  }
}

TEST(CoplanarPatches, ContainAllOfASheet) {
  const Mesh sheet = Mesh::build({{0.0, 0.0, 0.3}, {1.0, 0.0, 0.3}, {1.0, 1.0, 0.3}, {0.0, 1.0, 0.3}, {0.4, 0.6, 0.3}},
                                 {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_EQ(check_patches(sheet), 4u);
}

TEST(CoplanarPatches, AreAbsentFromCurvedSurfacesAndFromABlockOfTwelve) {
  const CoplanarPatches none(Tree(shapes::bumpy_sphere(4, 0.2)));
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.bytes(), 0u);
  EXPECT_TRUE(CoplanarPatches(Tree(shapes::box({1.0, 2.0, 0.5}))).empty());
  // Bent by more than rounding.
  const Mesh block = make_box({}, 3000);
  std::vector<Vector3d> v = block.vertices();
  Generator generator(2);
  for (Vector3d& p : v) p += 1e-12 * shapes::unit_vector(generator);
  EXPECT_TRUE(CoplanarPatches(Tree(Mesh::build(v, block.triangles()))).empty());
}

double least_along(const std::vector<Vector3d>& points, const Vector3d& axis) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points) least = std::min(least, p.dot(axis));
  return least;
}

/// Four points of a plane at distance `offset` from the origin, with their box and plane.
struct Patch {
  std::vector<Vector3d> points;
  CoplanarPatches::Plane plane;
  Tree::Volume box{};

  Patch(Generator& generator, const Vector3d& normal, double offset, double tilt) {
    const Vector3d n = (normal + tilt * shapes::unit_vector(generator)).normalized();
    for (int i = 0; i < 4; ++i) {
      points.emplace_back(offset * n + n.cross(shapes::unit_vector(generator)) * uniform(generator, 0.1, 1.0));
    }
    plane = {n, offset - 1e-15, offset + 1e-15};
    Eigen::AlignedBox3d around;
    for (const Vector3d& p : points) around.extend(p);
    for (Eigen::Index k = 0; k < 3; ++k) {
      box.lower[k] = std::nextafter(static_cast<float>(around.min()[k]), -10.0f);
      box.upper[k] = std::nextafter(static_cast<float>(around.max()[k]), 10.0f);
    }
  }
};

TEST(CoplanarPatches, GapOfPlanesIsThatOfTheirPoints) {
  Generator generator(3);
  int parallel = 0;
  for (int i = 0; i < 600; ++i) {
    const Pose rotation = shapes::random_pose(generator, 0.0);
    const Vector3d normal = shapes::unit_vector(generator);
    const double tilt = i % 3 == 0 ? 0.0 : std::pow(10.0, uniform(generator, -16.0, -4.0));
    const Patch a(generator, (i % 2 ? 1.0 : -1.0) * normal, uniform(generator, -0.5, 0.5), 0.0);
    const Patch b(generator, (i % 5 ? 1.0 : -1.0) * (rotation.R.transpose() * normal), uniform(generator, -0.5, 0.5),
                  tilt);
    const Vector3d shift = shapes::uniform_vector(generator, 3.0);
    const double gap = detail::plane_gap(a.plane, a.box, b.plane, b.box, rotation.R, shift);
    // The gap of the points along the better of the two normals.
    double truth = -std::numeric_limits<double>::infinity();
    std::vector<Vector3d> b_in_a;
    for (const Vector3d& p : b.points) b_in_a.push_back(rotation.R * p + shift);
    for (const Vector3d& axis : {a.plane.normal, Vector3d(rotation.R * b.plane.normal)}) {
      for (const Vector3d& n : {axis, Vector3d(-axis)}) {
        truth = std::max(truth, least_along(b_in_a, n) + least_along(a.points, -n));
      }
    }
    constexpr double k_rounding = 1e-14;  // of sizes of a few units
    EXPECT_LE(gap, truth + k_rounding);
    if (tilt < 1e-4) {
      ++parallel;
      EXPECT_GE(gap, truth - k_rounding - 4.0 * tilt);  // a tilt over the other's box
    }
  }
  EXPECT_GT(parallel, 500);
}

TEST(CoplanarPatches, GapOfPlanesAtAnAngleSaysNothing) {
  Generator generator(4);
  for (int i = 0; i < 50; ++i) {
    const Vector3d normal = shapes::unit_vector(generator);
    const Patch a(generator, normal, 0.1, 0.0);
    const Patch b(generator, (normal + 0.01 * normal.cross(shapes::unit_vector(generator)).normalized()).normalized(),
                  0.2, 0.0);
    EXPECT_EQ(detail::plane_gap(a.plane, a.box, b.plane, b.box, Eigen::Matrix3d::Identity(), 5.0 * normal),
              -std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace sixdof
