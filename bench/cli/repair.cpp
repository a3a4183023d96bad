#include "bench/cli/commands.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/repair/advice.h>
#include <sixdof/repair/repair.h>
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string input, output;
  RepairOptions options;
  bool json = false;
};

struct KindName {
  const char* key;  ///< In JSON.
  const char* text;
};

KindName name_of(RepairKind kind) {
  switch (kind) {
    case RepairKind::welded_vertices:
      return {"welded_vertices", "vertices welded"};
    case RepairKind::duplicate_triangles:
      return {"duplicate_triangles", "duplicate triangles dropped"};
    case RepairKind::degenerate_triangles:
      return {"degenerate_triangles", "triangles without area taken out"};
    case RepairKind::split_edges:
      return {"split_edges", "edges split at vertices that lay on them"};
    case RepairKind::flipped_triangles:
      return {"flipped_triangles", "triangles turned"};
    case RepairKind::filled_holes:
      return {"filled_holes", "holes filled"};
    case RepairKind::fins:
      return {"fins", "triangles of fins dropped"};
    case RepairKind::inner_walls:
      return {"inner_walls", "triangles of inner walls dropped"};
    case RepairKind::stray_triangles:
      return {"stray_triangles", "stray triangles dropped"};
  }
  return {"", ""};
}

Json state_of(const Mesh& mesh) {
  return {{"triangles", mesh.triangles().size()},
          {"vertices", mesh.vertices().size()},
          {"solid", mesh.solid()},
          {"why_not_solid", mesh.why_not_solid()},
          {"closed", mesh.topology().closed},
          {"border_edges", mesh.topology().border_edges},
          {"manifold", mesh.topology().manifold},
          {"oriented", mesh.topology().oriented},
          {"nonmanifold_edges", mesh.topology().nonmanifold_edges},
          {"volume", mesh.volume()},
          {"hash", mesh.hash()}};
}

/// The options that an attempt has and `tried` has not, as they are typed; empty for equal ones.
std::string option_text(const RepairOptions& attempt, const RepairOptions& tried) {
  std::string text;
  if (attempt.weld != tried.weld) text += fmt::format("--weld {:g}", attempt.weld);
  if (attempt.max_hole != tried.max_hole) {
    text += fmt::format("{}--max-hole {}", text.empty() ? "" : " ", attempt.max_hole);
  }
  return text;
}

/// What is open in a result that is no solid, and what other options leave open.
struct Advice {
  std::optional<RepairGaps> gaps;
  std::vector<RepairAttempt> attempts;

  /// Options to add; empty if none was found.
  std::string options(const RepairOptions& tried) const {
    return attempts.back().solid ? option_text(attempts.back().options, tried) : "";
  }
};

Json as_json(const Advice& advice, const RepairOptions& tried) {
  auto attempts = Json::array();
  for (const RepairAttempt& each : advice.attempts) {
    attempts.push_back(
        {{"options", option_text(each.options, tried)}, {"border_edges", each.border_edges}, {"solid", each.solid}});
  }
  Json json{{"tried", std::move(attempts)}, {"add", advice.options(tried)}};
  if (advice.gaps) {
    json["gaps"] = {{"edges", advice.gaps->edges}, {"median", advice.gaps->median}, {"largest", advice.gaps->largest}};
  }
  return json;
}

void print_json(const Mesh& before, const RepairedMesh& repaired, const std::optional<Advice>& advice,
                const RepairOptions& tried) {
  Json repairs;
  for (std::size_t k = 0; k < k_repair_kinds; ++k) {
    const RepairsOfKind& of_kind = repaired.log.kinds[k];
    auto places = Json::array();
    for (const Eigen::Vector3d& p : of_kind.first) places.push_back(coordinates(p));
    repairs[name_of(static_cast<RepairKind>(k)).key] = {{"count", of_kind.count}, {"first", std::move(places)}};
  }
  Json json{{"forgiven", text_of(before.repairs().forgiven)},
            {"before", state_of(before)},
            {"after", state_of(repaired.mesh)},
            {"repairs", std::move(repairs)},
            {"passes", repaired.passes},
            {"converged", repaired.converged}};
  if (advice) json["advice"] = as_json(*advice, tried);
  fmt::print("{}\n", json_text(json));
}

