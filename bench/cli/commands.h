#pragma once

#include <optional>
#include <string>

#include <CLI/App.hpp>

namespace sixdof::cli {

/// The program `sixdof`: parses the command line and runs one command. @returns the exit code (common/run_guarded.h);
/// without arguments it prints what to do first on stderr and returns k_exit_usage, since no command was given
int run(int argc, const char* const* argv);

/// `sixdof models list [--json]`: every model with its triangle counts and size, and whether a fetched one is here.
/// `sixdof models make NAME [--triangles N] -o FILE`: writes a model to a mesh file, which appears whole or not at all.
void add_models_command(CLI::App& app);
/// `sixdof info FILE_OR_NAME [--check] [--json]`: what a configuration set, a mesh file or a model holds; with --check
/// also where a mesh meets itself or counts twice (oracle/mesh_check.h), and k_exit_defects if it does.
void add_info_command(CLI::App& app);
/// `sixdof repair FILE_OR_NAME -o FILE [--weld T] [--max-hole N] [--json]`: welds, cleans, orients and closes a mesh
/// (repair/repair.h); k_exit_defects if the result, which is written, is no solid. Does not overwrite its input.
void add_repair_command(CLI::App& app);
/// `sixdof algorithms [--json]`: what every algorithm of this build answers, its law, version and parameters, and
/// whether benchmarks time it.
void add_algorithms_command(CLI::App& app);
/// `sixdof query --a MESH --b MESH --pose POSE [--algorithm NAME] [--only LIST] [--json]`: the answers of one algorithm
/// at one pose. Without a response where a mesh is no solid, with the reason.
void add_query_command(CLI::App& app);
/// `sixdof show --algorithm NAME --model M -o FILE.ply`: the structure that `ist`, `vps` or `vps-field` prepares of a
/// mesh, as a coloured PLY (structure_drawing.h defines the colours).
void add_show_command(CLI::App& app);
/// `sixdof quality --scenario II --algorithm NAME`: the response of one algorithm along one scenario against the ideal,
/// as measures (text or JSON) and as a series (HDF5).
void add_quality_command(CLI::App& app);
/// `sixdof precision --pair elephant [--question distance] [--budget 10min] [-o FILE.json]`: time and error of every
/// algorithm at every resolution on the same configurations, with the frontiers (study/precision.h).
void add_precision_command(CLI::App& app);
/// `sixdof recommend --a A --b B --deadline 1ms [--question respond]`: which algorithm and parameters keep the
/// deadline on this pair with right answers, and what the others lack; k_exit_defects if none does (results/choice.h).
void add_recommend_command(CLI::App& app);
/// `sixdof hulls --a A --b B [--parts-a FILE ...]`: what convex hulls, or the parts of a decomposition, change in
/// answers and times (study/stand_ins.h).
void add_hulls_command(CLI::App& app);
/// `sixdof equivalent [--paper] [--scenario LIST] [--algorithm LIST] [--tau TIME] [--budget TIME] [-o FILE]`: the
/// resolutions of A and B with the least error of a response at a given mean time (study/equivalent.h), and the paper's
/// table (results/paper_table.h). With `--resume` it continues a run that broke off.
void add_equivalent_command(CLI::App& app);
/// `sixdof stress [--algorithms LIST] [--families LIST] [--effort quick|full] [--seed N]`: every algorithm on families
/// of hard cases with known answers; k_exit_defects if one of this project's own answers wrongly or not
/// (study/stress.h).
void add_stress_command(CLI::App& app);
/// What the processes of that command run. @returns the exit code; nothing for another command line
std::optional<int> run_stress_cell_if_asked(int argc, const char* const* argv);
/// `sixdof generate --a A [--b B] --grid GRID [--distances LIST] [--volumes LIST] -o FILE`: makes a configuration set.
/// With `--shards N [--shard I] -o FOLDER` in parts; with `--plan` it only prints what would be made and at what cost.
void add_generate_command(CLI::App& app);
/// `sixdof merge DIR -o FILE`: one configuration set of the shards in a folder.
void add_merge_command(CLI::App& app);
/// `sixdof survey SET --algorithm NAME [--shards N --shard I] -o FILE`: every configuration of a set, asked once
/// (study/survey.h). With `--merge FOLDER` the result of all shards.
void add_survey_command(CLI::App& app);
/// `sixdof verify FILE [--sample N] [--seed S] [--oracle NAME]`: measures a sample of every bucket of a configuration
/// set again and prints a table; fails if anything is wrong.
void add_verify_command(CLI::App& app);
/// `sixdof agree [--pair LIST | --set FILE] [--algorithms LIST] [--sample N]`: yes/no and distance of several
/// algorithms against the truth of configuration sets and each other, a command line for each difference
/// (study/set_agreement.h); k_exit_defects if there is one.
void add_agree_command(CLI::App& app);
/// `sixdof table FILE.json [MORE.json ...] [--markdown | --json]`: results of sixdof-bench, one table per pair, query
/// and kind of bucket; several files side by side (table.h).
void add_table_command(CLI::App& app);
/// `sixdof report FILE.json [MORE.json ...] [--series FILE.h5] -o FILE.html [--csv | --markdown | --svg | --pdf |
/// --tikz FOLDER]`: results as one page of figures and tables that opens without a network
/// (lib/sixdof/report/README.md).
void add_report_command(CLI::App& app);
/// `sixdof history FOLDER -o FILE.html`: how the times of all results in a folder went, as such a page
/// (report/history.h).
void add_history_command(CLI::App& app);
/// `sixdof compare BEFORE.json AFTER.json [--json | --markdown] [--fail-on-answers]`: versions, answers and counts of
/// work that differ (results/difference.h); with --fail-on-answers k_exit_defects if an answer does.
void add_compare_command(CLI::App& app);
/// `sixdof gate BASELINE CANDIDATE [--record FILE]`: judges a change by answers, work, instructions and time with the
/// script bench/gate, which replaces this program; k_exit_defects if it is red.
void add_gate_command(CLI::App& app);
/// `sixdof new-algorithm NAME [--ci github|gitlab] [-o FOLDER]`: a project of its own with an algorithm that is to be
/// replaced, made of the files in bench/new_algorithm/. The folder appears whole or not at all; nothing is overwritten.
void add_new_algorithm_command(CLI::App& app);
/// `sixdof conform [--algorithm LIST] [--external NAME=COMMAND]`: the checks of the conformance kit for any algorithm,
/// a line for each; k_exit_defects if one failed (lib/sixdof/conformance/README.md).
void add_conform_command(CLI::App& app);
/// `sixdof completion bash`: a script that completes the commands, options and values of all of these
/// (common/completion.h).
void add_completion_command(CLI::App& app);

}  // namespace sixdof::cli
