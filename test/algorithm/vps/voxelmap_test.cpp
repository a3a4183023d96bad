#include <sixdof/algorithm/vps/voxelmap.h>

#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/surface_voxels.h>
#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/triangle_distance.h>

#include "bodies.h"

namespace sixdof::vps {
namespace {

using vps_test::box;
using vps_test::generic_pose;
using vps_test::inside_out;
using vps_test::moved;
using vps_test::together;

constexpr double k_half_diagonal = 0.8660254037844387;  // of a voxel
constexpr double k_rounding = 1e-9;                     // of distances of the order of 1

double brute_force_distance(const Mesh& mesh, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles()) {
    const auto& v = mesh.vertices();
    least = std::min(least, triangle_triangle_distance({p, p, p}, {v[t[0]], v[t[1]], v[t[2]]}).distance);
  }
  return least;
}

/// By the sum of all solid angles, each from its three dihedral angles (Girard), unlike the formula under test.
bool brute_force_inside(const Mesh& mesh, const Eigen::Vector3d& p) {
  double total = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const auto& v = mesh.vertices();
    const Eigen::Vector3d a = v[t[0]] - p, b = v[t[1]] - p, c = v[t[2]] - p;
    const Eigen::Vector3d ab = a.cross(b), bc = b.cross(c), ca = c.cross(a);
    const auto dihedral = [](const Eigen::Vector3d& m, const Eigen::Vector3d& n) {
      return std::atan2(m.cross(n).norm(), -m.dot(n));
    };
    const double angle = dihedral(ca, ab) + dihedral(ab, bc) + dihedral(bc, ca) - std::numbers::pi;
    total += a.dot(bc) > 0.0 ? angle : -angle;
  }
  return total > 2.0 * std::numbers::pi;
}

template <class Callback>
void for_each_voxel(const VoxelMap& map, const Callback& callback) {
  const Eigen::Array3i n = map.grid.voxels();
  for (int z = 0; z < n.z(); ++z) {
    for (int y = 0; y < n.y(); ++y) {
      for (int x = 0; x < n.x(); ++x) callback(x, y, z);
    }
  }
}

Mesh lumpy() {
  return moved(make_bumpy_sphere({.radius = 0.7, .amplitude = 0.3, .waves = 0.8}, 240), generic_pose(11, 3.0));
}

TEST(VoxelMap, LayersAreDistancesOfVoxelCentersWithinTheirError) {
  const Mesh body = lumpy();
  const int border = 3;
  const VoxelMap map = VoxelMap::build(body, 0.04 * body.diagonal(), border);
  const double s = map.grid.size;
  std::uint64_t inside = 0, surface = 0, far = 0;
  for_each_voxel(map, [&](int x, int y, int z) {
    const Eigen::Vector3d center = map.grid.center(x, y, z);
    const double distance = brute_force_distance(body, center);
    const int v = map.layer(x, y, z);
    if (map.table[map.grid.brick_of(x, y, z)] < 0) {
      ++far;
      ASSERT_GT(distance, (border - VoxelMap::k_layer_error) * s);
      ASSERT_FALSE(brute_force_inside(body, center));
      return;
    }
    ASSERT_NEAR(std::abs(v) * s, distance, VoxelMap::k_layer_error * s + k_rounding) << x << ' ' << y << ' ' << z;
    if (v == 0) {
      ++surface;
      ASSERT_LE(distance, k_half_diagonal * s + k_rounding);
    } else {
      inside += v > 0 ? 1 : 0;
      ASSERT_GT(distance, 0.5 * s - k_rounding);  // otherwise the surface touches the voxel
      ASSERT_EQ(v > 0, brute_force_inside(body, center));
    }
  });
  EXPECT_EQ(map.surface_voxels, surface);
  EXPECT_EQ(map.inside_voxels, inside);
  EXPECT_GT(far, 0u);
}

