#pragma once

#include <vector>

#include "bench/harness/row.h"

/// The families of rows. A new family is a file rows/NAME.cpp with one function, declared here and called in
/// sixdof_bench.cpp. lib/sixdof/measure/metrics.h explains the counters.

namespace sixdof::bench {

/// `prepare/algorithm:A/pair:P`: time to build the structures of a pair, their size and the counts that explain it.
std::vector<PlannedRow> prepare_rows(const Resources& resources);

/// `collide/algorithm:A/pair:P/distance:05`, `distance/...`, `respond/algorithm:A/pair:P/volume:03`: queries on the
/// buckets of the configuration sets, in random order, and in the grid's own order as `.../order:path`; in random order
/// on cold caches as `.../cache:cold`. Responses are compared with the bucket's volume and with the directions of the
/// exact ones; `respond/.../distance:05` counts and measures forces of bodies that are apart, where there should be
/// none.
std::vector<PlannedRow> query_rows(const Resources& resources);

/// `cast/algorithm:A/pair:P/motion:tumble/step:10`: when B first touches A on motions from the poses of contact of a
/// set (lib/sixdof/generation/motions.h) that move B by 10 % of A's diagonal, judged by stored_impacts(); those of
/// algorithms about convex hulls by that of the hulls, on the same motions. The
/// default suite has steps of 10 % of two pairs.
std::vector<PlannedRow> cast_rows(const Resources& resources);

/// `contacts/algorithm:A/pair:P/volume:03`: contacts of bodies that overlap, on the buckets of the sets in random
/// order, and along motions from a few of the configurations as `.../order:motion`. Exact geometry judges them
/// (lib/sixdof/measure/contact_score.h); in random order they are also compared with those of exchanged bodies and of
/// moved ones, along motions with those of the pose before. They are not in the default suite.
std::vector<PlannedRow> contact_rows(const Resources& resources);

/// `depth/algorithm:A/pair:P/volume:05`: how deep B is in A, by the largest depth of the algorithm's contacts or by the
/// penalty of a law of depth, judged against the interval of the translational penetration depth
/// (lib/sixdof/oracle/penetration.h) of the meshes, or of their hulls for an algorithm of hulls.
/// PenetrationTruths::k_most configurations at most. They are not in the default suite.
std::vector<PlannedRow> depth_rows(const Resources& resources);

/// `scenario/II/algorithm:A`: mean time of a response along a scenario's path and every measure of its quality, against
/// the law that the algorithm declares and, with the suffix "_by_LAW", against every other.
std::vector<PlannedRow> scenario_rows(const Resources& resources);

/// `scene/FAMILY/n:1000/question:touching/algorithm:A`: a scene of many bodies (lib/sixdof/scene) replayed to an
/// algorithm for scenes, judged against every pair in every frame. One missed pair is an error of the row. They are not
/// in the default suite; bench/scenes_suite.json lists those of 1,000 bodies.
std::vector<PlannedRow> scene_rows(const Resources& resources);

/// `deform/FAMILY/amplitude:3/question:touching/algorithm:A`: a scene in which a mesh deforms, by up to 3 % of its
/// diagonal, replayed to every algorithm that takes such scenes: those of `exact` and of the libraries differ in how
/// they update (`exact-refit`, `fcl-rebuild`, ...). Update and query are timed apart and together, and judged as scenes
/// are. They are not in the default suite; bench/deform_suite.json lists them.
std::vector<PlannedRow> deform_rows(const Resources& resources);

/// What a configuration of the paper's grid and buckets costs to make, on the same seeded rays for all, as the counter
/// ns_per_configuration (processor time):
/// - `generate/distance/algorithm:raycast/pair:P`: make_ray_cast();
/// - `generate/distance/algorithm:fcl/...`: conservative advancement by FCL's distances, every configuration alone from
///   outside (SphereMarch::conservative);
/// - `generate/distance/algorithm:fcl-sweep/...`: certified steps from bucket to bucket by the same distances;
/// - `generate/volume/algorithm:overlap/...`.
/// For the catalogue's pairs and for generated models of 10k to a million triangles. Some rows take half a minute, so
/// they are not in the default suite. `sixdof table --of raycast --against fcl` prints how many times faster the ray
/// cast is than FCL.
std::vector<PlannedRow> generate_rows(const Resources& resources);

}  // namespace sixdof::bench
