#include "bench/cli/structure_drawing.h"

#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>

namespace sixdof::cli {
namespace {

constexpr double k_near_rounding = 1e-9;  // of a sum over the faces of all voxels

constexpr double k_rounding = 1e-12;  // of coordinates of the order of 1

/// Fifty disjoint spheres of different sizes.
ist::SphereTree some_tree() {
  std::vector<ist::Sphere> spheres;
  for (int i = 0; i < 50; ++i) {
    spheres.push_back({{0.9 * (i % 4) - 1.3, 1.1 * (i / 4 % 5) + 0.2, 1.3 * (i / 20)}, 0.1 + 0.006 * i});
  }
  return ist::build_sphere_tree(std::move(spheres));
}

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
  Colour colour{};
};

/// The balls of a drawing. Checks that each has one colour and its vertices at one distance from the centre.
std::vector<Ball> balls_of(const Drawing& drawing) {
  std::vector<Ball> balls;
  EXPECT_EQ(drawing.vertices.size(), drawing.elements * k_ball_vertices);
  EXPECT_EQ(drawing.colours.size(), drawing.vertices.size());
  EXPECT_EQ(drawing.triangles.size(), drawing.elements * k_ball_triangles);
  for (std::size_t first = 0; first < drawing.vertices.size(); first += k_ball_vertices) {
    Ball ball{.colour = drawing.colours[first]};
    for (std::size_t i = first; i < first + k_ball_vertices; ++i) ball.center += drawing.vertices[i] / k_ball_vertices;
    ball.radius = (drawing.vertices[first] - ball.center).norm();
    for (std::size_t i = first; i < first + k_ball_vertices; ++i) {
      EXPECT_NEAR((drawing.vertices[i] - ball.center).norm(), ball.radius, k_rounding);
      EXPECT_EQ(drawing.colours[i], ball.colour);
    }
    balls.push_back(ball);
  }
  return balls;
}

Mesh as_mesh(const Drawing& drawing) { return Mesh::build(drawing.vertices, drawing.triangles); }

TEST(Drawing, ShowsEverySphereAtItsCentreColouredByRadius) {
  const ist::SphereTree tree = some_tree();
  const Drawing drawing = draw_spheres(tree);
  const std::vector<Ball> balls = balls_of(drawing);
  ASSERT_EQ(balls.size(), tree.leaves.size());
  double largest = 0.0;
  for (const ist::Sphere& sphere : tree.leaves) largest = std::max(largest, sphere.radius);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    EXPECT_LE((balls[i].center - tree.leaves[i].center).norm(), k_rounding);
    EXPECT_NEAR(balls[i].radius, tree.leaves[i].radius, k_rounding);
    EXPECT_EQ(balls[i].colour, ramp_colour(tree.leaves[i].radius / largest));
  }
  // Faceted balls are inside the round ones, and their faces are oriented outwards.
  const double volume = as_mesh(drawing).volume();
  EXPECT_LT(volume, tree.volume);
  EXPECT_GT(volume, 0.85 * tree.volume);  // 80 facets
}

TEST(Drawing, CutLeavesOutElementsWithTheirCentreBeyond) {
  const ist::SphereTree tree = some_tree();
  const double x = tree.leaves[20].center.x();
  const auto kept = static_cast<std::size_t>(std::count_if(
      tree.leaves.begin(), tree.leaves.end(), [&](const ist::Sphere& sphere) { return sphere.center.x() <= x; }));
  ASSERT_LT(kept, tree.leaves.size());
  EXPECT_EQ(draw_spheres(tree, x).elements, kept);

  const Mesh body = make_bumpy_sphere({}, 300);
  const vps::PointShell shell = vps::PointShell::build(body, 0.2);
  const Drawing points = draw_points(shell, 0.1);
  EXPECT_GT(points.elements, 0u);
  EXPECT_LT(points.elements, shell.points.size());
  for (const Eigen::Vector3d& p : points.vertices) EXPECT_LE(p.x(), 0.1);
}

