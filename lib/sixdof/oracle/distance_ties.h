#pragma once

#include <functional>
#include <vector>

#include <sixdof/oracle/distance_search.h>

/// Which of equally far pairs of triangles is the answer. Internal: use distance.h.
///
/// Between coplanar patches the distances of thousands of pairs count as equal (TieWindow), and the answer is the pair
/// of smallest rank. A search prunes pairs that can at most tie with the best, and records them. Afterwards they are
/// expanded in the order of the smallest rank that each contains, so that few need to be expanded.
namespace sixdof::detail {

/// Appends the pairs of parts of a pair that is not of triangles, but for those that are certainly farther than ties.
using SplitPair = std::function<void(const NodePair& pair, std::vector<NodePair>& parts)>;

/// Takes the pair of smallest rank whose distance counts as equal to the smallest, of those measured and of those in
/// search.tied. Returns false if it cannot be decided: a pair in `tied` may have a smaller distance than the best, and
/// whether a pair of small rank counts as equal depends on that distance.
bool resolve_ties(DistanceSearch& search, const SplitPair& split);

}  // namespace sixdof::detail
