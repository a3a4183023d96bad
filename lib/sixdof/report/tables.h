#pragma once

#include <vector>

#include <sixdof/report/data_table.h>
#include <sixdof/report/series.h>
#include <sixdof/results/results.h>
#include <sixdof/results/row_group.h>

/// The tables that the figures draw, in long form: a line per value, texts in the columns by which a reader chooses. A
/// table without rows belongs to a page without data. A column "worst_pose" has the command line that asks at the
/// configuration where the row is at its worst; the page links it to its picture.

namespace sixdof::report {

using namespace results;

/// Name of the pair whose times are means over all pairs of a run.
inline constexpr const char* k_all_objects = "all objects (mean)";

/// "times": times of queries on buckets, in us, but for casts, which all start at the bucket of contact. `repetitions`
/// is empty for k_all_objects. `low_us` and `high_us` bound the interval of a mean; of k_all_objects they are the
/// geometric mean over the pairs divided and multiplied by its geometric standard deviation, over pairs that all
/// algorithms of the bucket have.
DataTable times_table(const Results& results, const std::vector<RowGroup>& groups);

/// "response_errors": errors of responses by overlap volume, each measure of a row in a line.
DataTable response_errors_table(const Results& results, const std::vector<RowGroup>& groups);

/// "scenario_measures": measures of responses along the scenarios, in their windows.
DataTable scenario_measures_table(const Results& results, const std::vector<RowGroup>& groups);

/// "libraries": a line for each algorithm and kind of query, over its rows on buckets at random poses with warm caches:
/// geometric means of the mean and of the 99th percentile, and of the ratio to `exact` over the places that both have;
/// sums of wrong and missing answers; the mean angle of forces to the exact ones, the largest error of a distance in
/// diagonals of A. `class` is class_of(), or "native": lines of different classes are not compared.
DataTable libraries_table(const Results& results, const std::vector<RowGroup>& groups);

/// "frontier": costs (time, memory, time to prepare) against every error of the points of `sixdof precision`, and of
/// distances and responses on buckets. `frontier` is "yes" by results/frontier.h, among the points of the same run,
/// pair, cost, error and bucket or study.
DataTable frontier_table(const Results& results, const std::vector<RowGroup>& groups);

/// "equal_time": what `sixdof equivalent` found, beside the values that the paper prints (scenario/README.md).
DataTable equal_time_table(const Results& results, const std::vector<RowGroup>& groups);

/// "signals": measured and ideal force, torque and penalty along a path: magnitudes, components, angles between them,
/// torque over force, and the time of each query. At most k_most_steps lines of each signal; of neighbouring steps the
/// one that is farthest from the ideal stays, of times the longest.
DataTable signals_table(const std::vector<Series>& series);

/// "spectra": time-frequency diagrams of magnitudes, their errors and single components, in dB below the loudest piece
/// of the force's (torque's) magnitude.
DataTable spectra_table(const std::vector<Series>& series);

/// "perception": scores of force and torque (measure/perception.h), with the gain fitted to the whole path.
DataTable perception_table(const std::vector<Series>& series);

/// "perception_thresholds": what scores 1, with its source; empty without series.
DataTable perception_thresholds_table(const std::vector<Series>& series);

/// "update_rates": 1 / p99 of responses (of the longest query where a row has no p99), in Hz. `stiffness_per_damping`
/// is the largest stiffness of a passive virtual spring over the device's damping, 2 / T in 1/s: K <= min(2 b / T, 2
/// f_c / Delta), of which the second depends on the device only. Colgate and Schenkel 1997; Abbott and Okamura 2005.
DataTable update_rates_table(const Results& results, const std::vector<RowGroup>& groups);

inline constexpr std::size_t k_most_steps = 200;

/// "metrics": a line for each row with every number that it has, for figures of any two. Memory and time of preparing
/// stand beside queries too, where the file has the row that prepares. `where` names what rows are compared on.
DataTable metrics_table(const Results& results, const std::vector<RowGroup>& groups);

/// "casts": first contacts of moving bodies, a line for each row: time, and how many answers are missed, late
/// (`late_most` and `early_most` are parts of the motion), early, phantom or missing (measure/metrics.cpp).
DataTable casts_table(const Results& results, const std::vector<RowGroup>& groups);

/// "many_bodies": scenes of many bodies: time of a frame, pairs missed and wrong, pairs looked at.
DataTable many_bodies_table(const Results& results, const std::vector<RowGroup>& groups);

/// "contacts": a line for each row `contacts/...`: its time, and its scores against exact geometry under the names of
/// their counters (measure/metrics.h).
DataTable contacts_table(const Results& results, const std::vector<RowGroup>& groups);

/// "depths": a line for each row `depth/...`: its time, and how its depths compare with the intervals of the
/// penetration depth, under the names of their counters.
DataTable depths_table(const Results& results, const std::vector<RowGroup>& groups);

/// "deforming": scenes in which a mesh deforms: processor time of a frame by amplitude (percent); `part` is "update and
/// query", "update" or "query".
DataTable deforming_table(const Results& results, const std::vector<RowGroup>& groups);

/// "refit_payoff": the amplitude from which on building the tree anew is faster (results/refit_payoff.h), or "never",
/// for each way to keep the tree; and its time over that of building anew at the least and the largest amplitude.
DataTable refit_payoff_table(const Results& results, const std::vector<RowGroup>& groups);

/// "collection": times over the objects of a collection, by partner, query and bucket.
DataTable collection_table(const Results& results);

/// "collection_ratios": time over that of `exact`: a line for the mean over the objects (`point` is k_mean_of_objects)
/// and one for each of the objects where it is largest, by name.
DataTable collection_ratios_table(const Results& results);
inline constexpr const char* k_mean_of_objects = "mean of all objects";

/// "growth": times and memory by the number of triangles of a shape.
DataTable growth_table(const Results& results);

/// "growth_exponents": exponents of the number of triangles with their 95 % intervals.
DataTable growth_exponents_table(const Results& results);

/// "stability": verdicts of hard cases with the worst one's reproduction.
DataTable stability_table(const Results& results);

/// "objects": triangles of the models that the rows are about, where the model is here.
DataTable objects_table(const Results& results);

/// "failures": rows that could not be run or have faults, each with the command that measures it again.
DataTable failures_table(const Results& results, const std::vector<RowGroup>& groups);

/// "settings": version and settings of every algorithm of every file.
DataTable settings_table(const Results& results);

/// "runs": everything else that a file says about its run: machine, build, arguments, content hashes.
DataTable runs_table(const Results& results, const std::vector<Series>& series);

/// "[1] name": how tables call a file.
std::string run_name(const Results& results, std::size_t file);

}  // namespace sixdof::report
