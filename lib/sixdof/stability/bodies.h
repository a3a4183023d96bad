#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/stability/case.h>

/// Small bodies by formula, whose extreme points are known to the last bit.
namespace sixdof::stability {

using Points = std::vector<Eigen::Vector3d>;

/// A mesh as it is given.
MeshPointer built(Points points, std::vector<Triangle> triangles, std::string name = "stability");

/// Twelve triangles, centred at the origin.
MeshPointer box(const Eigen::Vector3d& size);

/// Corner i at x, y, z low or high by bits 0, 1, 2 of i. @pre the faces are flat
MeshPointer hexahedron(const std::array<Eigen::Vector3d, 8>& corners);

/// Closed, facing outwards whatever the order of the points.
MeshPointer tetrahedron(const std::array<Eigen::Vector3d, 4>& corners);

/// A surface of three points per triangle; open.
MeshPointer triangles(const Points& corners);

/// A ring of the surface of revolution: radius and height.
struct Level {
  double radius, z;
};

/// Surface of revolution about z through levels from the lowest to the highest. A level of radius 0 at an end is a
/// pole; otherwise the end is closed by a fan about a point on the axis. Every ring has a vertex at angle 0.
MeshPointer revolved(const std::vector<Level>& levels, std::size_t sides);

/// Poles at z = +-radius.
MeshPointer sphere(double radius, std::size_t sides = 16);
MeshPointer cylinder(double radius, double half_height, std::size_t sides = 24);
MeshPointer capsule(double radius, double half_height, std::size_t sides = 16);

/// p -> factor * R p + t of every vertex.
MeshPointer transformed(const Mesh& mesh, const Placement& motion, double factor = 1.0);

/// A rotation by `angle` (radians) about a unit vector.
inline Eigen::Quaterniond about(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

/// The rotation that turns z to a direction.
Placement z_to(const Eigen::Vector3d& direction, const Eigen::Vector3d& t = Eigen::Vector3d::Zero());

}  // namespace sixdof::stability
