#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/run_options.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/oracle/self_contacts.h>

/// What Mesh::solid() does not see: surfaces that pass through themselves, and shells that count twice.
///
/// **The winding rule.** Mesh::volume() and the volumes of the oracle (overlap.h) weight a point by the number of times
/// that the surface winds around it. Inside of a body it is 1, outside 0. A part that lies inside of k shells counts k
/// times; a shell that faces inwards in empty space counts -1 times. Yes/no and distance do not depend on it: they see
/// surfaces only.
namespace sixdof {

enum class ShellDefect {
  doubled,   ///< A copy of an earlier shell: its inside counts twice.
  nested,    ///< Lies in the material of other shells. The material behind it counts `layers` times, 2 or more.
  inverted,  ///< Faces inwards where there is no material. Its inside counts `layers` times, -1 or less.
};

struct DefectiveShell {
  ShellDefect defect = ShellDefect::doubled;
  std::uint32_t triangle = 0;                       ///< The shell's first, or the one the next two belong to.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< The middle of that triangle.
  int layers = 0;             ///< Winding number behind that triangle where nested, in front where inverted; else 0.
  std::size_t triangles = 0;  ///< Of the shell.
};

struct MeshCheck {
  static constexpr std::size_t k_listed = 10;

  SelfContacts contacts;
  std::size_t shells = 0;
  std::size_t open_shells = 0;  ///< They enclose nothing and are neither nested nor inverted, nor is what is in them.
  std::size_t doubled = 0, nested = 0, inverted = 0;  ///< Shells by defect.
  /// Closed shells in contact with others, besides copies: parts of them may lie in the material of others.
  std::size_t meeting = 0;
  std::size_t undecided = 0;          ///< Closed shells of which every triangle is in contact, but not with others.
  std::vector<DefectiveShell> first;  ///< The first k_listed, in the order of shells.

  bool clean() const { return contacts.pairs() + doubled + nested + inverted == 0; }
};

/// Finds contacts of the mesh with itself, and of each closed shell that meets no other the winding number at its
/// largest triangle in no contact.
/// @throws Interrupted; BadMesh if the mesh is too large for a Tree.
MeshCheck check_mesh(const Mesh& mesh, const RunOptions& options = {});

}  // namespace sixdof
