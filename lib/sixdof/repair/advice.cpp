#include <sixdof/repair/advice.h>

#include <algorithm>

namespace sixdof {
namespace {

/// Above them vertices are joined that someone may have modelled as two.
constexpr double k_welds[] = {3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3};
constexpr std::size_t k_holes[] = {128, RepairOptions::k_largest_max_hole};

RepairAttempt attempt(const Mesh& mesh, const RepairOptions& options) {
  const RepairedMesh repaired = repair_mesh(mesh, options);
  return {options, repaired.mesh.topology().border_edges, repaired.mesh.solid()};
}

}  // namespace

std::vector<RepairAttempt> try_other_repairs(const Mesh& mesh, const RepairOptions& tried) {
  std::vector<RepairAttempt> attempts{attempt(mesh, tried)};
  for (const double weld : k_welds) {
    if (weld <= tried.weld) continue;
    attempts.push_back(attempt(mesh, {.weld = weld, .max_hole = tried.max_hole, .max_fin = tried.max_fin}));
    if (attempts.back().solid) return attempts;
  }
  // With the smallest tolerance that leaves the fewest open edges.
  const RepairOptions best = std::ranges::min_element(attempts, {}, &RepairAttempt::border_edges)->options;
  for (const std::size_t hole : k_holes) {
    if (hole <= tried.max_hole) continue;
    attempts.push_back(attempt(mesh, {.weld = best.weld, .max_hole = hole, .max_fin = best.max_fin}));
    if (attempts.back().solid) return attempts;
  }
  return attempts;
}

}  // namespace sixdof
