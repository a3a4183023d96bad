#include "bench/cli/commands.h"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/shape_facts.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/mesh_check.h>
#include "bench/cli/info_check.h"
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"
#include "bench/common/mesh_warning.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;

/// What reading the file forgave by kind, and what building the mesh repaired.
Json as_json(const MeshRepairs& repairs) {
  Json json;
  for (std::size_t k = 0; k < k_forgiven_kinds; ++k) {
    const auto kind = static_cast<Forgiven>(k);
    const FileRepairs& of_kind = repairs.forgiven.of(kind);
    json[key_of(kind)] = {{"count", of_kind.count}, {"first_place", of_kind.first_place}};
  }
  json["welded_vertices"] = repairs.welded_vertices;
  json["unreferenced_vertices"] = repairs.unreferenced_vertices;
  json["collapsed_triangles"] = repairs.collapsed_triangles;
  json["zero_area_triangles"] = repairs.zero_area_triangles.size();
  return json;
}

Json as_json(const ShapeFacts& facts) {
  return {{"kind", name_of(kind_of(facts))}, {"genus", facts.genus},         {"box_aspect", facts.box_aspect},
          {"box_fill", facts.box_fill},      {"thickness", facts.thickness}, {"aligned_share", facts.aligned_share},
          {"flat_share", facts.flat_share}};
}

Json as_json(const Mesh& mesh) {
  const MeshTopology& topology = mesh.topology();
  return {{"kind", "mesh"},
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
          {"shape", as_json(shape_facts(mesh))},
          {"forgiven", text_of(mesh.repairs().forgiven)},
          {"notes", mesh.repairs().notes},
          {"repairs", as_json(mesh.repairs())}};
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
  const ShapeFacts shape = shape_facts(mesh);
  row("kind",
      fmt::format("{}: genus {}, box aspect {:.3g}, box fill {:.3g}, thickness {:.3g}, aligned {:.3g}, flat {:.3g}",
                  name_of(kind_of(shape)), shape.genus, shape.box_aspect, shape.box_fill, shape.thickness,
                  shape.aligned_share, shape.flat_share));
  row("repairs",
      fmt::format("{} vertices welded, {} unused dropped; {} collapsed triangles dropped, {} of zero area kept",
                  repairs.welded_vertices, repairs.unreferenced_vertices, repairs.collapsed_triangles,
                  repairs.zero_area_triangles.size()));
  const std::string forgiven = text_of(repairs.forgiven);
  row("forgiven", forgiven.empty() ? "nothing" : forgiven);
  for (const std::string& note : repairs.notes) row("note", note);
}

Json as_json(const MeshIdentity& mesh) {
  Json json = {{"name", mesh.name},
               {"content_hash", mesh.hash},
               {"triangles", mesh.triangles},
               {"box_min", coordinates(mesh.box_min)},
               {"box_max", coordinates(mesh.box_max)},
               {"volume", mesh.volume}};
  if (!mesh.path.empty()) {
    json["path"] = mesh.path;
    if (!mesh.absolute_path.empty()) json["absolute_path"] = mesh.absolute_path;
  }
  return json;
}

Json as_json(const ConfigurationSet& set) {
  const SetDescription& d = set.description();
  Json json = {{"file", set.path().string()},
               {"content_hash", set.hash()},
               {"generator_version", d.generator_version},
               {"grid", d.grid.spec},
               {"sampler", d.grid.sampler},
               {"directions", d.grid.directions.size()},
               {"rotations", d.grid.rotations.size()},
               {"configurations_per_bucket", d.grid.configurations()},
               {"a", as_json(d.a)},
               {"b", as_json(d.b)}};
  if (d.volume_grid) {
    json["volume_grid"] = {{"grid", d.volume_grid->spec},
                           {"directions", d.volume_grid->directions.size()},
                           {"rotations", d.volume_grid->rotations.size()},
                           {"configurations_per_bucket", d.volume_grid->configurations()}};
  }
  auto buckets = Json::array();
  for (const BucketSummary& bucket : set.buckets()) {
    buckets.push_back({{"bucket", bucket.key.name()},
                       {"nominal", bucket.nominal},
                       {"target", bucket.target},
                       {"tolerance", bucket.tolerance},
                       {"largest_residual", bucket.largest_residual},
                       {"reachable", bucket.reachable},
                       {"oracle", bucket.oracle},
                       {"oracle_version", bucket.oracle_version},
                       {"content_hash", bucket.hash}});
  }
  json["buckets"] = std::move(buckets);
  return json;
}

