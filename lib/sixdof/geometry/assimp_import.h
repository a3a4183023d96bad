#pragma once

#include <string>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {

/// What assimp reads from a checked file in memory.
struct AssimpRequest {
  const char* format;  ///< "glb" or "3ds": the only importer that is registered.
  const std::string& bytes;
  bool apply_transforms;  ///< Apply the nodes' transforms, or take the meshes as they are stored.
  std::size_t triangles;  ///< How many triangles must come out.
};

/// Lets assimp decode a file whose structure has been checked, and checks what comes out: its count of triangles, every
/// index and every coordinate. Assimp cannot be stopped once it runs, so the guard against hangs and crashes is that it
/// only sees files that the caller wrote anew from checked parts, without materials, images, animations and the like.
/// Transforms are accumulated in double precision, from the single precision in which assimp keeps them; a mirroring
/// one turns the triangles, so that outside stays outside.
/// @throws BadFile naming source.path
Surface import_by_assimp(const Source& source, const AssimpRequest& request);

}  // namespace sixdof::loading
