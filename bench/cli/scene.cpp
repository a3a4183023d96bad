#include <algorithm>
#include <memory>
#include <optional>
#include <string>

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
  fmt::print("pairs       {} that matter, {} ignored\n", scene::PairFilter(scene).pairs(), scene.ignored.size());
  fmt::print("frames      {}, poses that change {}\n", scene.frames.size(), scene.motions());
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
  json["margin"] = scene.margin;
  json["hash"] = scene.hash();
  fmt::print("{}\n", json_text(json));
}

struct MakeOptions {
  std::string family, folder, poses, output;
  scene::SceneNumbers numbers;
  double margin = 0.0;
};

void make(const MakeOptions& options, bool has_margin) {
  if (options.family.empty() == options.poses.empty()) {
    throw BadArgument("name a family, or give --bodies and --poses");
  }
  if (options.poses.empty() != options.folder.empty()) throw BadArgument("--bodies and --poses belong together");
  scene::SceneNumbers numbers = options.numbers;
  if (has_margin) numbers.margin = options.margin;
  const Scene made = options.family.empty() ? scene::read_scene_csv(options.folder, options.poses, options.margin)
                                            : scene::make_scene(options.family, numbers);
  scene::save_scene(made, options.output);
  print_summary(made, options.output);
}

void add_make(CLI::App& group) {
  auto* const command = group.add_subcommand("make", "Make a scene of a family, or of mesh files and a table of poses");
  const auto options = std::make_shared<MakeOptions>();
  std::string families = "Families:";
  for (const scene::SceneFamily& family : scene::scene_families()) {
    families += fmt::format("\n  {:<9} {}", family.name, family.stresses);
  }
  command->add_option("family", options->family, "Family (below)");
  command->add_option("-n,--count", options->numbers.bodies, "Number of bodies")->capture_default_str();
  command->add_option("--frames", options->numbers.frames, "Number of frames, the start included")
      ->capture_default_str();
  command->add_option("--density", options->numbers.density, "Volume of the bodies' boxes over that of the space");
  command->add_option("--size-ratio", options->numbers.size_ratio, "Largest over smallest body of a shape");
  command->add_option("--moving", options->numbers.moving, "Share of the bodies that moves in a frame, 0 to 1");
  command->add_option("--step", options->numbers.step, "Largest translation in a frame, in sizes of the body");
  auto* const margin = command->add_option("--margin", options->margin,
                                           "Margin of near pairs: in mean sizes of the bodies, with --poses a length");
  command->add_option("--seed", options->numbers.seed, "Seed")->capture_default_str();
  command->add_option("--bodies", options->folder, "Folder of mesh files, instead of a family");
  command->add_option("--poses", options->poses, "Table of poses: frame,body,mesh,tx,ty,tz,qw,qx,qy,qz (CSV)");
  command->add_option("-o,--output", options->output, "File to write")->required();
  command->callback([options, margin] { make(*options, margin->count() > 0); });
  add_examples(*command, "sixdof scene make cube -n 100 --frames 10 -o cube.h5",
               "sixdof scene make pile -n 50 --frames 5 --seed 2 -o pile.h5", families);
}

void add_info(CLI::App& group) {
  auto* const command = group.add_subcommand("info", "What a scene holds");
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("file", *file, "Scene")->required();
  command->add_flag("--json", *json, "As JSON");
  command->callback([file, json] {
    const Scene loaded = scene::load_scene(*file);
    *json ? print_json(loaded) : print_summary(loaded, *file);
  });
  add_examples(*command, "sixdof scene info cube.h5", "sixdof scene info cube.h5 --json");
}

}  // namespace

void add_scene_command(CLI::App& app) {
  auto* const command = app.add_subcommand("scene", "Scenes of many bodies: make them, look at them, replay them");
  command->require_subcommand(1);
  add_make(*command);
  add_info(*command);
  add_scene_play(*command);
  add_examples(*command, "sixdof scene make cube -n 100 --frames 10 -o cube.h5", "sixdof scene info cube.h5");
}

}  // namespace sixdof::cli
