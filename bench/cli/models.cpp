#include "bench/cli/commands.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/manifest.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>
#include <sixdof/models/surface.h>
#include "bench/cli/models_collection.h"
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

bool is_here(const FetchedModel& model) { return std::filesystem::exists(model_cache() / model.file); }

nlohmann::ordered_json as_json(std::span<const Recipe> recipes) {
  auto json = nlohmann::ordered_json::array();
  for (const Recipe& recipe : recipes) {
    json.push_back({{"name", recipe.name},
                    {"summary", recipe.summary},
                    {"minimum_triangles", recipe.minimum},
                    {"maximum_triangles", k_maximum_triangles},
                    {"genus", recipe.genus}});
  }
  return json;
}

void list_as_json() {
  nlohmann::ordered_json json;
  json["recipes"] = as_json(recipes());
  json["variants"] = as_json(recipe_variants());
  json["cache"] = model_cache().string();
  json["fetched"] = nlohmann::ordered_json::array();
  for (const FetchedModel& model : fetched_models()) {
    json["fetched"].push_back({{"name", model.name},
                               {"summary", model.summary},
                               {"here", is_here(model)},
                               {"file", model.file},
                               {"triangles", model.triangles},
                               {"size", coordinates(model.size)},
                               {"genus", model.genus},
                               {"package", model.package},
                               {"licence", model.licence},
                               {"hash", model.hash}});
  }
  fmt::print("{}\n", json_text(json));
}

void print_recipes(std::span<const Recipe> recipes) {
  fmt::print("{:<18} {:>8} {:>6}  {}\n", "name", "at least", "genus", "summary");
  for (const Recipe& recipe : recipes) {
    fmt::print("{:<18} {:>8} {:>6}  {}\n", recipe.name, recipe.minimum, recipe.genus, recipe.summary);
  }
}

void list_as_text() {
  fmt::print("Recipes, at any even number of triangles up to {}: NAME-COUNT, as in torus-100k\n", k_maximum_triangles);
  print_recipes(recipes());
  fmt::print("\nThe same with other parameters:\n");
  print_recipes(recipe_variants());
  fmt::print("\nScanned objects, fetched by models/fetch into {}; NAME-COUNT subdivides one, as in elephant-1m\n",
             model_cache().string());
  fmt::print("{:<14} {:>8} {:>6}  {:<8} {:<28} {}\n", "name", "count", "genus", "state", "size", "summary");
  for (const FetchedModel& model : fetched_models()) {
    const std::string size = fmt::format("{:.4g} x {:.4g} x {:.4g}", model.size.x(), model.size.y(), model.size.z());
    fmt::print("{:<14} {:>8} {:>6}  {:<8} {:<28} {}\n", model.name, model.triangles, model.genus,
               is_here(model) ? "here" : "missing", size, model.summary);
  }
}

void add_list(CLI::App& models) {
  auto* const command = models.add_subcommand("list", "List every model with its triangle counts and size");
  const auto json = std::make_shared<bool>(false);
  const auto collection = std::make_shared<std::string>();
  command->add_flag("--json", *json, "As JSON");
  auto* const of_collection =
      command->add_option("--collection", *collection, "The objects of a collection and what was left out of it")
          ->expected(0, 1)
          ->type_name("NAME")
          ->default_str(std::string(collection_name()));
  command->callback([json, collection, of_collection] {
    if (of_collection->count() == 0) {
      *json ? list_as_json() : list_as_text();
    } else {
      list_collection(collection->empty() ? std::string(collection_name()) : *collection, *json);
    }
  });
  add_examples(*command, "sixdof models list --json", "sixdof models list --collection paper-like");
}

struct MakeOptions {
  std::string name;
  std::optional<std::size_t> triangles;
  std::optional<double> diagonal;
  std::string output;
};

/// The mesh times the factor that gives its box this diagonal, up to rounding.
Mesh scaled(const Mesh& mesh, double diagonal) {
  if (!(mesh.diagonal() > 0.0)) throw BadArgument(mesh.name() + ": all points are equal: it has no diagonal to scale");
  const double factor = diagonal / mesh.diagonal();
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) p *= factor;
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name());
}

void make(const MakeOptions& options) {
  std::string name = options.name;
  if (options.triangles) {
    if (parse_model_name(name).triangles) {
      throw BadArgument(fmt::format("{} already has a number of triangles; leave out --triangles", name));
    }
    name += fmt::format("-{}", *options.triangles);
  }
  const Mesh mesh = options.diagonal ? scaled(load_model(name), *options.diagonal) : load_model(name);
  save_mesh(mesh, options.output);
  fmt::print("{}: {} triangles, {} vertices, hash {}\n", options.output, mesh.triangles().size(),
             mesh.vertices().size(), mesh.hash());
}

void add_make(CLI::App& models) {
  auto* const command =
      models.add_subcommand("make", "Write a model to a mesh file, or a mesh file to one of another format");
  const auto options = std::make_shared<MakeOptions>();
  command
      ->add_option("name", options->name,
                   "A model, with its number of triangles or without, or a file: torus-100k, torus, elephant")
      ->required()
      ->type_name("MESH");
  command->add_option("-n,--triangles", options->triangles, "Number of triangles (odd ones are rounded up)")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{1}, k_maximum_triangles));
  command->add_option("--diagonal", options->diagonal, "Scale the model, about its origin, to this diagonal of its box")
      ->type_name("LENGTH")
      ->check(CLI::PositiveNumber);
  command->add_option("-o,--output", options->output, "File to write: .ply, .off, .obj or .stl")
      ->required()
      ->type_name("FILE");
  command->callback([options] { make(*options); });
  add_examples(*command, "sixdof models make cone-1k -o cone.ply",
               "sixdof models make torus-knot --triangles 10000 --diagonal 0.1 -o knot.stl");
}

}  // namespace

void add_models_command(CLI::App& app) {
  auto* const command = app.add_subcommand("models", "List models and write them to files");
  command->require_subcommand(1);
  add_list(*command);
  add_make(*command);
  add_examples(*command, "sixdof models list", "sixdof models make torus-1k -o torus.ply");
}

}  // namespace sixdof::cli
