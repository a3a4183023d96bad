#pragma once

#include <string>

#include <sixdof/base/error.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// @param what needs the solid, for the message
/// @throws BadMesh with the reason if the mesh is not solid()
inline void require_solid(const Mesh& mesh, const std::string& what) {
  if (!mesh.solid()) throw BadMesh(mesh.name() + ": " + what + " needs a solid: " + mesh.why_not_solid());
}

}  // namespace sixdof
