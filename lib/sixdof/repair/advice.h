#pragma once

#include <cstddef>
#include <vector>

#include <sixdof/repair/repair.h>

namespace sixdof {

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
