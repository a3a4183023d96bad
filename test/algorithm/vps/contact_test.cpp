#include <sixdof/algorithm/vps/contact.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "bodies.h"

namespace sixdof::vps {
namespace {

using vps_test::generic_pose;
using vps_test::moved;

/// Scalar code, one lane after the other, in the order of additions that contact.h states.
class PlainSums {
 public:
  explicit PlainSums(const PointTree& tree) : tree_(tree) {}

  /// evaluate(position, normal, weight, term, depth) sets the last two; false: no contact.
  template <class Evaluate>
  ContactSums over_all_leaves(const Evaluate& evaluate) {
    for (std::uint32_t leaf = 0; leaf < tree_.leaves(); ++leaf) {
      if (leaf % k_batch_leaves == 0) flush();
      for (std::size_t lane = 0; lane < PointTree::k_leaf_points; ++lane) {
        const auto row = [&](std::size_t r) {
          return tree_.blocks()[(leaf * PointTree::k_rows + r) * PointTree::k_leaf_points + lane];
        };
        float term[7] = {};
        float depth = 0.0f;
        if (!evaluate({row(0), row(1), row(2)}, {row(4), row(5), row(6)}, row(3), term, depth)) continue;
        for (std::size_t s = 0; s < 7; ++s) batch_[s][lane] += term[s];
        depth_ = std::max(depth_, depth);
      }
    }
    flush();
    double sum[7] = {};
    for (std::size_t s = 0; s < 7; ++s) {
      for (std::size_t lane = 0; lane < PointTree::k_leaf_points; ++lane) sum[s] += total_[s][lane];
    }
    return {{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5]}, sum[6], static_cast<double>(depth_)};
  }

 private:
  void flush() {
    for (std::size_t s = 0; s < 7; ++s) {
      for (std::size_t lane = 0; lane < PointTree::k_leaf_points; ++lane) {
        total_[s][lane] += static_cast<double>(batch_[s][lane]);
        batch_[s][lane] = 0.0f;
      }
    }
  }

  const PointTree& tree_;
  float batch_[7][PointTree::k_leaf_points] = {};
  double total_[7][PointTree::k_leaf_points] = {};
  float depth_ = 0.0f;
};

float dot(const float (&a)[3], const float (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void transform(const Eigen::Matrix3f& m, const float (&p)[3], float (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = m(i, 0) * p[0] + m(i, 1) * p[1] + m(i, 2) * p[2];
}

void cross(const float (&a)[3], const float (&b)[3], float (&out)[3]) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = a[j] * b[k] - a[k] * b[j];
  }
}

ContactSums plain_layers(const VoxelMap& map, const PointTree& tree, const VoxelTransform& voxel_transform,
                         LayerDepth kind) {
  return PlainSums(tree).over_all_leaves(
      [&](const float(&p)[3], const float(&n)[3], float w, float(&term)[7], float& depth) {
        float q[3], low[3], rotated[3], arm[3];
        int voxel[3];
        transform(voxel_transform.scaled, p, q);
        for (int axis = 0; axis < 3; ++axis) {
          q[axis] += voxel_transform.center[axis];
          low[axis] = std::min(std::max(std::floor(q[axis]), 0.0f), static_cast<float>(map.grid.voxels()[axis] - 1));
          voxel[axis] = static_cast<int>(low[axis]);
        }
        const int v = map.layer(voxel[0], voxel[1], voxel[2]);
        if (v < 0 || w == 0.0f) return false;
        depth = static_cast<float>(v);
        if (kind == LayerDepth::layers_and_local) {
          const float eps[3] = {low[0] + 0.5f - q[0], low[1] + 0.5f - q[1], low[2] + 0.5f - q[2]};
          transform(voxel_transform.rotation, n, rotated);
          depth = std::max(depth + dot(rotated, eps), 0.0f);
        }
        cross(p, n, arm);
        for (std::size_t i = 0; i < 3; ++i) {
          term[i] = w * depth * n[i];
          term[3 + i] = w * depth * arm[i];
        }
        term[6] = 1.0f;
        return true;
      });
}

ContactSums plain_field(const DistanceField& field, const PointTree& tree, const VoxelTransform& voxel_transform) {
  return PlainSums(tree).over_all_leaves(
      [&](const float(&p)[3], const float(&)[3], float w, float(&term)[7], float& depth) {
        float arm[3], weight[3][3], slope[3][3], force[3], torque[3];
        int voxel[3];
        transform(voxel_transform.scaled, p, arm);
        for (int axis = 0; axis < 3; ++axis) {
          const float q = arm[axis] + voxel_transform.center[axis];
          const float low = std::min(std::max(std::floor(q), 0.0f), static_cast<float>(field.grid.voxels()[axis] - 1));
          voxel[axis] = static_cast<int>(low);
          const float u = std::min(std::max(q - low, 0.0f), 1.0f) - 0.5f;
          const float below = 0.5f - u, above = 0.5f + u;
          const float weights[3] = {0.5f * (below * below), 0.75f - u * u, 0.5f * (above * above)};
          const float slopes[3] = {-below, -2.0f * u, above};
          for (int i = 0; i < 3; ++i) {
            weight[axis][i] = weights[i];
            slope[axis][i] = slopes[i];
          }
        }
        const std::int32_t brick = field.table[field.grid.brick_of(voxel[0], voxel[1], voxel[2])];
        if (brick == 0 || w == 0.0f) return false;
        constexpr int k = DistanceField::k_brick_edge;
        const float* const corner = field.coefficients.data() + brick * DistanceField::k_brick_coefficients +
                                    ((voxel[2] % 8) * k + voxel[1] % 8) * k + voxel[0] % 8;
        float value[3] = {}, value_dy[3] = {}, value_dz[3] = {};  // by column x
        for (int x = 0; x < 3; ++x) {
          for (int z = 0; z < 3; ++z) {
            float sum_y = 0.0f, sum_dy = 0.0f;
            for (int y = 0; y < 3; ++y) {
              sum_y += weight[1][y] * corner[(z * k + y) * k + x];
              sum_dy += slope[1][y] * corner[(z * k + y) * k + x];
            }
            value[x] += weight[2][z] * sum_y;
            value_dy[x] += weight[2][z] * sum_dy;
            value_dz[x] += slope[2][z] * sum_y;
          }
        }
        const float distance = dot(weight[0], value);
        if (!(distance < 0.0f)) return false;
        const float gradient[3] = {dot(slope[0], value), dot(weight[0], value_dy), dot(weight[0], value_dz)};
        depth = -distance;
        for (std::size_t i = 0; i < 3; ++i) force[i] = w * depth * gradient[i];
        cross(arm, force, torque);
        for (std::size_t i = 0; i < 3; ++i) {
          term[i] = force[i];
          term[3 + i] = torque[i];
        }
        term[6] = 1.0f;
        return true;
      });
}

void expect_same_bits(const ContactSums& a, const ContactSums& b) {
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.torque, b.torque);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.depth, b.depth);
}

