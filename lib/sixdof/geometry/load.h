#pragma once

#include <filesystem>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

struct LoadOptions {
  /// PLY, OBJ, OFF, STL: drops faces with a corner that is not finite, and counts them, instead of refusing the file.
  bool drop_faces_not_finite = false;
};

/// Reads a triangle mesh; the format follows from the file name's extension (any case):
///
/// | extension    | precision of coordinates | notes                                                              |
/// |--------------|--------------------------|--------------------------------------------------------------------|
/// | .ply         | as stored, up to double  | ascii, binary of both byte orders; faces and triangle strips       |
/// | .off         | double                   | OFF with ST, C, N (ignored), 4 (divided by it), n (3 only); ascii  |
/// | .obj         | double                   | statements that hold no polygons are skipped                       |
/// | .stl         | ascii double, binary float | normals are ignored: the order of the corners says what is outside |
/// | .gltf, .glb  | float, transforms double | version 2.0; the default scene (below)                        |
/// | .3ds         | float                    | read by assimp; vertices are in world coordinates as stored         |
/// | .dae, .fbx, .x3d and others | float     | whatever else assimp reads                                         |
///
/// Coordinates keep the file's unit and axes, with one exception: COLLADA (.dae) states its unit, and is scaled to
/// metres. Its axes stay, whatever it says points up: so a part is where its STL or OBJ file has it, as RViz, Gazebo
/// and MoveIt show it. Words behind a file's name ask for something else: `part.dae#as-stored` does not scale, and
/// `part.dae#y-up` scales and turns so that y points up, as in a glTF file of the part. MeshRepairs::notes says what a
/// file states and what was done (COLLADA, FBX). `#as-stored` is allowed behind any name. Faces with more than three
/// corners are triangulated as triangulate.h says. A byte order mark before a text is skipped.
///
/// Errors are: a count, index or number that is wrong, and bytes behind the end that are not blank. The last line needs
/// no line break, so a text that is cut off within its last number is read with what is left of that number. OBJ holds
/// no counts: a file cut off between two faces is a valid file of fewer faces. A vertex that is not finite is an error
/// where a face uses it; so is an OBJ vertex whose fourth value, the weight of rational curves, is not 1.
///
/// What a format does not foresee, but has one meaning, is read: forgiven.h lists the kinds. Nothing is forgiven or
/// repaired in silence: Mesh::repairs() counts that, polygons that are not flat or cross themselves, skipped
/// statements, and what Mesh::build welded or dropped.
///
/// glTF: sparse accessors, integer coordinates (KHR_mesh_quantization), strips and fans are read,
/// EXT_mesh_gpu_instancing makes copies. Extensions that may change the surface and that the file requires are refused
/// by their name, such as compression (Draco, meshopt); those of materials, textures and lights change nothing here. A
/// file without scenes gives all its nodes. Where the file has several scenes, morph targets, skins or animations, a
/// note says what was read.
///
/// Assimp holds coordinates and transforms in single precision (relative rounding 6e-8). The transforms of a scene's
/// nodes are multiplied and applied in double precision; a mirroring one reverses the corners, so that outside stays
/// outside. All meshes of the scene become one. Points and lines are skipped; bones, morph targets and animations are
/// not applied. An index out of range, a coordinate that is not finite, a count that does not fit the file, and what
/// assimp's own validation finds are errors. Damaged files may make assimp crash or never return: it reads in a process
/// of its own (base/separate_process.h), with limits of time and memory that grow with the file (60 s and 2 GB for a
/// small one). What ends it is an error too.
///
/// A mesh that save_mesh() wrote as PLY, OBJ or OFF comes back bit for bit, with the same hash. The result does not
/// depend on the process's locale.
/// Mesh::name() becomes the file's name without its folder and extension.
/// @throws BadFile naming the file, the place (element from 0, or line from 1) and the cause.
Mesh load_mesh(const std::filesystem::path& file, const LoadOptions& options = {});

/// The file that load_mesh() reads for a name: "part.dae" for "part.dae#as-stored".
std::filesystem::path mesh_file_of(const std::filesystem::path& name);

}  // namespace sixdof
