#pragma once

#include <limits>
#include <vector>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/save.h>

/// Pictures of the structures that algorithms prepare: coloured triangles or points, in the mesh's frame and unit.

namespace sixdof::cli {

struct Drawing {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  ///< One per vertex, or none at all.
  std::vector<Colour> colours;           ///< One per vertex.
  std::vector<Triangle> triangles;       ///< None in a cloud of points.
  std::size_t elements = 0;              ///< Spheres, voxels or points that were drawn.
};

/// Draws only what has its centre at x <= this (mesh's frame): opens a body to the view.
constexpr double k_uncut = std::numeric_limits<double>::infinity();

/// Every drawn ball has this many vertices, all of them on the ball's surface, and triangles.
constexpr std::size_t k_ball_vertices = 42;
constexpr std::size_t k_ball_triangles = 80;

/// From dark blue (0, and less) over green to yellow (1, and more).
Colour ramp_colour(double share);
/// Colour of a voxel `depth` voxels deep in a body whose deepest is `deepest`: along the ramp, every other voxel layer
/// darker, so that layers can be counted.
Colour depth_colour(double depth, double deepest);

/// The packed spheres. Colour: ramp_colour(radius / largest radius).
Drawing draw_spheres(const ist::SphereTree& tree, double cut_x = k_uncut);

/// The balls that the hierarchy has `level` steps below its root's bound (1: the root's children), and the packed
/// spheres that are nearer to the root than that. Colour: ramp_colour(level of the ball / `level`).
Drawing draw_balls(const ist::SphereTree& tree, int level, double cut_x = k_uncut);

/// Voxels with layer v >= 0. Faces between two of them are left out. Colour: depth_colour(v, greatest v).
Drawing draw_voxels(const vps::VoxelMap& map, double cut_x = k_uncut);

/// Voxels whose sample f is not positive, likewise. Colour: depth_colour(-f, greatest -f).
Drawing draw_field(const vps::DistanceField& field, double cut_x = k_uncut);

/// Points with their inward normals, no triangles. Colour: ramp_colour(half the point's area over the mean area).
Drawing draw_points(const vps::PointShell& shell, double cut_x = k_uncut);

}  // namespace sixdof::cli
