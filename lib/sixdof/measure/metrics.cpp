#include <sixdof/measure/metrics.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sixdof {
namespace {

constexpr std::string_view k_paper = "Weller et al. 2010";
constexpr std::string_view k_paper_sigma = "Weller et al. 2010 (1), read as RMS";
constexpr std::string_view k_paper_sigma_printed = "Weller et al. 2010 (1), as printed";
constexpr std::string_view k_paper_gamma = "Weller et al. 2010 (2)";
constexpr std::string_view k_paper_nu = "Weller et al. 2010 (3)";
constexpr std::string_view k_paper_nu_direction = "Weller et al. 2010 (3), up to the cut-off";
constexpr std::string_view k_paper_eta = "Weller et al. 2010 (4)";
constexpr std::string_view k_equivalent = "bench/study/equivalent.h";
constexpr std::string_view k_google = "Google Benchmark";
constexpr std::string_view k_magnitude = "lib/sixdof/measure/magnitude.h";
constexpr std::string_view k_direction = "lib/sixdof/measure/direction.h";
constexpr std::string_view k_spectrum = "lib/sixdof/measure/spectrum.h";
constexpr std::string_view k_path = "lib/sixdof/measure/path.h";
constexpr std::string_view k_latency = "lib/sixdof/measure/latency.h";
constexpr std::string_view k_check = "bench/harness/judge.h";
constexpr std::string_view k_timing = "bench/harness/timing.h";
constexpr std::string_view k_work = "bench/harness/work.h";
constexpr std::string_view k_status = "lib/sixdof/query/algorithm.h (Status)";
constexpr std::string_view k_footprint = "lib/sixdof/query/algorithm.h (Footprint)";
constexpr std::string_view k_generate_row = "bench/rows/generate.cpp";
constexpr std::string_view k_query_row = "bench/rows/query.cpp";
constexpr std::string_view k_answers = "bench/study/answer_errors.h";
constexpr std::string_view k_precision = "bench/study/precision.h";

constexpr std::string_view k_contact = "lib/sixdof/measure/contact_score.h";
constexpr std::string_view k_contact_truth = "lib/sixdof/oracle/contact_truth.h";
constexpr std::string_view k_hausdorff = "Dubuisson and Jain 1994, mean of both ways";
constexpr std::string_view k_impact = "lib/sixdof/oracle/impact_verdict.h";
constexpr std::string_view k_depth = "lib/sixdof/oracle/penetration_verdict.h";
constexpr std::string_view k_depth_row = "bench/rows/depth.cpp";
constexpr std::string_view k_scene = "lib/sixdof/scene/score.h";
constexpr std::string_view k_scene_work = "lib/sixdof/scene/scene_algorithm.h (SceneWork)";

using enum Better;

/// Names with a '*' come last: find_metric() takes the first match.
// clang-format off
constexpr std::array k_metrics{
    // Quality of responses. In scenarios the truth is an ideal model, in overlap buckets the exact response.
    Metric{"sigma_F", "1", lower, "RMS difference of force magnitudes, each normalised by its maximum", k_paper_sigma},
    Metric{"sigma_T", "1", lower, "RMS difference of torque magnitudes, each normalised by its maximum", k_paper_sigma},
    Metric{"sigma_paper_F", "1", lower, "sigma_F as printed, (1/N) sqrt(sum): falls with N", k_paper_sigma_printed},
    Metric{"sigma_paper_T", "1", lower, "sigma_T as printed, (1/N) sqrt(sum): falls with N", k_paper_sigma_printed},
    Metric{"gain_F", "measured/ideal", neither, "least-squares factor from ideal to measured forces", k_magnitude},
    Metric{"gain_T", "measured/ideal", neither, "least-squares factor from ideal to measured torques", k_magnitude},
    Metric{"sigma_gain_F", "1", lower, "RMS difference of forces after the gain, over gain * max|ideal|", k_magnitude},
    Metric{"sigma_gain_T", "1", lower, "RMS difference of torques after the gain, over gain * max|ideal|", k_magnitude},
    Metric{"magnitude_error_F", "1", lower, "RMS of |F| - gain |true F| over the RMS of |F|, 0..1", k_magnitude},
    Metric{"magnitude_error_T", "1", lower, "RMS of |T| - gain |true T| over the RMS of |T|, 0..1", k_magnitude},
    Metric{"gamma_F_deg", "degree", lower, "mean angle between true and measured force", k_paper_gamma},
    Metric{"gamma_T_deg", "degree", lower, "mean angle between true and measured torque", k_paper_gamma},
    Metric{"gamma_max_F_deg", "degree", lower, "largest angle between true and measured force", k_direction},
    Metric{"gamma_max_T_deg", "degree", lower, "largest angle between true and measured torque", k_direction},
    Metric{"gamma_own_F_deg", "degree", lower, "mean angle between the force of the own law and the measured one", k_query_row},
    Metric{"gamma_own_T_deg", "degree", lower, "mean angle between the torque of the own law and the measured one", k_query_row},
    Metric{"gamma_own_max_F_deg", "degree", lower, "largest angle between the force of the own law and the measured one", k_query_row},
    Metric{"gamma_own_max_T_deg", "degree", lower, "largest angle between the torque of the own law and the measured one", k_query_row},
    Metric{"magnitude_error_own_F", "1", lower, "magnitude_error_F against the forces of the own law", k_query_row},
    Metric{"magnitude_error_own_T", "1", lower, "magnitude_error_T against the torques of the own law", k_query_row},
    Metric{"compared_own", "queries", neither, "both forces are nonzero: those in gamma_own_F_deg, at most 32", k_query_row},
    Metric{"unjudged_own", "queries", neither, "the force of the own law is not known to 1 %; absent for none", k_query_row},
    Metric{"unjudged_own_T", "queries", neither, "the torque of the own law is not known to 1 %; absent for none", k_query_row},
    Metric{"gamma_F_p95_deg", "degree", lower, "95 % of the angles between true and measured force are no larger", k_answers},
    Metric{"gamma_T_p95_deg", "degree", lower, "95 % of the angles between true and measured torque are no larger", k_answers},
    Metric{"gamma_F_finest_deg", "degree", lower, "mean angle to the forces of the finest point of the same algorithm", k_precision},
    Metric{"penalty_error", "1", lower, "magnitude_error_F of the penalty against the exact volume, 0..1", k_answers},
    Metric{"misses", "queries", lower, "truth is not zero, measured force (or torque) is: tunnelling", k_direction},
    Metric{"false_contacts", "queries", lower, "ideal is zero, measured is not", k_direction},
    Metric{"skipped", "queries", neither, "ideal and measured are both zero", k_direction},
    Metric{"compared", "queries", neither, "true and measured force are both nonzero: those in gamma", k_direction},
    Metric{"nu_F", "1", nearer_one, "energy of the normalised force magnitude over the ideal's", k_paper_nu},
    Metric{"nu_T", "1", nearer_one, "energy of the normalised torque magnitude over the ideal's", k_paper_nu},
    Metric{"nu_direction_F", "1", nearer_one, "energy of the force's direction below the cut-off, over the ideal's", k_paper_nu_direction},
    Metric{"nu_direction_T", "1", nearer_one, "energy of the torque's direction below the cut-off, over the ideal's", k_paper_nu_direction},
    Metric{"noise_F", "1", lower, "energy of the residual force above the cut-off, over the ideal's", k_spectrum},
    Metric{"noise_T", "1", lower, "energy of the residual torque above the cut-off, over the ideal's", k_spectrum},
    Metric{"sigma_q", "1", lower, "RMS difference of penalties, each normalised by its maximum", k_paper_sigma},
    Metric{"gain_q", "measured/ideal", neither, "least-squares factor from ideal to measured penalties", k_magnitude},
    Metric{"sigma_gain_q", "1", lower, "RMS difference of penalties after the gain, over gain * max|ideal|", k_magnitude},
    Metric{"nu_q", "1", nearer_one, "energy of the normalised penalty over the ideal's", k_paper_nu},
    Metric{"leakage", "1", lower, "unwanted part over wanted part, scaled by the reference length", k_path},
    Metric{"lag", "steps", lower, "shift of the measured wrench against the ideal, positive if late", k_path},
    Metric{"jump_F", "1", lower, "largest jump of the force that refinement leaves, over its peak", k_path},
    Metric{"jump_T", "1", lower, "largest jump of the torque that refinement leaves, over its peak", k_path},
    Metric{"loop_work", "1", lower, "work on the closed path over peak force times length", k_path},
    Metric{"volume_error_mean", "1", lower, "mean |volume - bucket's volume| over the bucket's volume", k_check},
    Metric{"phantoms", "queries", lower, "responses with a force or torque although the bodies are apart", k_check},
    Metric{"phantom_force_mean", "1", lower, "their mean force over the algorithm's mean force at the pair's least overlap", k_query_row},
    Metric{"phantom_force_max", "1", lower, "their largest force over the algorithm's mean force at the pair's least overlap", k_query_row},
    Metric{"volume_error_max", "1", lower, "largest |volume - bucket's volume| over the bucket's volume", k_check},
    // Correctness of other answers.
    Metric{"failed", "queries", lower, "no answer: refused, thrown, or not finite", "bench/harness/guarded_query.h"},
    Metric{"crashed", "queries", lower, "of the failed: the process ended; absent for none", k_status},
    Metric{"timed_out", "queries", lower, "of the failed: no answer within the limit; absent for none", k_status},
    Metric{"out_of_memory", "queries", lower, "of the failed: more memory than there is; absent for none", k_status},
    Metric{"judged", "queries", neither, "answers for which the truth is known", k_check},
    Metric{"mismatch", "queries", lower, "wrong answers among the judged ones", k_check},
    Metric{"judged_apart", "queries", neither, "judged answers at 1 % of A's diagonal or farther apart", k_answers},
    Metric{"judged_near", "queries", neither, "judged answers within 1 % of A's diagonal of contact, apart or not", k_answers},
    Metric{"judged_overlapping", "queries", neither, "judged answers deeper in each other", k_answers},
    Metric{"wrong_apart", "queries", lower, "wrong answers among judged_apart", k_answers},
    Metric{"wrong_near", "queries", lower, "wrong answers among judged_near", k_answers},
    Metric{"wrong_overlapping", "queries", lower, "wrong answers among judged_overlapping", k_answers},
    Metric{"error_rms", "diagonal", lower, "RMS of |distance - truth| over A's box diagonal", k_check},
    Metric{"error_max", "diagonal", lower, "largest |distance - truth| over A's box diagonal", k_check},
    Metric{"error_mean", "diagonal", lower, "mean of distance - truth, signed, over A's box diagonal", k_answers},
    Metric{"too_small", "queries", lower, "distances below the truth by more than its tolerance: conservative", k_answers},
    Metric{"too_large", "queries", lower, "distances above the truth by more than its tolerance", k_answers},
    Metric{"false_positives", "queries", lower, "bodies apart, the answer is a collision", k_answers},
    Metric{"false_negatives", "queries", lower, "bodies overlap, the answer is none", k_answers},
    Metric{"touching", "queries", neither, "bodies touch: both answers are right", k_answers},
    Metric{"touching_yes", "queries", neither, "touching bodies that are said to collide", k_answers},
    // Casts.
    Metric{"early", "queries", lower, "hits before the contact by more than the tolerance: conservative", k_impact},
    Metric{"early_max", "1", lower, "by how much of the motion the earliest of them is", k_impact},
    Metric{"late_hits", "queries", lower, "hits after the contact by more than the tolerance: unsafe", k_impact},
    Metric{"late_max", "1", lower, "by how much of the motion the latest of them is", k_impact},
    Metric{"missed_hits", "queries", lower, "no hit although there is one: tunnelling", k_impact},
    Metric{"phantom_hits", "queries", lower, "a hit although there is none", k_impact},
    Metric{"false_starts", "queries", lower, "contact at the start of bodies that are apart there", k_impact},
    Metric{"grazing", "queries", neither, "motions whose truth is not decided; not judged", k_impact},
    Metric{"hits", "queries", neither, "motions whose truth is a hit or a contact at the start", k_impact},
    Metric{"normal_max_deg", "degree", lower, "largest angle between normal and true normal of right hits", k_impact},
    // Depths.
    Metric{"too_shallow", "queries", lower, "depths below the penetration depth: unsafe, B still overlaps A after it", k_depth},
    Metric{"too_deep", "queries", lower, "depths above the penetration depth", k_depth},
    Metric{"missed_depths", "queries", lower, "no depth although the bodies overlap; counted as too shallow as well", k_depth},
    Metric{"too_shallow_max", "1", lower, "largest part of the depth that is missing", k_depth},
    Metric{"too_deep_max", "1", lower, "largest excess over the depth, by the depth", k_depth},
    Metric{"depth_ratio", "measured/true", nearer_one, "mean of depth over penetration depth", k_depth_row},
    Metric{"open_depths", "queries", neither, "configurations whose interval is open: not judged", k_depth},
    Metric{"depth_width_max", "1", neither, "largest (hi - lo) / hi of the intervals that judge", k_depth_row},
    Metric{"depth_of_ray", "1", neither, "mean of the penetration depth over the way out along the configuration's ray", k_depth_row},
    // Contacts of bodies that overlap.
    Metric{"contacts_mean", "contacts", neither, "mean number of contacts of a query", k_contact},
    Metric{"contacts_max", "contacts", neither, "largest number of contacts of a query", k_contact},
    Metric{"full_answers", "queries", neither, "as many contacts as were asked for: there may be more", "bench/rows/contacts.cpp"},
    Metric{"non_finite", "queries", lower, "of the failed: a contact holds a NaN or an infinity", k_status},
    Metric{"without_contact", "queries", lower, "no contact although the bodies overlap", k_contact},
    Metric{"judged_contacts", "contacts", neither, "contacts that are judged, at most 128 of a query", k_contact},
    Metric{"off_bodies", "contacts", lower, "judged contacts outside of both bodies by more than 1e-6 of A's diagonal", k_contact_truth},
    Metric{"reversed_normals", "contacts", lower, "normals more than 100 degrees from every true one", k_contact_truth},
    Metric{"contact_off_mean", "diagonal", lower, "mean distance of a contact from being in both bodies", k_contact_truth},
    Metric{"contact_off_max", "diagonal", lower, "largest distance of a contact from being in both bodies", k_contact_truth},
    Metric{"contact_normal_deg", "degree", lower, "mean angle of a normal to the nearest true normal cone", k_contact_truth},
    Metric{"contact_normal_max_deg", "degree", lower, "largest angle of a normal to the nearest true normal cone", k_contact_truth},
    Metric{"contact_force_deg", "degree", lower, "mean angle of the mean normal of a query to the exact force", k_contact},
    Metric{"contact_force_max_deg", "degree", lower, "largest angle of the mean normal of a query to the exact force", k_contact},
    Metric{"contact_depth_ratio", "1", nearer_one, "sum of depths over the sum of thicknesses of the intersection along the normals", k_contact_truth},
    Metric{"uncovered_mean", "diagonal", lower, "distance of the true point farthest from all contacts, mean over queries", k_contact},
    Metric{"uncovered_max", "diagonal", lower, "distance of the true point farthest from all contacts, largest", k_contact},
    Metric{"astray_mean", "diagonal", lower, "distance of the contact farthest from all true points, mean over queries", k_contact},
    Metric{"astray_max", "diagonal", lower, "distance of the contact farthest from all true points, largest", k_contact},
    Metric{"exchange_normal_deg", "degree", lower, "mean angle of normals of (A, B) to those of (B, A), reversed", k_contact},
    Metric{"exchange_flips", "contacts", lower, "such angles above 90 degrees: normals that flip", k_contact},
    Metric{"exchange_points", "diagonal", lower, "mean distance of contacts of (A, B) and of (B, A)", k_hausdorff},
    Metric{"exchange_number", "queries", lower, "(A, B) and (B, A) have other numbers of contacts", k_contact},
    Metric{"exchange_failed", "queries", lower, "no answer to (B, A) where (A, B) has one", k_contact},
    Metric{"moved_normal_deg", "degree", lower, "mean angle of normals before and after a rigid motion of both bodies", k_contact},
    Metric{"moved_flips", "contacts", lower, "such angles above 90 degrees", k_contact},
    Metric{"moved_points", "diagonal", lower, "mean distance of contacts before and after a rigid motion of both bodies", k_hausdorff},
    Metric{"moved_number", "queries", lower, "another number of contacts after a rigid motion of both bodies", k_contact},
    Metric{"moved_failed", "queries", lower, "no answer after a rigid motion of both bodies where there is one before", k_contact},
    Metric{"step_normal_deg", "degree", lower, "angle by which the mean normal turns in a step of a motion, mean", k_contact},
    Metric{"step_normal_max_deg", "degree", lower, "angle by which the mean normal turns in a step of a motion, largest", k_contact},
    Metric{"step_force_deg", "degree", neither, "angle by which the exact force turns in a step, mean", k_contact},
    Metric{"step_force_max_deg", "degree", neither, "angle by which the exact force turns in a step, largest", k_contact},
    Metric{"step_points_mean", "diagonal", lower, "how far the set of contacts moves in a step, mean", k_hausdorff},
    Metric{"step_points_max", "diagonal", lower, "how far the set of contacts moves in a step, largest", k_hausdorff},
    Metric{"step_center_mean", "diagonal", neither, "how far the exact centre of the intersection moves in a step, mean", k_contact},
    Metric{"step_center_max", "diagonal", neither, "how far the exact centre of the intersection moves in a step, largest", k_contact},
    // Scenes of many bodies.
    Metric{"missed_pairs", "pairs", lower, "true pairs of all frames that are not reported", k_scene},
    Metric{"wrong_pairs", "pairs", lower, "pairs of all frames that are reported and not true", k_scene},
    Metric{"grazing_pairs", "pairs", neither, "of either, where 1e-5 of the bodies' size decides", k_scene},
    Metric{"nested_pairs", "pairs", neither, "of bodies inside others, not reported by algorithms that test surfaces only",
           k_scene},
    Metric{"same_bits", "1", higher, "1: all answers have the bits of the truth", k_scene},
    Metric{"true_pairs", "pairs", neither, "pairs per frame in the truth", k_scene},
    Metric{"false_per_true", "1", lower, "pairs asked of the narrow phase that are not true, per true pair", k_scene},
    Metric{"pairs_looked_at", "pairs", lower, "candidates of the broad phase per frame", k_scene_work},
    Metric{"pairs_never_looked_at", "pairs", higher, "pairs that matter and are no candidates, per frame", k_scene_work},
    Metric{"pairs_put_off", "pairs", higher, "candidates per frame not tested, since the bodies cannot have moved close enough", k_scene_work},
    Metric{"undecided_pairs", "pairs", neither, "of all frames, of impacts that pass each other too closely to decide; absent for none", k_scene_work},
    Metric{"triangle_pairs", "pairs", lower, "pairs of triangles tested exactly, per frame", k_scene_work},
    Metric{"bodies", "bodies", neither, "bodies of the scene", k_scene},
    Metric{"frames", "frames", neither, "frames of the scene, the first included", k_scene},
    Metric{"first_frame_ns", "ns", lower, "wall time of the first frame, in which every pair is new", k_scene},
    Metric{"p99_frame_ns", "ns", lower, "99 % of the further frames take no longer", k_scene},
    // Meshes that deform.
    Metric{"amplitude", "%", neither, "largest displacement of a vertex, of the mesh's diagonal", "lib/sixdof/scene/families.h"},
    Metric{"update_ns", "ns", lower, "mean processor time of a frame's update of meshes and bodies", k_scene},
    Metric{"answer_ns", "ns", lower, "mean processor time of a frame's query after the update", k_scene},
    Metric{"deformed_triangles", "triangles", neither, "of the meshes that deform, per frame", k_scene},
    Metric{"built_triangles", "triangles", lower, "of trees, or parts of them, built anew, per frame", k_scene_work},
    // Times.
    Metric{"real_time", "time_unit", lower, "mean wall-clock time of one iteration", k_google},
    Metric{"cpu_time", "time_unit", lower, "mean processor time of one iteration", k_google},
    Metric{"mean_ns", "ns", lower, "mean time of a query", k_paper},
    Metric{"processor_ns", "ns", lower, "mean processor time of a query", "lib/sixdof/scenario/evaluation.h"},
    Metric{"p10_ns", "ns", lower, "10 % of the queries take no longer", k_latency},
    Metric{"p25_ns", "ns", lower, "25 % of the queries take no longer", k_latency},
    Metric{"p50_ns", "ns", lower, "median time of a query", k_latency},
    Metric{"p75_ns", "ns", lower, "75 % of the queries take no longer", k_latency},
    Metric{"p90_ns", "ns", lower, "90 % of the queries take no longer", k_latency},
    Metric{"p99_ns", "ns", lower, "99 % of the queries take no longer; from 200 queries on", k_latency},
    Metric{"p999_ns", "ns", lower, "99.9 % of the queries take no longer; from 2,000 queries on", k_latency},
    Metric{"max_ns", "ns", lower, "longest query", k_paper},
    Metric{"p99_least_ns", "ns", lower, "p99_ns of the least of three times of every query", k_timing},
    Metric{"max_least_ns", "ns", lower, "max_ns of the least of three times of every query", k_timing},
    Metric{"p999_least_ns", "ns", lower, "p999_ns of the least of three times of every query", k_timing},
    Metric{"late", "queries", lower, "queries over the study's deadline, in one pass", k_precision},
    Metric{"timed", "queries", neither, "queries of that pass", k_precision},
    Metric{"idle_late", "queries", lower, "the same of a loop that takes the median time of a query and asks nothing", k_precision},
    Metric{"empty_call_ns", "ns", neither, "of a query's time: a call from Python without the library's work", k_query_row},
    Metric{"over_1ms", "1", lower, "fraction of the queries over 1 ms, the haptic deadline", k_latency},
    Metric{"ns_per_configuration", "ns", lower, "processor time to make one configuration of a set", k_generate_row},
    // Of the search for equivalent resolutions.
    Metric{"eta_measured", "1", lower, "weighted sum of sigma and gamma (radians)", k_paper_eta},
    Metric{"eta_predicted", "1", neither, "the same as the fits predicted it", k_equivalent},
    Metric{"eta_wanted", "1", neither, "the given eta of a search for the least time", k_equivalent},
    Metric{"measured_ns", "ns", lower, "mean processor time of a query, the least of several passes", k_equivalent},
    Metric{"predicted_ns", "ns", neither, "the same as the fits predicted it", k_equivalent},
    Metric{"tau_ns", "ns", neither, "the given mean time of a search for the least eta", k_paper_eta},
    // What a row was measured on.
    Metric{"iterations", "1", neither, "iterations of the timed loop", k_google},
    Metric{"configurations", "configurations", neither, "configurations that were asked or made", k_query_row},
    Metric{"reachable", "configurations", neither, "configurations of the whole bucket that exist", k_query_row},
    Metric{"steps", "steps", neither, "steps along the scenario's path", "bench/rows/scenario.cpp"},
    Metric{"timing_rounds", "1", neither, "rounds of timing, of which cpu_time and real_time are medians", k_precision},
    Metric{"on_frontier", "1", neither, "1: no point of the study is better in cost and error", k_precision},
    Metric{"on_own_frontier", "1", neither, "1: no point of the same algorithm is", k_precision},
    // Size of a prepared structure.
    Metric{"prepare_ns", "ns", lower, "wall time to prepare, which the cache on disk may shorten", k_precision},
    Metric{"bytes", "byte", lower, "memory of the prepared structure", k_footprint},
    Metric{"triangles", "triangles", neither, "triangles of both meshes", k_footprint},
    Metric{"vertices", "vertices", neither, "vertices of both convex hulls", k_footprint},
    Metric{"nodes", "nodes", neither, "nodes of the hierarchies", k_footprint},
    Metric{"nodes_a", "nodes", neither, "nodes of the tree of A", k_footprint},
    Metric{"nodes_b", "nodes", neither, "nodes of the tree of B", k_footprint},
    Metric{"voxels", "voxels", neither, "voxels of the grid, stored or not", k_footprint},
    Metric{"voxels_x", "voxels", neither, "voxels along the body's box in x", k_footprint},
    Metric{"voxels_y", "voxels", neither, "voxels along the body's box in y", k_footprint},
    Metric{"voxels_z", "voxels", neither, "voxels along the body's box in z", k_footprint},
    Metric{"surface_voxels", "voxels", neither, "voxels that the surface passes through", k_footprint},
    Metric{"inside_voxels", "voxels", neither, "voxels wholly inside the body", k_footprint},
    Metric{"bricks", "bricks", neither, "stored bricks of the voxel map", k_footprint},
    Metric{"field_bricks", "bricks", neither, "stored bricks of the distance field", k_footprint},
    Metric{"points", "points", neither, "points of the point shell", k_footprint},
    Metric{"spheres", "spheres", neither, "spheres of both bodies", k_footprint},
    Metric{"spheres_a", "spheres", neither, "spheres packed into A", k_footprint},
    Metric{"spheres_b", "spheres", neither, "spheres packed into B", k_footprint},
    Metric{"fill_a", "1", higher, "fraction of A's volume inside its spheres", k_footprint},
    Metric{"fill_b", "1", higher, "fraction of B's volume inside its spheres", k_footprint},
    Metric{"resolution", "length", lower, "how far from the true surfaces the prepared ones may lie", k_footprint},
    // Work of a query, by its unit.
    Metric{"*_tested", "1", lower, "units of work that a query looks at, on average", k_work},
    Metric{"*_total", "1", neither, "units of work that a query without culling would look at", k_work},
    Metric{"ns_per_*", "ns", lower, "mean time of a query over the units it looks at", k_work},
};
// clang-format on

bool matches(std::string_view pattern, std::string_view name) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  return name.size() >= pattern.size() && name.starts_with(pattern.substr(0, star)) &&
         name.ends_with(pattern.substr(star + 1));
}

}  // namespace

