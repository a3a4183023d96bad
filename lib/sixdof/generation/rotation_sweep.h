#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/generation/distance_generator.h>

/// The loop over rotations and directions that fills buckets of either kind. Internal: use distance_generator.h or
/// volume_generator.h.
namespace sixdof::detail {

/// Solves every distinct rotation once, on several threads, and copies its rows to its repeats. The result has the same
/// bits for every number of threads.
/// @param prepare makes the solver of a thread
/// @param summaries of buckets of one kind; their largest residuals are filled in
/// @param rotations indices into the grid; empty: all rotations of the grid
/// @return the buckets in the order of `summaries`
/// @throws BadArgument if there is no bucket, one is asked for twice, or the grid does not have one of the rotations;
/// Interrupted; Error from the solver naming the configuration
Generated sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                          const std::vector<BucketSummary>& summaries, const RunOptions& run,
                          std::span<const std::uint32_t> rotations);

}  // namespace sixdof::detail
