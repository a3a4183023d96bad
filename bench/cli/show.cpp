#include "bench/cli/show.h"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/store.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/base/error.h>
#include "bench/algorithms.h"
#include "bench/cli/structure_drawing.h"
#include <sixdof/models/model_catalogue.h>

namespace sixdof::cli {
namespace {

struct Arguments {
  std::string algorithm, model, part, output;
  std::vector<std::string> settings;
  int level = 0;
  double keep = 1.0;
};

/// Picks the way to draw a part of an algorithm's structure.
class Painter {
 public:
  Painter(const Mesh& mesh, const Settings& settings, const Arguments& arguments)
      : mesh_(mesh),
        settings_(settings),
        level_(arguments.level),
        cut_x_(arguments.keep < 1.0 ? mesh.box().min().x() + arguments.keep * mesh.box().sizes().x() : k_uncut) {}

  Drawing spheres() const { return draw_spheres(ist::build_inner_sphere_tree(mesh_, settings_).tree, cut_x_); }
  Drawing balls() const { return draw_balls(ist::build_inner_sphere_tree(mesh_, settings_).tree, level_, cut_x_); }
  Drawing voxels() const { return draw_voxels(vps::prepare_voxelmap(mesh_, settings_), cut_x_); }
  Drawing field() const {
    return draw_field(vps::cached_field(mesh_, vps::prepare_voxelmap(mesh_, settings_)), cut_x_);
  }
  Drawing points() const { return draw_points(vps::prepare_pointshell(mesh_, settings_), cut_x_); }

 private:
  const Mesh& mesh_;
  const Settings& settings_;
  int level_;
  double cut_x_;
};

struct Part {
  const char* algorithm;
  const char* name;
  Drawing (Painter::*draw)() const;
};

/// The first part of an algorithm is shown where none is named.
constexpr Part k_parts[] = {
    {"ist", "spheres", &Painter::spheres},    {"ist", "balls", &Painter::balls},
    {"vps", "voxels", &Painter::voxels},      {"vps", "points", &Painter::points},
    {"vps-field", "voxels", &Painter::field}, {"vps-field", "points", &Painter::points},
};

const Part& find_part(const std::string& algorithm, const std::string& name) {
  std::string known;
  for (const Part& part : k_parts) {
    if (part.algorithm != algorithm) continue;
    if (name.empty() || part.name == name) return part;
    known += std::string(known.empty() ? "" : ", ") + part.name;
  }
  if (known.empty()) throw BadArgument(fmt::format("--algorithm {}: has no structure to show", algorithm));
  throw BadArgument(fmt::format("--part {}: {} has {}", name, algorithm, known));
}

void run_show(const Arguments& arguments) {
  Registry registry;
  register_all_algorithms(registry);
  const Algorithm& algorithm = registry.find(arguments.algorithm);
  const Part& part = find_part(arguments.algorithm, arguments.part);
  if ((arguments.level > 0) != (part.draw == &Painter::balls)) {
    throw BadArgument("--level is needed for, and goes with, --part balls only");
  }
  if (!arguments.output.ends_with(".ply")) throw BadArgument(fmt::format("{}: must end in .ply", arguments.output));
  Settings settings = algorithm.settings();
  settings.set_all(arguments.settings);

  const Mesh mesh = load_model(arguments.model);
  const Drawing drawing = (Painter(mesh, settings, arguments).*part.draw)();
  save_ply({.vertices = drawing.vertices,
            .triangles = drawing.triangles,
            .vertex_colours = drawing.colours,
            .vertex_normals = drawing.normals},
           arguments.output);
  fmt::print("{}: {} {} as {} vertices and {} triangles\n", arguments.output, drawing.elements, part.name,
             drawing.vertices.size(), drawing.triangles.size());
}

}  // namespace

void add_show_command(CLI::App& app) {
  auto* const command = app.add_subcommand("show", "What an algorithm builds of a mesh, as a coloured PLY");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--algorithm", arguments->algorithm, "ist, vps or vps-field")->required();
  command->add_option("--model", arguments->model, "A model's name or a mesh file")->required();
  command->add_option("-o,--output", arguments->output, "The PLY file; replaced if it exists")->required();
  command->add_option("--part", arguments->part,
                      "ist: spheres (by radius) or balls (of the hierarchy, by level); vps and vps-field: voxels (by "
                      "layer) or points (with inward normals, by area). Default: the first");
  command->add_option("--level", arguments->level, "With --part balls: how deep in the hierarchy, from 1")
      ->check(CLI::Range(1, 64));
  command
      ->add_option("--keep", arguments->keep,
                   "Cut the body open: draw only what lies within this share of its box along x")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--set", arguments->settings, "A parameter of the algorithm: NAME=VALUE; may be repeated")
      ->allow_extra_args(false);
  command->callback([arguments] { run_show(*arguments); });
}

}  // namespace sixdof::cli
