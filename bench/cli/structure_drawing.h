#pragma once

#include <limits>
#include <vector>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/save.h>

/// Drawings of the structures that algorithms prepare: coloured triangles or points, in the mesh's frame and unit.

namespace sixdof::cli {

struct Drawing {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  ///< One per vertex, or none at all.
  std::vector<Colour> colours;           ///< One per vertex.
  std::vector<Triangle> triangles;       ///< None in a cloud of points.
  std::size_t elements = 0;              ///< Spheres, voxels or points that were drawn.
};

/// Every drawing leaves out elements whose centre has x > cut_x (mesh's frame), which opens a body to the view.
constexpr double k_uncut = std::numeric_limits<double>::infinity();

/// Vertices (all on the ball's surface) and triangles of every ball drawn.
constexpr std::size_t k_ball_vertices = 42;
constexpr std::size_t k_ball_triangles = 80;

/// From dark blue (<= 0) over green to yellow (>= 1).
Colour ramp_colour(double fraction);
/// Colour of a voxel `depth` voxels deep in a body whose greatest depth is `deepest`: along the ramp, every second
/// layer darker, so that layers can be counted.
Colour depth_colour(double depth, double deepest);

/// The packed spheres. Colour: ramp_colour(radius / largest radius).
Drawing draw_spheres(const ist::SphereTree& tree, double cut_x = k_uncut);

/// The balls of the hierarchy at `level` (1: the root's children), and the packed spheres at lower levels.
/// Colour: ramp_colour(level of the ball / `level`).
Drawing draw_balls(const ist::SphereTree& tree, int level, double cut_x = k_uncut);

/// The outer faces of the voxels with layer v >= 0. Colour: depth_colour(v, greatest v).
Drawing draw_voxels(const vps::VoxelMap& map, double cut_x = k_uncut);

/// The same of the voxels whose coefficient f of the distance field is not positive. Colour: depth_colour(-f, greatest
/// -f).
Drawing draw_field(const vps::DistanceField& field, double cut_x = k_uncut);

/// Points with their inward normals, no triangles. Colour: ramp_colour(half the point's area over the mean area).
Drawing draw_points(const vps::PointShell& shell, double cut_x = k_uncut);

}  // namespace sixdof::cli
