#pragma once

#include <sixdof/query/algorithm.h>

/// Contacts in other frames, and their mean.

namespace sixdof {

/// Of contacts in a frame C, the same in D.
inline Contacts moved(Contacts contacts, const Pose& X_DC) {
  for (Contact& each : contacts.list) {
    each.point = X_DC * each.point;
    each.normal = X_DC.R * each.normal;
  }
  return contacts;
}

/// Of contacts of (B, A), in B's frame with normals from B to A, those of (A, B), in A's frame.
inline Contacts exchanged(const Contacts& of_b_and_a, const Pose& X_AB) {
  Contacts contacts = moved(of_b_and_a, X_AB);
  for (Contact& each : contacts.list) each.normal = -each.normal;
  return contacts;
}

/// Direction of the sum of the normals (unit); zero where they cancel, and without a contact.
inline Eigen::Vector3d mean_normal(const Contacts& contacts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Contact& each : contacts.list) sum += each.normal;
  const double norm = sum.norm();
  // What is left of a thousand normals that cancel is less.
  constexpr double k_cancelled = 1e-9;
  return norm > k_cancelled ? Eigen::Vector3d(sum / norm) : Eigen::Vector3d::Zero();
}

}  // namespace sixdof
