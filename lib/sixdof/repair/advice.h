#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <sixdof/repair/repair.h>

namespace sixdof {

/// How far the middles of a mesh's border edges are from the nearest other border edge, relative to the diagonal of its
/// box. Of gaps between parts that belong together it is at most the gap's width, of holes about an edge's length.
struct RepairGaps {
  std::size_t edges = 0;
  double median = 0.0, largest = 0.0;
};

/// Empty for a mesh without two border edges.
std::optional<RepairGaps> measure_gaps(const Mesh& mesh);

/// What repair_mesh() leaves with other options.
struct RepairAttempt {
  RepairOptions options;
  std::size_t border_edges = 0;  ///< Left.
  bool solid = false;
};

/// Tries larger tolerances for welding, then larger holes, until one gives a solid, which is the last attempt then; at
/// most ten. @param tried did not give a solid
std::vector<RepairAttempt> try_other_repairs(const Mesh& mesh, const RepairOptions& tried);

}  // namespace sixdof