TEST(Drawing, BallsOfALevelContainAllSpheresBelow) {
  const ist::SphereTree tree = some_tree();
  EXPECT_EQ(draw_balls(tree, 1).elements, tree.children(0));
  for (const int level : {1, 2, 3}) {
    const std::vector<Ball> balls = balls_of(draw_balls(tree, level));
    for (const ist::Sphere& sphere : tree.leaves) {
      const bool held = std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
        return (ball.center - sphere.center).norm() + sphere.radius <= ball.radius + k_rounding;
      });
      EXPECT_TRUE(held) << level;
    }
    // Leaves above the level have the colour of their own level.
    const auto last =
        std::count_if(balls.begin(), balls.end(), [](const Ball& ball) { return ball.colour == ramp_colour(1.0); });
    EXPECT_GT(last, 0) << level;
  }
  EXPECT_EQ(draw_balls(tree, 60).elements, tree.leaves.size());  // deeper than the tree: the spheres themselves
}

/// Voxel that a face with this centre and outward normal belongs to.
Eigen::Array3i voxel_behind(const vps::VoxelGrid& grid, const Eigen::Vector3d& center, const Eigen::Vector3d& normal) {
  return grid.coordinates(center - 0.5 * grid.size * normal).array().floor().cast<int>();
}

/// Checks faces one by one; `depth` says how deep a voxel is, negative for none.
template <class Depth>
void expect_faces(const Drawing& drawing, const vps::VoxelGrid& grid, double cut_x, const Depth& depth) {
  double deepest = 0.0;
  std::size_t faces = 0, voxels = 0;
  const auto drawn = [&](const Eigen::Array3i& v) {
    return depth(v) >= 0.0 && grid.center(v.x(), v.y(), v.z()).x() <= cut_x;
  };
  const Eigen::Array3i n = grid.voxels();
  for (int z = 1; z < n.z() - 1; ++z) {
    for (int y = 1; y < n.y() - 1; ++y) {
      for (int x = 1; x < n.x() - 1; ++x) {
        const Eigen::Array3i voxel(x, y, z);
        deepest = std::max(deepest, depth(voxel));
        if (!drawn(voxel)) continue;
        ++voxels;
        for (int axis = 0; axis < 3; ++axis) {
          for (const int side : {-1, 1}) {
            Eigen::Array3i next = voxel;
            next[axis] += side;
            faces += drawn(next) ? 0 : 1;
          }
        }
      }
    }
  }
  EXPECT_EQ(drawing.elements, voxels);
  EXPECT_EQ(drawing.triangles.size(), 2 * faces);
  ASSERT_EQ(drawing.vertices.size(), 4 * faces);
  ASSERT_EQ(drawing.colours.size(), 4 * faces);
  for (std::size_t first = 0; first < drawing.vertices.size(); first += 4) {
    const Eigen::Vector3d *const v = &drawing.vertices[first], normal = (v[1] - v[0]).cross(v[3] - v[0]).normalized();
    const Eigen::Array3i voxel = voxel_behind(grid, 0.25 * (v[0] + v[1] + v[2] + v[3]), normal);
    ASSERT_TRUE(drawn(voxel));
    ASSERT_FALSE(drawn(voxel + normal.array().round().cast<int>()));
    ASSERT_NEAR((v[2] - v[0]).norm(), std::sqrt(2.0) * grid.size, k_rounding);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_EQ(drawing.colours[first + i], depth_colour(depth(voxel), deepest));
  }
  // A closed surface around all voxels and nothing else.
  EXPECT_NEAR(as_mesh(drawing).volume(), static_cast<double>(voxels) * std::pow(grid.size, 3), k_near_rounding);
}

