#pragma once

#include <string>

#include <sixdof/results/row_group.h>

namespace sixdof::results {

/// A count as the paper prints it: "15,669".
std::string count_text(double count);

/// What a row says of an algorithm's resolution, as the paper's Figure 6 has it: voxels along the axes and points,
/// "728x24x303, 15,669", or spheres of A and, where they are others, of B. Empty of rows without these counts.
std::string resolution_text(const RowGroup& group);

}  // namespace sixdof::results
