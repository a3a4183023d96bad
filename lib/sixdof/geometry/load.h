#pragma once

#include <filesystem>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Reads a triangle mesh; the format follows from the file name's extension (any case):
///
/// | extension    | precision of coordinates | notes                                                              |
/// |--------------|--------------------------|--------------------------------------------------------------------|
/// | .ply         | as stored, up to double  | ascii, binary of both byte orders                                  |
/// | .off         | double                   | OFF, and COFF, NOFF, STOFF (colours, normals ignored); ascii       |
/// | .obj         | double                   | statements that hold no polygons are skipped                       |
/// | .stl         | ascii double, binary float | normals are ignored: the order of the corners says what is outside |
/// | .gltf, .glb  | float                    | version 2.0; the default scene; read by assimp (below)              |
/// | .3ds         | float                    | read by assimp; vertices are in world coordinates as stored         |
/// | .dae, .fbx, .x3d and others | float     | whatever else assimp reads                                         |
///
/// Coordinates keep the file's unit and frame; only COLLADA is converted, to metres with y pointing up. Faces with more
/// than three corners are triangulated as triangulate.h says. A byte order mark before a text is skipped.
///
/// Errors are: a count, index or number that is wrong, and bytes behind the end. The last line needs no line break, so
/// a text that is cut off within its last number is read with what is left of that number. OBJ holds no counts: a file
/// cut off between two faces is a valid file of fewer faces. Nothing is repaired in silence: polygons that are not flat
/// or cross themselves, skipped statements, and what Mesh::build welded or dropped are counted in Mesh::repairs().
///
/// Assimp holds coordinates and transforms in single precision (relative rounding 6e-8). The transforms of a scene's
/// nodes are multiplied and applied in double precision; a mirroring one reverses the corners, so that outside stays
/// outside. All meshes of the scene become one. Points and lines are skipped; bones, morph targets and animations are
/// not applied. An index out of range, a coordinate that is not finite, a count that does not fit the file, and what
/// assimp's own validation finds are errors. Beyond that assimp is trusted: a damaged file of a format other than glTF
/// and 3DS may make it crash or never return (seen with COLLADA and X3D).
///
/// A mesh that save_mesh() wrote as PLY, OBJ or OFF comes back bit for bit, with the same hash. The result does not
/// depend on the process's locale.
/// Mesh::name() becomes the file's name without its folder and extension.
/// @throws BadFile naming the file, the place (element from 0, or line from 1) and the cause.
Mesh load_mesh(const std::filesystem::path& file);

}  // namespace sixdof