TEST(VoxelMap, LayersCountOneTwoThreeBehindAFlatFace) {
  const Mesh body = box({1.3, 1.7, 2.1});
  const VoxelMap map = VoxelMap::build(body, 0.05, 2);
  const Eigen::Vector3d face = map.grid.coordinates(Eigen::Vector3d(0.013, 0.027, -1.05));
  const int x = static_cast<int>(face.x()), y = static_cast<int>(face.y()), z = static_cast<int>(face.z());
  for (int layer = -2; layer < 12; ++layer) EXPECT_EQ(map.layer(x, y, z + layer), layer);
}

TEST(VoxelMap, TouchedVoxelsAreThoseThatABoxesFacesCut) {
  const Mesh body = moved(box({0.9, 0.7, 0.5}), {Eigen::Matrix3d::Identity(), {0.123, -0.456, 0.789}});
  const VoxelMap map = VoxelMap::build(body, 0.061, 1);
  for_each_voxel(map, [&](int x, int y, int z) {
    const Eigen::Array3d low = map.grid.center(x, y, z).array() - 0.5 * map.grid.size, high = low + map.grid.size;
    const bool reaches = (high >= body.box().min().array()).all() && (low <= body.box().max().array()).all();
    const bool within = (low > body.box().min().array()).all() && (high < body.box().max().array()).all();
    ASSERT_EQ(map.layer(x, y, z) == 0, reaches && !within) << x << ' ' << y << ' ' << z;
  });
}

TEST(VoxelMap, ACavityIsOutsideAndABodyInABodyIsInside) {
  const Mesh outer = box({2.0, 1.6, 1.8});
  const Mesh inner = moved(box({1.0, 0.8, 0.7}), generic_pose(5, 0.1));
  const auto layer_at = [](const VoxelMap& map, const Eigen::Vector3d& p) {
    const Eigen::Array3i voxel = map.grid.coordinates(p).array().floor().cast<int>();
    return map.layer(voxel.x(), voxel.y(), voxel.z());
  };
  const Eigen::Vector3d in_both = inner.center(), in_wall(0.9, 0.7, -0.8);

  const VoxelMap hollow = VoxelMap::build(together(outer, inside_out(inner)), 0.04, 6);
  EXPECT_LT(layer_at(hollow, in_both), -5);
  EXPECT_GT(layer_at(hollow, in_wall), 0);

  const VoxelMap doubled = VoxelMap::build(together(outer, inner), 0.04, 6);
  EXPECT_GT(layer_at(doubled, in_both), 5);
  EXPECT_GT(layer_at(doubled, in_wall), 0);
  EXPECT_EQ(hollow.surface_voxels, doubled.surface_voxels);
}

TEST(VoxelMap, HasSurfaceVoxelsOnlyForAPlateThinnerThanAVoxel) {
  const Mesh plate = moved(box({1.0, 0.8, 0.002}), generic_pose(8, 0.4));
  const VoxelMap map = VoxelMap::build(plate, 0.02, 2);
  EXPECT_EQ(map.inside_voxels, 0u);
  EXPECT_GT(map.surface_voxels, 2000u);  // 50 by 40 voxels, more on a slant
}

TEST(VoxelMap, SixteenBitsHoldTheSameLayersAsEight) {
  const Mesh body = moved(make_bumpy_sphere({}, 180), generic_pose(3, 1.0));
  const VoxelMap narrow = VoxelMap::build(body, 0.1, 100), wide = VoxelMap::build(body, 0.1, 200);
  EXPECT_EQ(narrow.layer_bits, 8);
  EXPECT_EQ(wide.layer_bits, 16);
  for_each_voxel(wide, [&](int x, int y, int z) { ASSERT_EQ(wide.layer(x, y, z), narrow.layer(x, y, z)); });
}

