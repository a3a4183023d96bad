#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/run_options.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/triangle_contact.h>

namespace sixdof {

/// Two triangles of a mesh that meet beyond the vertices they share.
struct SelfContact {
  std::uint32_t a = 0, b = 0;  ///< Indices into Mesh::triangles(), a < b.
  ContactKind kind = ContactKind::crossing;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< TriangleContact::point.
};

/// All contacts of a mesh with itself.
struct SelfContacts {
  static constexpr std::size_t k_listed = 10;

  std::size_t crossing = 0, coplanar = 0, coincident = 0;  ///< Pairs of triangles, by ContactKind.
  std::vector<SelfContact> first;                          ///< The first k_listed, by (a, b).
  /// For each triangle of the mesh: bit k_within if it has a contact, and k_across if one with another group that is
  /// not coincident.
  std::vector<std::uint8_t> touched;
  static constexpr std::uint8_t k_within = 1, k_across = 2;

  std::size_t pairs() const { return crossing + coplanar + coincident; }
};

/// Tests all pairs of triangles whose boxes overlap, without those that are exactly collinear (Mesh::repairs() has
/// them). Time grows with the number of triangles and of contacts.
/// @param tree of the mesh
/// @param group of each triangle, e.g. its shell; empty: all are in one
/// @throws Interrupted
SelfContacts find_self_contacts(const Mesh& mesh, const Tree& tree, std::span<const std::uint32_t> group = {},
                                const RunOptions& options = {});

}  // namespace sixdof
