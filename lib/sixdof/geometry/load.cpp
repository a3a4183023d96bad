#include <sixdof/geometry/load.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/assimp_import.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof {
namespace loading {

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void Source::fail(const std::string& cause) const { throw BadFile(path.string(), cause); }

void Source::fail(const std::string& place, const std::string& cause) const {
  throw BadFile(path.string(), place, cause);
}

Source read_source(const std::filesystem::path& file) {
  Source source{file, {}};
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  // Reading a pipe or a device might never end.
  if (!S_ISREG(status.st_mode)) source.fail("cannot be read: not a regular file");
  std::ifstream in(file, std::ios::binary);
  if (!in) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  source.bytes.resize(static_cast<std::size_t>(status.st_size));
  in.read(source.bytes.data(), static_cast<std::streamsize>(source.bytes.size()));
  if (static_cast<std::size_t>(in.gcount()) != source.bytes.size()) source.fail("cannot be read to its end");
  if (source.bytes.empty()) source.fail("is empty");
  return source;
}

void count_repair(FileRepairs& repairs, const std::string& place) {
  if (repairs.count++ == 0) repairs.first_place = place;
}

void count_polygon(const Source& source, PolygonShape shape, const std::string& place, MeshRepairs& repairs) {
  if (shape == PolygonShape::too_large) {
    source.fail(place, fmt::format("a concave polygon of more than {} corners", k_most_corners_of_a_concave_polygon));
  }
  if (shape == PolygonShape::crossing) count_repair(repairs.crossing_polygons, place);
  if (shape == PolygonShape::not_flat) count_repair(repairs.nonplanar_polygons, place);
}

namespace {

Surface read_surface(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension == ".ply") return read_ply(read_source(file));
  if (extension == ".off") return read_off(read_source(file));
  if (extension == ".obj") return read_obj(read_source(file));
  if (extension == ".stl") return read_stl(read_source(file));
  return read_by_assimp(file);
}

}  // namespace
}  // namespace loading

Mesh load_mesh(const std::filesystem::path& file) {
  try {
    loading::Surface surface = loading::read_surface(file);
    return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), file.stem().string(),
                       std::move(surface.repairs));
  } catch (const BadMesh& e) {
    throw BadFile(file.string(), e.what());
  } catch (const std::bad_alloc&) {
    throw BadFile(file.string(), "does not fit into memory");
  }
}

}  // namespace sixdof
