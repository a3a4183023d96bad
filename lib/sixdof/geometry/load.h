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
/// | .obj         | double                   | points, lines, groups and materials hold no surface and are ignored|
/// | .stl         | ascii double, binary float | normals are ignored: the order of the corners says what is outside |
/// | .gltf, .glb  | float                    | version 2.0; the default scene, node transforms applied            |
/// | .3ds         | float                    | world coordinates as stored; the key framer is ignored             |
///
/// Coordinates are untouched (the file's unit and frame). Faces with more than three corners are triangulated as
/// triangulate.h says. Nothing is mended in silence: a count, index or number that is wrong, a text whose last line is
/// not ended by a line break (it may be cut off within a number) and bytes behind the end are errors; what
/// Mesh::build welded or dropped is in Mesh::repairs(). A mesh that save_mesh() wrote as PLY, OBJ or OFF comes back bit
/// for bit, with the same hash. The result does not depend on the process's locale. OBJ holds no counts: one cut off at
/// the end of a line is a valid file of fewer faces.
/// Mesh::name() becomes the file's name without its folder and extension.
/// @throws BadFile naming the file, the place (element from 0, or line from 1) and the cause.
Mesh load_mesh(const std::filesystem::path& file);

}  // namespace sixdof
