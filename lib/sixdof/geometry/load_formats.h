#pragma once

// What the readers of the formats share; only lib/geometry/load*.cpp include this.

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof::loading {

/// A file in memory, and the way to complain about it.
struct Source {
  std::filesystem::path path;
  std::string bytes;

  [[noreturn]] void fail(const std::string& cause) const;
  [[noreturn]] void fail(const std::string& place, const std::string& cause) const;
};

/// Reads a regular file whole. @throws BadFile
Source read_source(const std::filesystem::path& file);

/// What a reader delivers: indices are in range and coordinates finite, nothing is welded yet.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

// OBJ, OFF, PLY and STL are read by this project's own readers, not by assimp, because assimp (5.2) keeps coordinates
// in single precision: a torus of 20,000 vertices, saved as PLY, OFF or OBJ with all its digits, came back with another
// hash and vertices moved by up to 2.6e-8 of its diagonal, while configuration sets know their meshes by hash and
// distances are compared at 1e-12. Assimp also hangs on a PLY without end_header and takes a truncated OFF for whole.
Surface read_obj(const Source& source);
Surface read_off(const Source& source);
Surface read_ply(const Source& source);
Surface read_stl(const Source& source);

// These formats hold single precision anyway. Assimp decodes them from a file that is checked and written anew first.
Surface read_3ds(const Source& source);
Surface read_gltf(const Source& source);

}  // namespace sixdof::loading
