#pragma once

#include <filesystem>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// What load_mesh() may do besides what it always does.
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
/// Coordinates keep the file's unit and axes. The exception is COLLADA (.dae), which states its unit: it is scaled to
/// metres, and its axes stay, as in RViz, Gazebo and MoveIt. A suffix of the file's name asks for something else:
/// `part.dae#as-stored` does not scale; `part.dae#y-up` scales and turns so that y points up. MeshRepairs::notes says
/// what a COLLADA or FBX file states and what was done.
///
/// Faces with more than three corners are triangulated (triangulate.h). Deviations from a format that have one possible
/// meaning are accepted and counted in Mesh::repairs(); forgiven.h lists them. A wrong count, index or number is an
/// error, and so are bytes behind the end that are not blank, and a vertex that a face uses and that is not finite or,
/// in OBJ, has a fourth value (a weight) other than 1. Two kinds of truncated text cannot be detected: a file that ends
/// within its last number, and an OBJ file that ends between two faces.
///
/// glTF: sparse accessors, integer coordinates (KHR_mesh_quantization), strips, fans and copies
/// (EXT_mesh_gpu_instancing) are read. A file that requires another extension that may change the surface, such as
/// compression (Draco, meshopt), is refused. A file without scenes gives all its nodes. A note says what was left out:
/// other scenes, morph targets, skins, animations.
///
/// Assimp holds coordinates and transforms in single precision (relative rounding 6e-8). All meshes of a scene become
/// one, with the transforms of their nodes multiplied and applied in double precision; a transform that mirrors
/// reverses the corners. Points, lines, bones, morph targets and animations are left out. Since damaged files may make
/// assimp crash or hang, it runs in a process of its own (base/separate_process.h) with limits of time and memory that
/// grow with the file (60 s and 2 GB for a small one); exceeding them is an error.
///
/// A mesh that save_mesh() wrote as PLY, OBJ or OFF comes back bit for bit, with the same hash. The locale has no
/// effect. Mesh::name() becomes the file's name without its folder and extension.
/// @throws BadFile naming the file, the place (element from 0, or line from 1) and the cause.
Mesh load_mesh(const std::filesystem::path& file, const LoadOptions& options = {});

/// The file that load_mesh() reads for a name: "part.dae" for "part.dae#as-stored".
std::filesystem::path mesh_file_of(const std::filesystem::path& name);

}  // namespace sixdof
