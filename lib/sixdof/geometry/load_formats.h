#pragma once

// What the readers and writers of mesh files share; only files of lib/sixdof/geometry include this.

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/triangulate.h>

namespace sixdof::loading {

/// The extension of a file's name with its dot, in lower case: ".ply".
std::string lower_case_extension(const std::filesystem::path& file);

/// A file in memory.
struct Source {
  std::filesystem::path path;
  std::string bytes;

  /// Throws a BadFile that names the file. @param place in the file: "line 7", "face 3".
  [[noreturn]] void fail(const std::string& cause) const;
  [[noreturn]] void fail(const std::string& place, const std::string& cause) const;
};

/// Reads a regular file whole. @throws BadFile
Source read_source(const std::filesystem::path& file);

/// What a reader returns: indices are in range and coordinates finite, nothing is welded yet.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  MeshRepairs repairs;
};

/// Counts one repair. @param place of what was repaired in the file.
void count_repair(FileRepairs& repairs, const std::string& place);

/// Counts a polygon that triangulate() found to be other than simple.
/// @throws BadFile if the polygon is too large to be triangulated.
void count_polygon(const Source& source, PolygonShape shape, const std::string& place, MeshRepairs& repairs);

// OBJ, OFF, PLY and STL are not left to assimp (5.2): it holds coordinates in single precision only, does not return
// from a PLY file without end_header, and accepts a truncated OFF file.
Surface read_obj(const Source& source);
Surface read_off(const Source& source);
Surface read_ply(const Source& source);
Surface read_stl(const Source& source);

}  // namespace sixdof::loading