std::string state_text(const Mesh& mesh) {
  return fmt::format(
      "{} triangles, {}", mesh.triangles().size(),
      mesh.solid() ? fmt::format("a solid of volume {:.9g}", mesh.volume()) : "no solid: " + mesh.why_not_solid());
}

void print_text(const Mesh& before, const RepairedMesh& repaired) {
  const std::string forgiven = text_of(before.repairs().forgiven);
  if (!forgiven.empty()) fmt::print("{:<8} {}\n", "forgiven", forgiven);
  fmt::print("{:<8} {}\n", "before", state_text(before));
  if (repaired.log.total() == 0) fmt::print("{:<8} nothing to repair\n", "");
  for (std::size_t k = 0; k < k_repair_kinds; ++k) {
    const RepairsOfKind& of_kind = repaired.log.kinds[k];
    if (of_kind.count == 0) continue;
    std::string places;
    for (const Eigen::Vector3d& p : of_kind.first)
      places += fmt::format(" ({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
    fmt::print("{:>8} {}, at{}{}\n", of_kind.count, name_of(static_cast<RepairKind>(k)).text, places,
               of_kind.count > of_kind.first.size() ? " ..." : "");
  }
  fmt::print("{:<8} {}\n", "after", state_text(repaired.mesh));
  if (!repaired.converged) fmt::print("{:<8} repairing the result again may change more\n", "");
}

void print_text(const Advice& advice, const RepairOptions& tried) {
  if (advice.gaps) {
    const auto& [edges, median, largest] = *advice.gaps;
    fmt::print("{:<8} {} open edges; their middles are {:.2g} of the diagonal (median; largest {:.2g}) from the next\n",
               "gaps", edges, median, largest);
  }
  for (const RepairAttempt& each : advice.attempts) {
    const std::string options = option_text(each.options, tried);
    fmt::print("{:<8} {}: {}\n", "tried", options.empty() ? "as it is" : options,
               each.solid ? "a solid" : fmt::format("no solid, {} open edges", each.border_edges));
  }
  if (advice.attempts.back().solid) fmt::print("{:<8} add {}\n", "advice", advice.options(tried));
}

void repair(const Arguments& arguments) {
  std::error_code none;
  if (std::filesystem::equivalent(arguments.input, arguments.output, none)) {
    throw BadArgument(arguments.output + ": is the input, which is not overwritten");
  }
  const Mesh mesh = load_model(arguments.input, {.drop_faces_not_finite = true});
  const RepairedMesh repaired = repair_mesh(mesh, arguments.options);
  save_mesh(repaired.mesh, arguments.output);
  std::optional<Advice> advice;
  if (!repaired.mesh.solid()) {
    StatusLine status;
    status.show("no solid yet: trying other options");
    advice = Advice{measure_gaps(repaired.mesh), try_other_repairs(mesh, arguments.options)};
  }
  if (arguments.json) {
    print_json(mesh, repaired, advice, arguments.options);
  } else {
    print_text(mesh, repaired);
    if (advice) print_text(*advice, arguments.options);
  }
  if (advice) {
    throw DefectsFound(
        fmt::format("{}: written, but still no solid: {}", arguments.output, repaired.mesh.why_not_solid()));
  }
}

}  // namespace

void add_repair_command(CLI::App& app) {
  auto* const command = app.add_subcommand("repair", "Close and orient a damaged mesh");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("file", arguments->input, "A mesh file, or a model's name (sixdof models list)")
      ->required()
      ->type_name("MESH");
  command
      ->add_option("-o,--output", arguments->output,
                   "File to write: .ply, .off, .obj or .stl; replaced if it exists, but must not be the input. Exit "
                   "code 3 if what is written is still no solid")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--weld", arguments->options.weld,
          "Join border vertices to each other, and border edges to vertices on them, up to this distance, as a "
          "fraction of the diagonal of the mesh's box; 0: only equal vertices")
      ->type_name("FRACTION")
      ->capture_default_str();
  command->add_option("--max-hole", arguments->options.max_hole, "Fill holes of up to this number of edges; 0: none")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--max-fin", arguments->options.max_fin,
                   "Drop fins and stray pieces of up to this fraction of the area of the closed surface beside them")
      ->type_name("FRACTION")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "As JSON");
  add_examples(*command, "sixdof repair cone.ply -o mended.ply",
               "sixdof repair torus-1k -o mended.obj --weld 0 --json");
  command->callback([arguments] { repair(*arguments); });
}

}  // namespace sixdof::cli