class Contact : public ::testing::Test {
 protected:
  Contact() {
    all_.resize(tree_.leaves());
    std::iota(all_.begin(), all_.end(), 0u);
  }
  ~Contact() override { hwy::SetSupportedTargetsForTest(0); }

  VoxelTransform transform_to(const VoxelMap& map, std::uint64_t seed, double reach) const {
    Pose X = generic_pose(seed, reach);
    X.t += a_.center() - X.R * b_.center();
    return VoxelTransform::of(X, tree_.center(), map.grid);
  }

  /// From deep overlap to far beyond the grid.
  static constexpr double k_reaches[] = {0.05, 0.4, 0.9, 1.2, 1.6, 2.0, 2.4, 5.0, 1e4};

  Mesh a_ = moved(make_bumpy_sphere({.amplitude = 0.3}, 600), generic_pose(41, 2.0));
  Mesh b_ = moved(make_bumpy_sphere({.radius = 0.9, .waves = 1.1}, 500), generic_pose(42, 1.0));
  VoxelMap map_ = VoxelMap::build(a_, 0.02 * a_.diagonal(), DistanceField::k_border);
  VoxelMap wide_ = VoxelMap::build(a_, 0.02 * a_.diagonal(), 200);  // 16 bits
  DistanceField field_ = DistanceField::build(a_, map_);
  PointTree tree_{PointShell::build(b_, 0.02 * b_.diagonal()), b_.center(), true};
  std::vector<std::uint32_t> all_;
};

TEST_F(Contact, EveryInstructionSetGivesTheBitsOfScalarCode) {
  ASSERT_EQ(wide_.layer_bits, 16);
  ASSERT_NE(tree_.points() % PointTree::k_leaf_points, 0u);  // the last leaf has padding
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    double contacts = 0.0;
    std::uint64_t seed = 100;
    for (const double reach : k_reaches) {
      const VoxelTransform x = transform_to(map_, ++seed, reach), x_wide = transform_to(wide_, seed, reach);
      for (const LayerDepth kind : {LayerDepth::layers, LayerDepth::layers_and_local}) {
        const ContactSums expected = plain_layers(map_, tree_, x, kind);
        expect_same_bits(sum_layers(map_, {tree_, x, all_}, kind), expected);
        expect_same_bits(sum_layers(wide_, {tree_, x_wide, all_}, kind), plain_layers(wide_, tree_, x_wide, kind));
        EXPECT_EQ(touches_layers(map_, {tree_, x, all_}), expected.contacts > 0.0);
        contacts += expected.contacts;
      }
      const ContactSums expected = plain_field(field_, tree_, x);
      expect_same_bits(sum_field(field_, {tree_, x, all_}), expected);
      EXPECT_EQ(touches_field(field_, {tree_, x, all_}), expected.contacts > 0.0);
      contacts += expected.contacts;
    }
    EXPECT_GT(contacts, 1000.0);
  }
}

