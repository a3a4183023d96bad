#include "bench/cli/commands.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>

#include "bench/cli/shared.h"
#include "bench/cli/structure_drawing.h"

namespace sixdof::cli {
namespace {

struct Arguments {
  AlgorithmOptions algorithm;
  std::string model, part, output;
  int level = 0;
  double keep = 1.0;
};

/// What to draw: which structure of which mesh, at which level of the hierarchy, cut open at which x.
struct Subject {
  const Mesh& mesh;
  const Settings& settings;
  int level;
  double cut_x;
};

ist::SphereTree tree_of(const Subject& s) { return ist::build_inner_sphere_tree(s.mesh, s.settings).tree; }
Drawing points(const Subject& s) { return draw_points(vps::prepare_pointshell(s.mesh, s.settings), s.cut_x); }
Drawing voxels(const Subject& s) { return draw_voxels(vps::prepare_voxelmap(s.mesh, s.settings), s.cut_x); }
Drawing field(const Subject& s) {
  return draw_field(vps::prepare_field(s.mesh, vps::prepare_voxelmap(s.mesh, s.settings)), s.cut_x);
}
Drawing spheres(const Subject& s) { return draw_spheres(tree_of(s), s.cut_x); }
Drawing balls(const Subject& s) { return draw_balls(tree_of(s), s.level, s.cut_x); }

struct Part {
  const char* algorithm;
  const char* name;
  Drawing (*draw)(const Subject&);
};

/// The first part of an algorithm is the default.
constexpr Part k_parts[] = {
    {"ist", "spheres", spheres}, {"ist", "balls", balls},        {"vps", "voxels", voxels},
    {"vps", "points", points},   {"vps-field", "voxels", field}, {"vps-field", "points", points},
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
  const auto [registry, algorithm, settings] = select_algorithm(arguments.algorithm);
  const Part& part = find_part(arguments.algorithm.name, arguments.part);
  if ((arguments.level > 0) != (part.draw == balls)) {
    throw BadArgument("--level is needed with --part balls, and not allowed with other parts");
  }
  if (!arguments.output.ends_with(".ply")) throw BadArgument(fmt::format("{}: must end in .ply", arguments.output));

  const Mesh mesh = load_model(arguments.model);
  const double cut_x = arguments.keep < 1.0 ? mesh.box().min().x() + arguments.keep * mesh.box().sizes().x() : k_uncut;
  const Drawing drawing = part.draw({mesh, settings, arguments.level, cut_x});
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
  auto* const command = app.add_subcommand(
      "show", "Write what an algorithm prepares from a mesh (spheres, voxels or points) as a coloured PLY file");
  const auto arguments = std::make_shared<Arguments>();
  add_algorithm_options(*command, arguments->algorithm, "ist, vps or vps-field")->required();
  command->add_option("--model", arguments->model, "A model's name or a mesh file")->required()->type_name("MESH");
  command->add_option("-o,--output", arguments->output, "The PLY file; replaced if it exists")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--part", arguments->part,
                   "ist: spheres (by radius) or balls (of the hierarchy, by level); vps and vps-field: voxels (by "
                   "layer) or points (with inward normals, by area)")
      ->type_name("PART")
      ->default_str("the first");
  command->add_option("--level", arguments->level, "With --part balls: level of the hierarchy, from 1 (below the root)")
      ->type_name("N")
      ->check(CLI::Range(1, 64));
  command
      ->add_option("--keep", arguments->keep, "Cut the body open: draw only this fraction of its bounding box along x")
      ->type_name("FRACTION")
      ->check(CLI::Range(0.0, 1.0));
  command->callback([arguments] { run_show(*arguments); });
  add_examples(*command, "sixdof show --algorithm vps --model cone-1k --keep 0.5 -o voxels.ply",
               "sixdof show --algorithm ist --model cone-1k -p spheres=300 --part balls --level 2 -o balls.ply");
}

}  // namespace sixdof::cli
