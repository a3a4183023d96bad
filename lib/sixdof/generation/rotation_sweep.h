#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/configuration/grid.h>

/// The loop over rotations and directions that makes buckets of either kind. Internal: use distance_generator.h or
/// volume_generator.h.
namespace sixdof::detail {

/// Number of rotations that options ask for. @throws BadArgument if the grid does not have one of them
std::size_t rotations_asked(const Grid& grid, const GenerateOptions& options);

/// Puts buckets into the order in which a ray meets them (by percentage), and makes room for their translations.
/// @throws BadArgument if there is none or a percentage stands twice
void order_buckets(std::vector<Bucket>& buckets, bool descending, std::size_t configurations);

/// Fills in translation and largest residual of all buckets: every distinct rotation once, spread over threads; copies for
/// the others. The result is the same bits for every number of threads.
/// @param prepare makes one solver per thread; its targets are those of `buckets`, in their order
/// @return measurements of all solvers
std::uint64_t sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                              std::vector<Bucket>& buckets, const GenerateOptions& options);

}  // namespace sixdof::detail
