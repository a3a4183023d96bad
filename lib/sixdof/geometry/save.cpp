#include <sixdof/geometry/save.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof {
namespace {

// The format "{}" of fmt writes the shortest decimal that reads back to the same double, in every locale.
void save_obj(const Mesh& mesh, const std::filesystem::path& file) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# {} vertices, {} triangles\n", mesh.vertices().size(), mesh.triangles().size());
  for (const auto& p : mesh.vertices()) fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles()) {
    fmt::format_to(out, "f {} {} {}\n", std::uint64_t{t[0]} + 1, std::uint64_t{t[1]} + 1, std::uint64_t{t[2]} + 1);
  }
  write_file_atomically(file, {text.data(), text.size()});
}

void save_off(const Mesh& mesh, const std::filesystem::path& file) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "OFF\n{} {} {}\n", mesh.vertices().size(), mesh.triangles().size(), mesh.topology().edges);
  for (const auto& p : mesh.vertices()) fmt::format_to(out, "{} {} {}\n", p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles()) fmt::format_to(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  write_file_atomically(file, {text.data(), text.size()});
}

template <class T>
void append_point(std::string& bytes, const Eigen::Vector3d& p) {
  for (const double coordinate : p) loading::append_little_endian(bytes, static_cast<T>(coordinate));
}

/// Unit normal, or zero where the triangle has no area, as the format's readers expect.
Eigen::Vector3d unit_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  // Scaled first: the product of lengths of 1e-200 would underflow.
  const double size = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(size > 0.0) || !std::isfinite(size)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = (u / size).cross(v / size);
  const double length = normal.norm();
  return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

void save_stl(const Mesh& mesh, const std::filesystem::path& file) {
  constexpr std::size_t k_header_bytes = 80;
  constexpr std::size_t k_triangle_bytes = 50;
  const auto& vertices = mesh.vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i].cwiseAbs().maxCoeff() > static_cast<double>(std::numeric_limits<float>::max())) {
      throw BadFile(file.string(), fmt::format("vertex {}", i), "a coordinate is too large for STL's single precision");
    }
  }
  // A header that begins with "solid" would make readers read the file as text.
  std::string bytes = "binary STL written by sixdof";
  bytes.resize(k_header_bytes, ' ');
  bytes.reserve(k_header_bytes + 4 + k_triangle_bytes * mesh.triangles().size());
  loading::append_little_endian(bytes, static_cast<std::uint32_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    append_point<float>(bytes, unit_normal(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
    for (const std::uint32_t v : t) append_point<float>(bytes, vertices[v]);
    loading::append_little_endian(bytes, std::uint16_t{0});
  }
  write_file_atomically(file, bytes);
}

}  // namespace

void save_ply(const PlyContent& content, const std::filesystem::path& file) {
  const std::size_t count = content.vertices.size();
  const bool coloured = !content.vertex_colours.empty();
  const bool normals = !content.vertex_normals.empty();
  const auto check_size = [count](std::size_t size, const char* what) {
    if (size != 0 && size != count) throw BadArgument(fmt::format("{} {} for {} vertices", size, what, count));
  };
  check_size(content.vertex_colours.size(), "colours");
  check_size(content.vertex_normals.size(), "normals");
  for (std::size_t i = 0; i < content.triangles.size(); ++i) {
    for (const std::uint32_t v : content.triangles[i]) {
      if (v >= count) throw BadArgument(fmt::format("triangle {}: vertex index {} of {}", i, v, count));
    }
  }
  // Signed indices are read by more programs; the type matters only beyond 2^31 vertices.
  const bool is_signed = count <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by sixdof\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n{}{}"
      "element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
      count, normals ? "property double nx\nproperty double ny\nproperty double nz\n" : "",
      coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "", content.triangles.size(),
      is_signed ? "int" : "uint");
  constexpr std::size_t k_vertex_bytes = 24;
  constexpr std::size_t k_triangle_bytes = 13;
  bytes.reserve(bytes.size() + (k_vertex_bytes * (normals ? 2 : 1) + (coloured ? 3 : 0)) * count +
                k_triangle_bytes * content.triangles.size());
  for (std::size_t i = 0; i < count; ++i) {
    append_point<double>(bytes, content.vertices[i]);
    if (normals) append_point<double>(bytes, content.vertex_normals[i]);
    if (coloured) {
      for (const std::uint8_t component : content.vertex_colours[i]) loading::append_little_endian(bytes, component);
    }
  }
  for (const Triangle& t : content.triangles) {
    loading::append_little_endian(bytes, std::uint8_t{3});
    for (const std::uint32_t v : t) loading::append_little_endian(bytes, v);
  }
  write_file_atomically(file, bytes);
}

void save_mesh(const Mesh& mesh, const std::filesystem::path& file) {
  const std::string extension = loading::lower_case_extension(file);
  if (extension == ".ply") return save_ply({.vertices = mesh.vertices(), .triangles = mesh.triangles()}, file);
  if (extension == ".off") return save_off(mesh, file);
  if (extension == ".obj") return save_obj(mesh, file);
  if (extension == ".stl") return save_stl(mesh, file);
  throw BadFile(file.string(), (extension.empty() ? "has no extension" : "'" + extension + "' cannot be written") +
                                   "; mesh formats are .ply, .off, .obj and .stl");
}

}  // namespace sixdof
