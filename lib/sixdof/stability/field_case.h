#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/case.h>
#include <sixdof/stability/shots.h>

/// What the files of field cases share. Numbers are those of the threads; round bodies are tessellated so that an
/// extreme point lies where they touch, or the tessellation's error is part of the truth.
namespace sixdof::stability::field {

/// One query in both orders.
inline Case member(std::string name, std::string thread, double parameter, const Shot& shot, bool convex = false) {
  return same_answers(std::move(name), parameter, {shot, swapped(shot)}, convex, std::move(thread));
}

/// A surface of triangles at its own coordinates against another one, or a body.
inline Shot in_place(const MeshPointer& a, const MeshPointer& b) { return apart(a, b, {}); }

/// Surfaces that cross: distance 0.
inline Shot crossing(const MeshPointer& a, const MeshPointer& b, const Placement& X_AB = {}) {
  return overlapping(a, b, X_AB, k_unknown, 0.0);
}

inline Placement at(double x, double y, double z) { return {{x, y, z}, Eigen::Quaterniond::Identity()}; }

/// Rows as printed; made orthonormal by way of the nearest quaternion.
inline Eigen::Quaterniond rotation(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d R;
  R << x.transpose(), y.transpose(), z.transpose();
  return Eigen::Quaterniond(R).normalized();
}

}  // namespace sixdof::stability::field
