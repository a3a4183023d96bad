#pragma once

#include "bench/harness/suite.h"

namespace sixdof::bench {

/// Registers the rows of every family. A new family is a file rows/NAME.cpp with one function, named here.
void add_all_rows(Suite& suite);

/// `prepare/algorithm:A/pair:P`: build time, bytes and the counts that explain them.
void add_prepare_rows(Suite& suite);

/// `collide/algorithm:A/pair:P/distance:05`, `distance/...`: queries on the buckets of the configuration sets, in
/// random order, and in the grid's own order as `.../order:path`. `respond/algorithm:A/pair:P/volume:03` the same, with
/// the error of the volume that the algorithm sees against the bucket's and the angles of its force and torque to the
/// exact ones as counters (gamma_F_deg, gamma_max_F_deg, and of torques: lib/measure/metrics.h). What an algorithm says
/// about its work (Query::work) is in points_visited, points_present, ns_per_points and so on.
void add_query_rows(Suite& suite);

/// `scenario/II/algorithm:A`: mean time of a response along a scenario's path and, as counters, every measure of its
/// quality against the law that the algorithm declares (lib/measure/metrics.h names them).
void add_scenario_rows(Suite& suite);

/// `kernel/NAME/algorithm:A`: the inner loop of one algorithm on a body of recipe, with settings and poses that isolate
/// it: time per point on a map in cache and out of it without culling, time per pair of balls, a response without
/// contact.
void add_kernel_rows(Suite& suite);

/// What a configuration of the paper's grid and buckets costs to make, on the same seeded rays for all, as the counter
/// ns_per_configuration (CPU time):
/// - `generate/distance/algorithm:raycast/pair:P`: make_ray_cast();
/// - `generate/distance/algorithm:fcl/...`: plain conservative advancement by FCL's distances, every configuration
///   alone from outside (SphereMarch::conservative);
/// - `generate/distance/algorithm:fcl-sweep/...`: certified steps from bucket to bucket by the same distances;
/// - `generate/volume/algorithm:overlap/...`.
/// For the catalogue's pairs and for recipes of 10k to a million triangles, which are made on the spot; some rows take
/// half a minute. bench/run leaves them out unless asked for: `--benchmark_filter=^generate/`. bench/generate-ratios
/// prints how many times faster the ray cast is than FCL.
void add_generate_rows(Suite& suite);

}  // namespace sixdof::bench
