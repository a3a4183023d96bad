#include "bench/cli/info_mesh.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/mesh.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof::cli {
namespace {

std::array<double, 3> coordinates(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

nlohmann::ordered_json file_repairs(const FileRepairs& repairs) {
  return {{"count", repairs.count}, {"first_place", repairs.first_place}};
}

void print_json(const Mesh& mesh) {
  const MeshTopology& topology = mesh.topology();
  const MeshRepairs& repairs = mesh.repairs();
  nlohmann::ordered_json json = {
      {"kind", "mesh"},
      {"name", mesh.name()},
      {"triangles", mesh.triangles().size()},
      {"vertices", mesh.vertices().size()},
      {"edges", topology.edges},
      {"solid", mesh.solid()},
      {"closed", topology.closed},
      {"manifold", topology.manifold},
      {"oriented", topology.oriented},
      {"border_edges", topology.border_edges},
      {"nonmanifold_edges", topology.nonmanifold_edges},
      {"nonmanifold_vertices", topology.nonmanifold_vertices},
      {"misoriented_edges", topology.misoriented_edges},
      {"components", topology.components},
      {"euler_characteristic", topology.euler_characteristic},
      {"volume", mesh.volume()},
      {"area", mesh.area()},
      {"centroid", coordinates(mesh.centroid())},
      {"box", {{"min", coordinates(mesh.box().min())}, {"max", coordinates(mesh.box().max())}}},
      {"diagonal", mesh.diagonal()},
      {"hash", mesh.hash()},
      {"repairs",
       {{"crossing_polygons", file_repairs(repairs.crossing_polygons)},
        {"nonplanar_polygons", file_repairs(repairs.nonplanar_polygons)},
        {"skipped_statements", file_repairs(repairs.skipped_statements)},
        {"welded_vertices", repairs.welded_vertices},
        {"unreferenced_vertices", repairs.unreferenced_vertices},
        {"collapsed_triangles", repairs.collapsed_triangles},
        {"zero_area_triangles", repairs.zero_area_triangles.size()}}}};
  fmt::print("{}\n", json.dump(2));
}

std::string as_text(const Eigen::Vector3d& p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x(), p.y(), p.z()); }

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

void print_text(const Mesh& mesh) {
  const MeshTopology& topology = mesh.topology();
  const MeshRepairs& repairs = mesh.repairs();
  const auto row = [](const char* label, const std::string& value) { fmt::print("{:<12} {}\n", label, value); };
  row("name", mesh.name());
  row("triangles", fmt::format("{}", mesh.triangles().size()));
  row("vertices", fmt::format("{}", mesh.vertices().size()));
  row("edges", fmt::format("{}", topology.edges));
  row("solid", mesh.solid() ? "yes" : "no: " + mesh.why_not_solid());
  row("closed", fmt::format("{} ({} border edges)", yes_or_no(topology.closed), topology.border_edges));
  row("manifold", fmt::format("{} ({} bad edges, {} bad vertices)", yes_or_no(topology.manifold),
                              topology.nonmanifold_edges, topology.nonmanifold_vertices));
  row("oriented", fmt::format("{} ({} bad edges)", yes_or_no(topology.oriented), topology.misoriented_edges));
  row("components", fmt::format("{}", topology.components));
  row("Euler number", fmt::format("{}", topology.euler_characteristic));
  row("volume", fmt::format("{:.9g}", mesh.volume()));
  row("area", fmt::format("{:.9g}", mesh.area()));
  row("centroid", as_text(mesh.centroid()));
  row("box", fmt::format("{} .. {}", as_text(mesh.box().min()), as_text(mesh.box().max())));
  row("diagonal", fmt::format("{:.9g}", mesh.diagonal()));
  row("hash", mesh.hash());
  row("repairs",
      fmt::format("{} vertices welded, {} unused dropped; {} collapsed triangles dropped, {} of zero area kept",
                  repairs.welded_vertices, repairs.unreferenced_vertices, repairs.collapsed_triangles,
                  repairs.zero_area_triangles.size()));
  const auto file_row = [&](const FileRepairs& of_kind, const char* what) {
    if (of_kind.count > 0) row("", fmt::format("{}: {}, the first at {}", what, of_kind.count, of_kind.first_place));
  };
  file_row(repairs.crossing_polygons, "polygons that cross themselves, triangulated");
  file_row(repairs.nonplanar_polygons, "polygons that are not flat, triangulated");
  file_row(repairs.skipped_statements, "unknown statements skipped");
}

}  // namespace

void print_mesh_info(const std::string& name_or_file, bool json) {
  const Mesh mesh = load_model(name_or_file);
  json ? print_json(mesh) : print_text(mesh);
}

}  // namespace sixdof::cli