void print_grid(const char* label, const Grid& grid) {
  fmt::print("{:<18} {} ({}): {} directions x {} rotations = {} configurations per bucket\n", label, grid.spec,
             grid.sampler, grid.directions.size(), grid.rotations.size(), grid.configurations());
}

void print_text(const ConfigurationSet& set) {
  const SetDescription& d = set.description();
  fmt::print("configuration set  {}\n", visible_text(set.path().string(), k_any_length));
  fmt::print("content hash       {}\n", set.hash());
  fmt::print("made by            sixdof {}\n", d.generator_version);
  for (const auto& [label, mesh] : {std::pair("A (fixed)", &d.a), std::pair("B (moving)", &d.b)}) {
    fmt::print("{:<18} {}: {} triangles, box diagonal {:.6g}, volume {:.6g}, content hash {}\n", label, mesh->name,
               mesh->triangles, mesh->diagonal(), mesh->volume, mesh->hash);
    if (!mesh->path.empty()) {
      const std::string absolute = mesh->absolute_path.empty() ? "" : fmt::format(" ({})", mesh->absolute_path);
      fmt::print("{:<18} {}\n", "", visible_text(mesh->path + absolute, k_any_length));
    }
  }
  print_grid(d.volume_grid ? "grid of distances" : "grid", d.grid);
  if (d.volume_grid) print_grid("grid of volumes", *d.volume_grid);
  fmt::print("\n{:<13} {:>14} {:>10} {:>14} {:>10}  {}\n", "bucket", "nominal", "tolerance", "largest resid.",
             "reachable", "oracle");
  for (const BucketSummary& bucket : set.buckets()) {
    fmt::print("{:<13} {:>14.6g} {:>10.1e} {:>14.1e} {:>10}  {} {}\n", bucket.key.name(), bucket.nominal,
               bucket.tolerance, bucket.largest_residual, bucket.reachable, bucket.oracle, bucket.oracle_version);
  }
}

/// Lengths are in the meshes' own unit and frame; numbers in JSON have up to 17 significant digits.
void print(const auto& content, bool json) {
  json ? fmt::print("{}\n", json_text(as_json(content))) : print_text(content);
}

/// @throws DefectsFound after printing
void print_checked(const Mesh& mesh, bool json) {
  const MeshCheck check = check_mesh(mesh);
  if (json) {
    Json document = as_json(mesh);
    document["check"] = check_as_json(check);
    fmt::print("{}\n", json_text(document));
  } else {
    print_text(mesh);
    print_check(check);
  }
  if (!check.clean()) throw DefectsFound(fmt::format("{}: {}", mesh.name(), summary(check)));
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto* const command = app.add_subcommand("info", "Print what a mesh or a configuration set holds");
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  const auto check = std::make_shared<bool>(false);
  command->add_option("file", *name, "A mesh file, a model's name (sixdof models list), or a set")
      ->required()
      ->type_name("MESH");
  command->add_flag(
      "--check", *check,
      "Check a mesh for self-intersections and for duplicate, nested or inverted shells, which make volumes "
      "wrong; exit code 3 if there are any");
  command->add_flag("--json", *json, "As JSON");
  command->callback([name, json, check] {
    if (looks_like_configuration_set(*name)) {
      if (*check) throw BadArgument(*name + ": --check is for meshes");
      const ConfigurationSet set(*name);
      // Summaries alone would be content with a set that lacks its values.
      for (const BucketSummary& bucket : set.buckets()) static_cast<void>(set.read(bucket.key));
      print(set, *json);
    } else {
      *check ? print_checked(load_model(*name), *json) : print(load_model(*name), *json);
    }
  });
  add_examples(*command, "sixdof info cone.ply", "sixdof info torus-knot-10k --check --json");
}

}  // namespace sixdof::cli