TEST(VoxelMap, IsTheSameForAnyNumberOfThreads) {
  const Mesh body = together(moved(make_bumpy_sphere({}, 400), generic_pose(21, 0.2)),
                             moved(box({3.0, 0.1, 0.2}), generic_pose(22, 1.5)));
  const auto build = [&](unsigned threads) {
    std::pair<VoxelMap, DistanceField> built;
    parallel::with_threads(threads, [&] {
      built.first = VoxelMap::build(body, 0.01 * body.diagonal(), DistanceField::k_border);
      built.second = DistanceField::build(body, built.first);
    });
    return built;
  };
  const auto [one, field_of_one] = build(1);
  const auto [four, field_of_four] = build(4);
  EXPECT_EQ(one.table, four.table);
  EXPECT_EQ(one.words, four.words);
  EXPECT_EQ(field_of_one.table, field_of_four.table);
  EXPECT_EQ(field_of_one.coefficients, field_of_four.coefficients);
}

TEST(VoxelMap, RefusesMeshesThatAreNotSolidAndTooSmallVoxels) {
  const Mesh body = box({1.0, 0.8, 0.6});
  const auto words = [](const Mesh& mesh) -> std::string {
    try {
      VoxelMap::build(mesh, 0.1, 2);
    } catch (const BadMesh& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(words(inside_out(body)), ::testing::HasSubstr("inside out"));
  std::vector<Triangle> open = body.triangles();
  open.pop_back();
  EXPECT_THAT(words(Mesh::build(body.vertices(), open)), ::testing::HasSubstr("border edges"));
  EXPECT_THROW(VoxelMap::build(body, 1e-5, 2), BadArgument);
}

/// Error of the dipole approximation: a few hundredths.
constexpr double k_dipoles = 0.05;

TEST(WindingNumber, CountsTheBodiesAroundAPoint) {
  const Mesh outer = moved(make_bumpy_sphere({.radius = 1.3, .amplitude = 0.3}, 3000), generic_pose(15, 2.0));
  const Mesh inner = moved(make_bumpy_sphere({.radius = 0.4}, 700), generic_pose(15, 2.0));
  const Mesh both = together(outer, inner);
  const Tree tree(both);
  const WindingNumber winding(tree);
  int counts[3] = {};
  for (std::uint64_t seed = 300; seed < 700; ++seed) {
    const Eigen::Vector3d p = outer.center() + generic_pose(seed, 0.005 * static_cast<double>(seed - 300)).t;
    const int around = (brute_force_inside(outer, p) ? 1 : 0) + (brute_force_inside(inner, p) ? 1 : 0);
    EXPECT_NEAR(winding.at(p), around, k_dipoles) << seed;
    ++counts[around];
  }
  for (const int count : counts) EXPECT_GT(count, 20);
}

TEST(DistanceField, CoefficientsAreExactSignedDistancesNearTheBody) {
  const Mesh body = lumpy();
  const VoxelMap map = VoxelMap::build(body, 0.04 * body.diagonal(), DistanceField::k_border);
  const DistanceField field = DistanceField::build(body, map);
  constexpr double k_single = 1e-5;  // rounding to single precision of values below 2^5
  int checked = 0;
  for_each_voxel(map, [&](int x, int y, int z) {
    const std::int32_t brick = field.table[map.grid.brick_of(x, y, z)];
    const Eigen::Vector3d center = map.grid.center(x, y, z);
    const bool inside = brute_force_inside(body, center);
    if (brick == 0) {
      ASSERT_FALSE(inside);
      return;
    }
    if (map.layer(x, y, z) < -DistanceField::k_border) return;
    constexpr int k = DistanceField::k_brick_edge;
    const int in_brick = (z % 8 + 1) * k * k + (y % 8 + 1) * k + x % 8 + 1;
    const float value =
        field.coefficients[static_cast<std::size_t>(brick * DistanceField::k_brick_coefficients + in_brick)];
    const double distance = brute_force_distance(body, center) / map.grid.size;
    ASSERT_NEAR(value, inside ? -distance : distance, k_single);
    ++checked;
  });
  EXPECT_GT(checked, 1000);
}

}  // namespace
}  // namespace sixdof::vps
