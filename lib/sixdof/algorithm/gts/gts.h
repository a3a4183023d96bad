#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `gts`: Boolean operations of the GNU Triangulated Surface library. Answers collide and respond.
///
/// **Prepare** builds a surface of each mesh and the tree of A. **A query** moves B's vertices, builds B's tree of
/// boxes and computes the curves in which the surfaces intersect (gts_surface_inter_new()), as GTS's example `set`
/// does. collide asks whether there are any, or whether a vertex of one body is inside the other. respond then takes
/// the parts of either surface that are inside the other body (gts_surface_inter_boolean()); volume and force are sums
/// over their triangles (volume_response.h). Nothing is kept from query to query.
///
/// **Precision.** GTS's predicates are exact, its new vertices are rounded to double precision.
///
/// **Profiles.** None: GTS's manual gives no other advice for these queries.
///
/// **Process.** GTS is not made for threads: queries take turns; a mutex serves one at a time. The first preparation
/// silences GTS's messages for the rest of the process.
///
/// **Known failures.**
/// - Where faces of both bodies lie in one plane GTS may end the process (a failed assertion of its own, with words on
///   standard error), or never return. Whether it does depends on the addresses that it was given, by which its hash
///   tables are ordered: `sixdof query --a box-300 --b box-300 --pose "0 0 0 1 0 0 0" --algorithm gts` dies in four
///   runs of five; of three runs of the ship at 5 % of volume, where two of eight poses are of this kind, one ended,
///   one died and one ran on. Nothing can stop that within the process: ask poses like these in a process of their own.
///   On generic poses it has not been seen.
/// - Answers repeat to rounding, not to the bit: GTS's hash tables are in the order of addresses.
/// - Curves that are not closed are a failed response ("the curves are not closed").
/// - A body inside the other counts by one vertex: bodies of several shells, of which some are inside and none crosses,
///   are answered for the first shell.
///
/// Not in suites and studies of all algorithms (Traits::by_default): every query rebuilds B's tree and the curves.
std::unique_ptr<Algorithm> make_gts_algorithm();

/// Adds it.
void register_gts_algorithms(Registry& registry);

}  // namespace sixdof
