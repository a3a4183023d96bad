#include "bench/cli/structure_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <sixdof/models/recipe.h>

namespace sixdof::cli {
namespace {

using vps::VoxelGrid;

/// Of two colours, `part` of the way from one to the other.
Colour between(const Colour& from, const Colour& to, double part) {
  Colour colour;
  for (std::size_t i = 0; i < 3; ++i) {
    colour[i] = static_cast<std::uint8_t>(std::lround((1.0 - part) * from[i] + part * to[i]));
  }
  return colour;
}

/// Adds tessellated balls.
struct BallPainter {
  double cut_x;
  Drawing drawing = {};
  Mesh unit = make_sphere({}, k_ball_triangles);

  void add(const ist::Sphere& ball, const Colour& colour) {
    if (!(ball.center.x() <= cut_x)) return;
    const auto first = static_cast<std::uint32_t>(drawing.vertices.size());
    for (const Eigen::Vector3d& v : unit.vertices()) drawing.vertices.push_back(ball.center + ball.radius * v);
    drawing.colours.insert(drawing.colours.end(), unit.vertices().size(), colour);
    for (const Triangle& t : unit.triangles()) drawing.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    ++drawing.elements;
  }
};

/// Adds the balls below `node`, whose children are at `level`, down to `last`.
void add_level(const ist::SphereTree& tree, std::size_t node, int level, int last, BallPainter& painter) {
  const std::int32_t below = tree.first_child[node];
  for (std::size_t slot = 0; slot < tree.children(node); ++slot) {
    if (level == last || below < 0) {
      painter.add(tree.ball(node, slot), ramp_colour(static_cast<double>(level) / last));
    } else {
      add_level(tree, static_cast<std::size_t>(below) + slot, level + 1, last, painter);
    }
  }
}

/// Counter-clockwise seen from outside. Neighbouring voxels compute equal coordinates for common corners.
void add_face(const VoxelGrid& grid, const Eigen::Array3i& voxel, int axis, int side, const Colour& colour,
              Drawing& drawing) {
  const auto first = static_cast<std::uint32_t>(drawing.vertices.size());
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  constexpr std::array<std::pair<int, int>, 4> k_corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (const auto& [along_u, along_v] : k_corners) {
    Eigen::Array3i corner = voxel;
    corner[axis] += side > 0 ? 1 : 0;
    corner[u] += side > 0 ? along_u : 1 - along_u;  // mirrored, so that both sides are counter-clockwise
    corner[v] += along_v;
    drawing.vertices.push_back(grid.origin + grid.size * corner.cast<double>().matrix());
  }
  drawing.colours.insert(drawing.colours.end(), k_corners.size(), colour);
  drawing.triangles.push_back({first, first + 1, first + 2});
  drawing.triangles.push_back({first, first + 2, first + 3});
}

/// Draws the faces between the voxels of a body and all others. `depth_of(x, y, z)` is the voxel's depth in voxels,
/// negative outside the body; `stored(brick)` is false for bricks without a voxel of the body.
Drawing draw_body(const VoxelGrid& grid, double cut_x, const auto& stored, const auto& depth_of) {
  const auto depth = [&](const Eigen::Array3i& v) { return depth_of(v.x(), v.y(), v.z()); };
  const auto drawn = [&](const Eigen::Array3i& v) {
    return grid.center(v.x(), v.y(), v.z()).x() <= cut_x && depth(v) >= 0.0;
  };
  // The body's voxels; none is at the grid's border (VoxelGrid::around).
  std::vector<Eigen::Array3i> voxels;
  double deepest = 0.0;
  for (int z = 0; z < grid.voxels().z(); ++z) {
    for (int y = 0; y < grid.voxels().y(); ++y) {
      for (int x = 0; x < grid.voxels().x(); ++x) {
        if (!stored(grid.brick_of(x, y, z)) || !(depth_of(x, y, z) >= 0.0)) continue;
        voxels.emplace_back(x, y, z);
        deepest = std::max(deepest, depth_of(x, y, z));
      }
    }
  }
  Drawing drawing;
  for (const Eigen::Array3i& voxel : voxels) {
    if (!drawn(voxel)) continue;
    ++drawing.elements;
    const Colour colour = depth_colour(depth(voxel), deepest);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        Eigen::Array3i next = voxel;
        next[axis] += side;
        if (!drawn(next)) add_face(grid, voxel, axis, side, colour, drawing);
      }
    }
  }
  return drawing;
}

}  // namespace

Colour ramp_colour(double fraction) {
  // Five points of matplotlib's colour map viridis, whose lightness increases uniformly.
  constexpr std::array<Colour, 5> k_points{{{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(fraction, 0.0, 1.0) * (k_points.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), k_points.size() - 2);
  return between(k_points[below], k_points[below + 1], at - static_cast<double>(below));
}

Colour depth_colour(double depth, double deepest) {
  constexpr double k_darkening = 0.3;
  const Colour colour = ramp_colour(deepest > 0.0 ? depth / deepest : 0.0);
  return std::lround(depth) % 2 == 0 ? colour : between(colour, {}, k_darkening);
}

Drawing draw_spheres(const ist::SphereTree& tree, double cut_x) {
  double largest = 0.0;
  for (const ist::Sphere& sphere : tree.leaves) largest = std::max(largest, sphere.radius);
  BallPainter painter{cut_x};
  for (const ist::Sphere& sphere : tree.leaves) painter.add(sphere, ramp_colour(sphere.radius / largest));
  return painter.drawing;
}

Drawing draw_balls(const ist::SphereTree& tree, int level, double cut_x) {
  BallPainter painter{cut_x};
  add_level(tree, 0, 1, level, painter);
  return painter.drawing;
}

Drawing draw_voxels(const vps::VoxelMap& map, double cut_x) {
  const auto stored = [&](std::size_t brick) { return map.table[brick] >= 0; };
  const auto depth = [&](int x, int y, int z) { return static_cast<double>(map.layer(x, y, z)); };
  return draw_body(map.grid, cut_x, stored, depth);
}

Drawing draw_field(const vps::DistanceField& field, double cut_x) {
  const auto stored = [&](std::size_t brick) { return field.table[brick] != 0; };
  const auto depth = [&](int x, int y, int z) {
    constexpr int k = vps::DistanceField::k_brick_edge, k_edge = VoxelGrid::k_edge;
    const int index = ((z % k_edge + 1) * k + y % k_edge + 1) * k + x % k_edge + 1;
    const auto brick = static_cast<std::size_t>(field.table[field.grid.brick_of(x, y, z)]);
    return -static_cast<double>(
        field.coefficients[brick * vps::DistanceField::k_brick_coefficients + static_cast<std::size_t>(index)]);
  };
  return draw_body(field.grid, cut_x, stored, depth);
}

Drawing draw_points(const vps::PointShell& shell, double cut_x) {
  const double mean =
      std::accumulate(shell.areas.begin(), shell.areas.end(), 0.0) / static_cast<double>(shell.areas.size());
  Drawing drawing;
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    if (!(shell.points[i].x() <= cut_x)) continue;
    drawing.vertices.push_back(shell.points[i]);
    drawing.normals.push_back(shell.normals[i]);
    drawing.colours.push_back(ramp_colour(0.5 * shell.areas[i] / mean));
  }
  drawing.elements = drawing.vertices.size();
  return drawing;
}

}  // namespace sixdof::cli
