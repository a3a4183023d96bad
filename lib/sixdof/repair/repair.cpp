#include <sixdof/repair/repair.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/repair/steps.h>

namespace sixdof {
namespace repairing {

void erase_marked(std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& marked) {
  std::erase_if(triangles, [&](const Triangle& t) {
    const auto i = static_cast<std::size_t>(&t - triangles.data());
    return i < marked.size() && marked[i] != 0;
  });
}

std::vector<Side> border_sides(std::span<const Side> sorted) {
  std::vector<Side> border;
  for_each_edge(sorted, [&](std::span<const Side> edge) {
    if (edge.size() == 1) border.push_back(edge[0]);
  });
  return border;
}

}  // namespace repairing

namespace {

constexpr double k_largest_weld = 0.1;
/// Rounds until nothing is left to do: two or three in most cases. Each may make room for another step.
constexpr std::size_t k_most_passes = 32;

void check(const RepairOptions& options) {
  if (!(options.weld >= 0.0 && options.weld <= k_largest_weld)) {
    throw BadArgument(
        fmt::format("the tolerance of welding is {}, but must be from 0 to {}", options.weld, k_largest_weld));
  }
  if (options.max_hole > RepairOptions::k_largest_max_hole) {
    throw BadArgument(fmt::format("holes of up to {} edges can be filled; {} were asked for",
                                  RepairOptions::k_largest_max_hole, options.max_hole));
  }
  if (!(options.max_fin >= 0.0 && options.max_fin <= 1.0)) {
    throw BadArgument(fmt::format("the largest fin is {} of the area, but must be from 0 to 1", options.max_fin));
  }
}

/// All steps once. @return repairs made
std::size_t run_steps(RawMesh& surface, double tolerance, const RepairOptions& options, RepairLog& log) {
  std::size_t made = repairing::weld_border(surface, tolerance, log);
  made += repairing::drop_duplicates(surface, log);
  made += repairing::drop_degenerate(surface, log);
  made += repairing::split_at_t_junctions(surface, tolerance, log);
  made += repairing::orient(surface, log);
  made += repairing::drop_superfluous(surface, options.max_fin, log);
  made += repairing::fill_holes(surface, options.max_hole, log);
  return made;
}

}  // namespace

RepairedMesh repair_mesh(const Mesh& mesh, const RepairOptions& options) {
  check(options);
  const double rounding = std::max(repairing::rounding_at(mesh.box().min()), repairing::rounding_at(mesh.box().max()));
  const double tolerance = std::max(options.weld * mesh.diagonal(), rounding);
  RawMesh surface{mesh.vertices(), mesh.triangles()};
  RepairLog log;
  std::size_t passes = 0;
  bool converged = false;
  while (!converged && passes < k_most_passes) {
    converged = run_steps(surface, tolerance, options, log) == 0;
    ++passes;
  }
  return {.mesh = Mesh::build(std::move(surface.vertices), std::move(surface.triangles), mesh.name()),
          .log = std::move(log),
          .passes = passes,
          .converged = converged};
}

}  // namespace sixdof