TEST_F(Contact, CullingChangesNoBitAndSkipsManyLeaves) {
  PointTree::Scratch scratch;
  std::size_t left_out = 0, taken = 0;
  for (std::uint64_t seed = 200; seed < 400; ++seed) {
    const double reach = k_reaches[seed % std::size(k_reaches)];
    const VoxelTransform x = transform_to(map_, seed, reach);
    std::span<const std::uint32_t> some = tree_.cull(map_, x, 0.0, scratch);
    ASSERT_TRUE(std::is_sorted(some.begin(), some.end()));
    expect_same_bits(sum_layers(map_, {tree_, x, some}, LayerDepth::layers_and_local),
                     sum_layers(map_, {tree_, x, all_}, LayerDepth::layers_and_local));
    left_out += all_.size() - some.size();
    taken += some.size();
    some = tree_.cull(map_, x, DistanceField::k_reach, scratch);
    expect_same_bits(sum_field(field_, {tree_, x, some}), sum_field(field_, {tree_, x, all_}));
  }
  // In two poses out of nine nearly all points are in contact.
  EXPECT_GT(2 * left_out, taken);
  EXPECT_GT(taken, 0u);
}

/// The point of the voxels with v >= 0 that is nearest to `middle`, a little inside its voxel; all in voxel
/// coordinates.
Eigen::Vector3d nearest_in_contact(const VoxelMap& map, const Eigen::Vector3d& middle, int reach) {
  constexpr double k_inside = 0.01;  // far more than single precision rounds
  const Eigen::Array3i cell = middle.array().floor().cast<int>();
  const Eigen::Array3i low = (cell - reach).max(0), high = (cell + reach).min(map.grid.voxels() - 1);
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(1e9);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        if (map.layer(x, y, z) < 0) continue;
        const Eigen::Array3d corner(x, y, z);
        const Eigen::Vector3d p = middle.array().max(corner + k_inside).min(corner + (1.0 - k_inside));
        if ((p - middle).squaredNorm() < (nearest - middle).squaredNorm()) nearest = p;
      }
    }
  }
  return nearest;
}

/// Nodes whose sphere just reaches the nearest voxel in contact: they are lost if the bound on its distance is slightly
/// too large.
TEST_F(Contact, CullingKeepsANodeThatJustReachesAContact) {
  std::mt19937_64 random(77);
  std::uniform_real_distribution<double> uniform;
  constexpr int k_reach = 9;
  PointTree::Scratch scratch;
  const std::uint32_t leaf = 0;
  int stored = 0, unstored = 0, beyond = 0, field_contacts = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Array3d n = map_.grid.voxels().cast<double>();
    constexpr double k_outside = 4.0;  // voxels around the grid
    const Eigen::Array3d fraction(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d middle = fraction * (n + 2.0 * k_outside) - k_outside;
    const bool in_grid = (middle.array() >= 0.0).all() && (middle.array() < n).all();
    const Eigen::Array3i cell = middle.array().floor().cast<int>();
    if (in_grid && map_.layer(cell.x(), cell.y(), cell.z()) >= 0) continue;
    const Eigen::Vector3d contact = nearest_in_contact(map_, middle, k_reach);
    if ((contact - middle).norm() > k_reach) continue;
    (!in_grid ? beyond : map_.table[map_.grid.brick_of(cell.x(), cell.y(), cell.z())] < 0 ? unstored : stored)++;
    // A point and its mirror image, so that their sphere is about `middle`: from before the contact to within the body.
    const double distance = (contact - middle).norm();
    bool touched = false;
    for (double beyond_contact = -0.5; beyond_contact < 2.5 && !touched; beyond_contact += 0.1) {
      PointShell shell;
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d point = middle + side * (1.0 + beyond_contact / distance) * (contact - middle);
        shell.points.push_back(map_.grid.origin + map_.grid.size * point);
        shell.normals.push_back(Eigen::Vector3d::UnitZ());
        shell.areas.push_back(1.0);
      }
      const PointTree tree(shell, a_.center(), true);
      const VoxelTransform at = VoxelTransform::of(Pose{}, tree.center(), map_.grid);
      if (touches_layers(map_, {tree, at, std::span(&leaf, 1)})) {
        ASSERT_EQ(tree.cull(map_, at, 0.0, scratch).size(), 1u) << middle.transpose();
      }
      touched = touches_field(field_, {tree, at, std::span(&leaf, 1)});
      if (touched) {
        ++field_contacts;
        ASSERT_EQ(tree.cull(map_, at, DistanceField::k_reach, scratch).size(), 1u) << middle.transpose();
      }
    }
  }
  EXPECT_GT(stored, 300);
  EXPECT_GT(unstored, 30);
  EXPECT_GT(beyond, 100);
  EXPECT_GT(field_contacts, 100);
}

TEST_F(Contact, CullingSkipsAllLeavesFarApart) {
  PointTree::Scratch scratch;
  EXPECT_TRUE(tree_.cull(map_, transform_to(map_, 500, 3.5), 0.0, scratch).empty());
}

}  // namespace
}  // namespace sixdof::vps
