#pragma once

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {

/// Reads a file of any format that assimp reads. All meshes of the scene become one surface.
///
/// - **Precision.** Assimp holds coordinates and transforms in single precision (relative rounding 6e-8). Transforms
///   are multiplied and applied in double precision.
/// - **Frame.** The transforms of the nodes are applied; the unit is the file's. Assimp converts COLLADA to metres with
/// y
///   pointing up. A mirroring transform reverses the corners, so that outside stays outside. The vertices of a 3DS file
///   are in world coordinates: no transform is applied.
/// - **Parts.** Of a glTF file, the default scene is read. Points and lines are skipped. Bones, morph targets and
///   animations are not applied.
/// - **Checks.** An index out of range, a coordinate that is not finite, a count that does not fit the file, and what
///   assimp's own validation finds are errors. Beyond that assimp is trusted: a damaged file of a format other than
///   glTF and 3DS may make it crash or never return (seen with COLLADA and X3D).
///
/// @throws BadFile
Surface read_by_assimp(const std::filesystem::path& file);

}  // namespace sixdof::loading
