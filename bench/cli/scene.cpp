#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/scene/families.h>
#include <sixdof/scene/scene_csv.h>
#include <sixdof/scene/scene_file.h>
#include "bench/cli/scene.h"
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

using scene::Scene;

void print_summary(const Scene& scene, const std::string& file) {
  const auto fixed = std::ranges::count_if(scene.bodies, &scene::Body::fixed);
  fmt::print("{}: scene {}\n", file, scene.name.empty() ? "without a name" : scene.name);
  if (!scene.recipe.empty()) fmt::print("recipe      {}\n", scene.recipe);
  fmt::print("bodies      {}, {} of them fixed\n", scene.bodies.size(), fixed);
  fmt::print("meshes      {}; triangles of all bodies {}\n", scene.meshes.size(), scene.triangles());
  fmt::print("pairs       {} tested, {} ignored\n", scene::PairFilter(scene).pairs(), scene.ignored.size());
  fmt::print("frames      {}, poses that change {}\n", scene.frames.size(), scene.motions());
  if (scene.deforms()) fmt::print("deformed    {} meshes in all frames\n", scene.shapes());
  fmt::print("margin      {:.6g}\n", scene.margin);
  fmt::print("hash        {}\n", scene.hash());
}

void print_json(const Scene& scene) {
  nlohmann::ordered_json json;
  json["name"] = scene.name;
  json["recipe"] = scene.recipe;
  json["bodies"] = scene.bodies.size();
  json["fixed"] = std::ranges::count_if(scene.bodies, &scene::Body::fixed);
  json["meshes"] = scene.meshes.size();
  json["triangles"] = scene.triangles();
  json["pairs"] = scene::PairFilter(scene).pairs();
  json["ignored_pairs"] = scene.ignored.size();
  json["frames"] = scene.frames.size();
  json["motions"] = scene.motions();
  json["shapes"] = scene.shapes();
  json["margin"] = scene.margin;
  json["hash"] = scene.hash();
  fmt::print("{}\n", json_text(json));
}

struct MakeOptions {
  std::string family, folder, poses, output;
  scene::SceneNumbers numbers;
  double margin = 0.0;
};

/// Of the mesh files: as given, else where the table is.
std::filesystem::path folder_of(const MakeOptions& options) {
  if (!options.folder.empty()) return options.folder;
  return std::filesystem::absolute(options.poses).parent_path();
}

void make(const MakeOptions& options, bool has_margin) {
  if (options.family.empty() == options.poses.empty()) {
    throw BadArgument("name a family, or give a table of --poses");
  }
  if (options.poses.empty() && !options.folder.empty()) throw BadArgument("--bodies needs a table of --poses");
  scene::SceneNumbers numbers = options.numbers;
  if (has_margin) numbers.margin = options.margin;
  const Scene made = options.family.empty() ? scene::read_scene_csv(folder_of(options), options.poses, options.margin)
                                            : scene::make_scene(options.family, numbers);
  scene::save_scene(made, options.output);
  print_summary(made, options.output);
}

constexpr const char* k_table =
    R"(A table of poses (CSV) has a row for each body in frame 0, and one wherever a body moves:
  frame,body,mesh,tx,ty,tz,qw,qx,qy,qz,fixed,ignored
  0,1,base.stl,0,0,0,1,0,0,0,1,2
  0,2,torus-1k,1.5,0,0,1,0,0,0,,
  1,2,,1.4,0,0,1,0,0,0,,
body is a number, mesh a file in the --bodies folder or a model's name, tx to qz the translation and unit quaternion
of the body's pose in the world. The columns fixed (1: never moves) and ignored (bodies that are not tested against
this one, as "2 5") may be left out. Columns may have any order; commas, semicolons or tabs separate them.)";

void add_make(CLI::App& group) {
  auto* const command = group.add_subcommand("make", "Make a scene of a family, or of meshes and a table of poses");
  const auto options = std::make_shared<MakeOptions>();
  std::string families;
  std::vector<std::string> names;
  const auto add_families = [&](const char* title, std::span<const scene::SceneFamily> list) {
    families += title;
    for (const scene::SceneFamily& family : list) {
      families += help_entry(std::string(family.name), std::string(family.stresses));
      names.emplace_back(family.name);
    }
  };
  add_families("Families:\n", scene::scene_families());
  add_families("\nFamilies in which a mesh deforms, beside four rigid bodies:\n", scene::deforming_families());
  const std::string of_family = "Of a family, which has its own X", of_table = "Of a table of poses";
  command->add_option("family", options->family, "Kind of scene (below)")->type_name("FAMILY")->check(words_of(names));
  command->add_option("-o,--output", options->output, "The scene to write (HDF5)")->required()->type_name("FILE");
  auto* const margin = command
                           ->add_option("--margin", options->margin,
                                        "Largest distance at which a pair is near: in mean sizes of the bodies for a "
                                        "family, a length for a table")
                           ->type_name("X");
  command->add_option("-n,--count", options->numbers.bodies, "Number of bodies, where no mesh deforms")
      ->type_name("N")
      ->capture_default_str()
      ->group(of_family);
  command->add_option("--frames", options->numbers.frames, "Number of frames, the start included")
      ->type_name("N")
      ->capture_default_str()
      ->group(of_family);
  const auto add = [&](const char* name, auto& value, const char* meaning) {
    command->add_option(name, value, meaning)->type_name("X")->group(of_family);
  };
  add("--density", options->numbers.density, "Volume of the bodies' boxes, as a fraction of the volume of the space");
  add("--size-ratio", options->numbers.size_ratio, "Size of the largest body of a shape over that of the smallest");
  add("--moving", options->numbers.moving, "Fraction of the bodies that move in a frame, 0 to 1");
  add("--step", options->numbers.step, "Largest translation in a frame, in sizes of the body");
  add("--amplitude", options->numbers.amplitude, "Largest displacement of a vertex, in diagonals of the mesh");
  add("--triangles", options->numbers.triangles, "Triangles of the mesh that deforms, about");
  command->add_option("--seed", options->numbers.seed, "Seed of positions and motion")
      ->type_name("N")
      ->capture_default_str()
      ->group(of_family);
  command->add_option("--poses", options->poses, "The table (CSV, below), instead of a family")
      ->type_name("FILE")
      ->group(of_table);
  command->add_option("--bodies", options->folder, "Folder of its mesh files")
      ->type_name("FOLDER")
      ->default_str("that of the table")
      ->group(of_table);
  command->callback([options, margin] { make(*options, margin->count() > 0); });
  add_examples(*command, "sixdof scene make cube -n 100 --frames 10 -o cube.h5",
               "sixdof scene make twist --amplitude 0.1 --frames 20 -o twist.h5", families + "\n" + k_table);
}

void add_info(CLI::App& group) {
  auto* const command = group.add_subcommand("info", "Print what a scene holds: bodies, frames, pairs");
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("file", *file, "The scene (HDF5)")->required()->type_name("FILE");
  command->add_flag("--json", *json, "As JSON");
  command->callback([file, json] {
    const Scene loaded = scene::load_scene(*file);
    *json ? print_json(loaded) : print_summary(loaded, *file);
  });
  add_examples(*command, "sixdof scene info cube.h5", "sixdof scene info cube.h5 --json");
}

}  // namespace

void add_scene_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("scene", "Make scenes of many moving bodies, and measure algorithms that find their pairs");
  command->require_subcommand(1);
  add_make(*command);
  add_info(*command);
  add_scene_play(*command);
  add_examples(*command, "sixdof scene make cube -n 100 --frames 10 -o cube.h5", "sixdof scene info cube.h5");
}

}  // namespace sixdof::cli