TEST(Drawing, VoxelsAreShownByLayerAndOnlyFromOutside) {
  const Mesh body = make_bumpy_sphere({.amplitude = 0.3}, 400);
  const vps::VoxelMap map = vps::VoxelMap::build(body, 0.09, 2);
  const auto layer = [&](const Eigen::Array3i& v) { return static_cast<double>(map.layer(v.x(), v.y(), v.z())); };
  expect_faces(draw_voxels(map), map.grid, k_uncut, layer);
  EXPECT_EQ(draw_voxels(map).elements, map.surface_voxels + map.inside_voxels);
  const Drawing open = draw_voxels(map, 0.03);
  expect_faces(open, map.grid, 0.03, layer);
  const std::set<Colour> whole_colours = [&] {
    const Drawing whole = draw_voxels(map);
    return std::set<Colour>(whole.colours.begin(), whole.colours.end());
  }();
  // Only surface voxels have outer faces; in the open body all layers have.
  EXPECT_EQ(whole_colours.size(), 1u);
  EXPECT_GT(std::set<Colour>(open.colours.begin(), open.colours.end()).size(), 6u);
}

TEST(Drawing, FieldShowsWhereItIsNegative) {
  const Mesh body = make_bumpy_sphere({.amplitude = 0.3}, 400);
  const vps::VoxelMap map = vps::VoxelMap::build(body, 0.09, vps::DistanceField::k_border);
  const vps::DistanceField field = vps::DistanceField::build(body, map);
  const auto depth = [&](const Eigen::Array3i& v) {
    const auto brick = static_cast<std::size_t>(field.table[field.grid.brick_of(v.x(), v.y(), v.z())]);
    const Eigen::Array3i at = v.unaryExpr([](int i) { return i % 8 + 1; });
    return -static_cast<double>(
        field.coefficients[brick * 1000 + static_cast<std::size_t>(at.x() + 10 * at.y() + 100 * at.z())]);
  };
  for (const double cut_x : {k_uncut, -0.02}) expect_faces(draw_field(field, cut_x), field.grid, cut_x, depth);
}

TEST(Drawing, PointsCarryInwardNormalsAndTheirAreas) {
  const Mesh body = make_box({{1.3, 1.1, 0.9}}, 12);
  const vps::PointShell shell = vps::PointShell::build(body, 0.1);
  const Drawing drawing = draw_points(shell);
  EXPECT_EQ(drawing.elements, shell.points.size());
  EXPECT_EQ(drawing.vertices, shell.points);
  EXPECT_EQ(drawing.normals, shell.normals);
  EXPECT_TRUE(drawing.triangles.empty());
  for (std::size_t i = 0; i < drawing.vertices.size(); ++i) {
    EXPECT_LT(drawing.vertices[i].dot(drawing.normals[i]), 0.0);  // the box stands about the origin
  }
  const double mean = body.area() / static_cast<double>(shell.points.size());
  const auto largest = std::max_element(shell.areas.begin(), shell.areas.end()) - shell.areas.begin();
  EXPECT_EQ(drawing.colours[static_cast<std::size_t>(largest)],
            ramp_colour(0.5 * shell.areas[static_cast<std::size_t>(largest)] / mean));
}

TEST(Drawing, ColoursTellLayersApart) {
  EXPECT_NE(ramp_colour(0.2), ramp_colour(0.25));
  EXPECT_EQ(ramp_colour(-1.0), ramp_colour(0.0));
  EXPECT_EQ(ramp_colour(2.0), ramp_colour(1.0));
  constexpr int k_visible = 20;  // of 255, in one of the three components
  for (int layer = 0; layer < 100; ++layer) {
    const Colour one = depth_colour(layer, 100), next = depth_colour(layer + 1, 100);
    int contrast = 0;
    for (std::size_t i = 0; i < 3; ++i) contrast = std::max(contrast, std::abs(int{one[i]} - int{next[i]}));
    EXPECT_GE(contrast, k_visible) << layer;
  }
  EXPECT_EQ(depth_colour(0, 0), ramp_colour(0));
}

}  // namespace
}  // namespace sixdof::cli
