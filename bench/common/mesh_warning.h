#pragma once

#include <string>

#include <sixdof/geometry/mesh.h>
#include <sixdof/oracle/mesh_check.h>

namespace sixdof {

/// "12 pairs of triangles meet, 1 shell is doubled": the counts above zero; empty if all are.
std::string summary(const MeshCheck& check);

/// One line about a solid that intersects itself, so that volumes count some parts of it more than once
/// (oracle/mesh_check.h). Empty if it does not, if the mesh is no solid, or if the check takes longer than
/// k_longest_check_s or is interrupted.
/// The verdict is kept in the cache on disk (base/cache.h) by the mesh's content hash.
/// @param argument that stands for the mesh on a command line
std::string mesh_warning(const Mesh& mesh, const std::string& argument);

/// Several times what a mesh of a million triangles takes if few of its triangles intersect.
constexpr double k_longest_check_s = 10.0;

}  // namespace sixdof
