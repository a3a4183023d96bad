// Loading meshes. The first byte of an input picks the format ('0' is the first), the rest is the file. Assimp is asked
// for 3DS only, in this process: of damaged files of other formats it is known to crash (load.h).
//
// A file is refused by a BadFile that names it. What is loaded is a valid mesh, and comes back the same from every
// format that keeps all bits.
#include <array>
#include <cmath>
#include <utility>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>
#include <sixdof/geometry/load_formats.h>
#include <sixdof/geometry/save.h>

#include "fuzz.h"

namespace sixdof::fuzz {
namespace {

constexpr std::array k_formats{".ply", ".off", ".obj", ".stl", ".glb", ".gltf", ".3ds"};
constexpr std::array k_exact_formats{".ply", ".off", ".obj"};

void check_mesh(const Mesh& mesh) {
  require(!mesh.triangles().empty(), "a mesh has triangles");
  for (const auto& p : mesh.vertices()) require(p.allFinite(), "vertices are finite");
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) require(v < mesh.vertices().size(), "indices are in range");
    require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "the corners of a triangle are different vertices");
  }
  for (const std::uint32_t t : mesh.repairs().zero_area_triangles) {
    require(t < mesh.triangles().size(), "triangles without area are in range");
  }
  const Mesh again = Mesh::build(mesh.vertices(), mesh.triangles());
  require(again.hash() == mesh.hash(), "a valid mesh is built again without a change");
}

/// load_mesh(), in this process.
Mesh load_here(const std::filesystem::path& file, const LoadOptions& options) {
  if (file.extension() != ".3ds") return load_mesh(file, options);
  loading::FileMesh surface;
  loading::read_by_assimp(loading::read_source(file), loading::FileFrame::metres,
                          [&](loading::FileMesh&& read) { surface = std::move(read); });
  try {
    return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), "mesh", std::move(surface.repairs));
  } catch (const BadMesh& e) {
    throw BadFile(file.string(), e.what());
  }
}

void check_saved(const Mesh& mesh, const char* format) {
  const auto file = scratch_folder() / (std::string("saved") + format);
  save_mesh(mesh, file);
  require(load_mesh(file).hash() == mesh.hash(), std::string("what is saved as ") + format + " is loaded again");
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof;
  using namespace sixdof::fuzz;
  Input input(data, size);
  const auto format = static_cast<std::size_t>(input.byte() - '0') % k_formats.size();
  const auto file = scratch_folder() / (std::string("mesh") + k_formats[format]);
  write_bytes(file, input.rest());
  // Faces that are not finite are dropped only where the file is refused otherwise.
  for (const bool drop : {false, true}) {
    try {
      const Mesh mesh = load_here(file, {.drop_faces_not_finite = drop});
      check_mesh(mesh);
      check_saved(mesh, k_exact_formats[size % k_exact_formats.size()]);
      return 0;
    } catch (const BadFile& e) {
      require(std::string_view(e.what()).starts_with(file.string() + ": "), "an error names the file");
    }
  }
  return 0;
}
