#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Splits border edges at the border vertices that lie on them within `tolerance` (length) and more than it from their
/// ends, if a border edge from such a vertex runs along them: then the triangles on both sides have the same edges. A
/// split that would turn a part over is left out.
/// @return repairs made
std::size_t split_at_t_junctions(Surface& surface, double tolerance, RepairLog& log);

}  // namespace sixdof::repairing
