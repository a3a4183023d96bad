#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

/// The solids of the scenarios: closed manifold meshes with exact coordinates.

namespace sixdof {

/// The regular polygon that stands for a circle.
enum class RoundParts {
  inscribed,   ///< Vertices on the circle: the solid is too small, by O(1 / facets^2).
  equal_area,  ///< The polygon has the circle's area: areas of cross-sections (cylinder, cone) and the volume of a
               ///< sphere are exact.
};

/// Radius of the polygon's vertices for a circle of radius `r`.
double polygon_radius(double r, int facets, RoundParts round);

/// Counter-clockwise vertices of the polygon about the origin, vertex j at angle 2 pi (j + 1/2) / facets.
std::vector<Eigen::Vector2d> polygon(double r, int facets, RoundParts round);

/// Axis-aligned box: 12 triangles with exactly these corners.
Mesh box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::string name);

/// Cone with its apex at the origin, opening along +y up to `height`, where its radius is `radius`. Its flank has one
/// triangle per facet, so all cross-sections are similar polygons.
Mesh cone_solid(double radius, double height, int facets, RoundParts round, std::string name);

/// Cylinder about the z axis, centred at the origin.
Mesh cylinder_solid(double radius, double length, int facets, RoundParts round, std::string name);

/// Sphere about the origin by meridians (`facets`) and parallels (`facets` / 2 bands), poles on the z axis. With
/// equal_area the VOLUME of the mesh is the ball's.
Mesh sphere_solid(double radius, int facets, RoundParts round, std::string name);

/// Geometry of the pins and holes: a rectangle of width b (along x) and depth a (along y) centred at the z axis, with a
/// square of side c at (-b/4, 0) and a circle of radius r at (+b/4, 0).
struct PinsShape {
  double width = 80.0;            ///< b, along x.
  double depth = 40.0;            ///< a, along y; also the pins' length and the block's height along z.
  double square_side = 20.0;      ///< c.
  double round_radius = 10.0;     ///< r.
  double plate_thickness = 10.0;  ///< Of the plate that carries the pins.
  int facets = 96;                ///< Of the round pin and its hole.
  RoundParts round = RoundParts::equal_area;
};

/// Block from z = -a to z = 0 with both holes through it. Genus 2.
Mesh holes_solid(const PinsShape& shape, std::string name);

/// Plate from z = 0 to z = plate_thickness with both pins below it down to z = -a. The pins' walls have exactly the
/// coordinates of the holes' walls.
Mesh pins_solid(const PinsShape& shape, std::string name);

}  // namespace sixdof
