#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Writes a mesh, whole or not at all; the format follows from the extension (any case):
///
/// | extension | coordinates                                                  | load_mesh() gives the same hash |
/// |-----------|--------------------------------------------------------------|---------------------------------|
/// | .ply      | double, binary little endian                                 | yes                             |
/// | .off      | decimal, shortest that reads back to the same bits (<= 17 digits) | yes                        |
/// | .obj      | as .off                                                      | yes                             |
/// | .stl      | binary, rounded to float; vertices are not shared            | no                              |
///
/// STL rounds each coordinate by up to 6e-8 of its magnitude, so that nearby vertices may fall together and thin parts
/// collapse: use it for exchange only.
/// @throws BadFile if the extension is another, a coordinate does not fit the format, or writing fails.
void save_mesh(const Mesh& mesh, const std::filesystem::path& file);

using Colour = std::array<std::uint8_t, 3>;  ///< Red, green, blue.

/// What a PLY file can hold. The spans must outlive the call only.
struct PlyContent {
  std::span<const Eigen::Vector3d> vertices;             ///< [vertex], in any length unit.
  std::span<const Triangle> triangles;                   ///< [triangle], indices into `vertices`; may be empty.
  std::span<const Colour> vertex_colours = {};           ///< One per vertex, or empty for none.
  std::span<const Eigen::Vector3d> vertex_normals = {};  ///< One per vertex, or empty for none.
};

/// Writes binary little-endian PLY in double precision, whole or not at all. Without triangles it is a cloud of points.
/// @throws BadArgument if there are colours or normals, but not one per vertex, or an index is out of range; BadFile if
/// writing fails.
void save_ply(const PlyContent& content, const std::filesystem::path& file);

}  // namespace sixdof