std::string_view to_string(Better better) {
  constexpr std::array<std::string_view, 4> k_words{"lower", "higher", "nearer 1", "neither"};
  return k_words.at(static_cast<std::size_t>(better));
}

bool is_better(Better better, double value, double other) {
  if (better == neither) return false;
  if (better == higher) return value > other;
  const double ideal = better == nearer_one ? 1.0 : 0.0;
  return std::abs(value - ideal) < std::abs(other - ideal);
}

std::span<const Metric> metrics() { return k_metrics; }

const Metric* find_metric(std::string_view counter) {
  for (const std::string_view bound : {"_low", "_high"}) {
    if (counter.ends_with(bound)) counter.remove_suffix(bound.size());
  }
  constexpr std::string_view k_whole_path = "_all";
  constexpr std::string_view k_other_law = "_by_";
  std::string_view name = counter.substr(0, counter.find(k_other_law));
  if (name.ends_with(k_whole_path)) name.remove_suffix(k_whole_path.size());
  const auto* const found =
      std::find_if(k_metrics.begin(), k_metrics.end(), [&](const Metric& m) { return matches(m.name, name); });
  return found == k_metrics.end() ? nullptr : &*found;
}

MetricKind kind_of(std::string_view counter) {
  constexpr std::array<std::string_view, 5> k_by_times{"over_1ms", "iterations", "timing_rounds", "on_frontier",
                                                       "on_own_frontier"};
  const Metric* const metric = find_metric(counter);
  if (metric == nullptr) return MetricKind::answer;
  const bool is_time = metric->unit == "ns" || metric->unit == "time_unit";
  if (is_time || std::ranges::find(k_by_times, metric->name) != k_by_times.end()) return MetricKind::time;
  const bool is_work = metric->source == k_work || metric->source == k_footprint || metric->source == k_scene_work ||
                       metric->name == "false_per_true";
  return is_work ? MetricKind::work : MetricKind::answer;
}

}  // namespace sixdof
