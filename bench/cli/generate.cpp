#include "bench/cli/generate.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/common/build_info.h"
#include "bench/common/json_text.h"
#include "bench/common/mesh_warning.h"
#include "bench/common/pair_warnings.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

constexpr int k_most_shards = 1'000'000;
const std::string k_default_oracle = "fcl-rss";

constexpr const char* k_keys =
    "Keys of --plan --json: kinds[] {kind, grid, sampler, directions, rotations, distinct_rotations,\n"
    "configurations_per_bucket, buckets}, configurations, computed, bytes; given --a, also estimate {kinds[] {kind,\n"
    "cpu_us_per_configuration, relative_standard_error, cpu_s, ray_cpu_us {median, p99, greatest, greatest_rotation,\n"
    "greatest_direction}, sampled {rays, configurations, unreachable}}, seed, threads, time_s, prepare_s,\n"
    "process_bytes, value_bytes; with --shards, shards and shard_time_s}.";

struct Arguments {
  std::string a, b, grid, output;
  std::string distances, volumes;
  std::string method, oracle, volume_grid;  // Empty: not given.
  unsigned threads = 0;
  std::size_t shards = 0, shard = 0;  // 0: not given.
  double plan_seconds = 5.0;
  std::uint64_t seed = 1;
  bool plan = false, json = false, resume = false, progress = false;
  bool no_absolute_paths = false;
};

double parse_item(std::string_view list, std::string_view text) {
  if (const auto percent = parse_percent(text)) return *percent;
  throw BadArgument(fmt::format("percentages '{}': '{}' is not a number from 0 to {} with at most {} decimals", list,
                                text, BucketKey::k_max_percent, BucketKey::k_max_decimals));
}

/// Percentages as typed: numbers and ranges FIRST:LAST of whole ones, separated by commas ("0,0.5,5:10"); none if the
/// text is empty.
std::vector<double> parse_percents(std::string_view text) {
  std::vector<double> percents;
  if (text.empty()) return percents;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    const std::size_t colon = item.find(':');
    const double first = parse_item(text, item.substr(0, colon));
    const double last = colon == std::string_view::npos ? first : parse_item(text, item.substr(colon + 1));
    if (last < first) throw BadArgument(fmt::format("percentages '{}': {}: the end is below the start", text, item));
    if (first < last && (first != std::floor(first) || last != std::floor(last))) {
      throw BadArgument(fmt::format("percentages '{}': {} a range needs whole percentages", text, item));
    }
    for (double percent = first; percent <= last; ++percent) percents.push_back(percent);
    if (comma == std::string_view::npos) return percents;
    rest.remove_prefix(comma + 1);
  }
}

std::unique_ptr<DistanceGenerator> make_generator(const Arguments& arguments, const Registry& registry) {
  if (arguments.oracle.empty() && arguments.method != "advance") return make_ray_cast();
  if (arguments.method == "raycast") throw BadArgument("--oracle is for --method advance");
  return make_sphere_method(registry.find(arguments.oracle.empty() ? k_default_oracle : arguments.oracle));
}

/// The description of the set, still without meshes.
SetDescription describe(const Arguments& arguments, const std::vector<double>& distances,
                        const std::vector<double>& volumes) {
  if (arguments.grid.empty()) throw BadArgument("--grid is needed");
  // The paper has a coarser grid for volumes.
  const std::string volume_grid = !arguments.volume_grid.empty() ? arguments.volume_grid
                                  : arguments.grid == "paper"    ? "paper-volume"
                                                                 : arguments.grid;
  SetDescription set;
  set.generator_version = SIXDOF_VERSION;
  set.grid = make_grid(distances.empty() ? volume_grid : arguments.grid);
  if (distances.empty() || volumes.empty()) return set;
  Grid other = make_grid(volume_grid);
  if (other.spec != set.grid.spec) set.volume_grid = std::move(other);
  return set;
}

/// The number of threads asked for, or as many as the machine has.
unsigned usable_threads(unsigned asked) {
  const unsigned most = parallel::most_threads();
  if (asked > most) {
    print_message("sixdof",
                  fmt::format("--threads {}: this process may use {} at once; {} are used", asked, most, most));
  }
  return asked == 0 ? most : std::min(asked, most);
}

/// One line on stderr if volumes of the mesh count parts of it several times.
void warn(const Mesh& mesh, const std::string& argument) {
  if (const std::string text = mesh_warning(mesh, argument); !text.empty()) print_message("sixdof", text);
}

void generate(const Arguments& arguments) {
  if (arguments.shards == 0 && (arguments.shard != 0 || arguments.resume)) {
    throw BadArgument("--shard and --resume go with --shards N");
  }
  const bool no_buckets = arguments.distances.empty() && arguments.volumes.empty();
  const std::vector<double> distances = parse_percents(no_buckets ? "0:30" : arguments.distances);
  const std::vector<double> volumes = parse_percents(arguments.volumes);
  SetDescription set = describe(arguments, distances, volumes);
  if (arguments.json && !arguments.plan) throw BadArgument("--json is for --plan");
  if (arguments.plan) {
    const bool only_counts = arguments.a.empty() || arguments.plan_seconds == 0.0;
    if (!arguments.json) {
      print_counts(set, distances.size(), volumes.size());
    } else if (only_counts) {
      fmt::print("{}\n", json_text(counts_as_json(set, distances.size(), volumes.size())));
    }
    if (only_counts) return;
  } else if (arguments.a.empty() || arguments.output.empty()) {
    throw BadArgument("--a and -o are needed (or --plan)");
  }

  Registry registry;
  register_all_algorithms(registry);
  const auto generator = make_generator(arguments, registry);
  const Mesh a = load_model(arguments.a);
  const Mesh b = arguments.b.empty() || arguments.b == arguments.a ? a : load_model(arguments.b);
  if (!arguments.plan) {
    warn(a, arguments.a);
    if (b.hash() != a.hash()) warn(b, arguments.b);
  }
  set.a = identify(a, arguments.a);
  set.b = identify(b, arguments.b.empty() ? arguments.a : arguments.b);
  if (arguments.no_absolute_paths) set.a.absolute_path = set.b.absolute_path = {};
  warn_of_sizes("sixdof", set.a, set.b);
  const auto job = GenerationJob::of(program_version(), generator->oracle_name(), generator->oracle_version(), a, set,
                                     distances, volumes);
  const GenerationWork work{.generator = *generator,
                            .a = a,
                            .b = b,
                            .set = set,
                            .job = job,
                            .threads = usable_threads(arguments.threads),
                            .progress = arguments.progress};
  if (arguments.plan) {
    if (arguments.shards != 0) check_shard_number({.number = 1, .count = arguments.shards}, set, job);
    if (!arguments.json) return print_estimate(work, arguments.shards, arguments.plan_seconds, arguments.seed);
    auto plan = counts_as_json(set, distances.size(), volumes.size());
    plan["estimate"] = estimate_as_json(work, arguments.shards, arguments.plan_seconds, arguments.seed);
    fmt::print("{}\n", json_text(plan));
    return;
  }
  if (arguments.shards == 0) return generate_set(work, arguments.output);
  generate_shards(work, arguments.output, {.number = arguments.shard, .count = arguments.shards}, arguments.resume);
}

/// What the set is.
void add_set_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--a", arguments.a, "Fixed mesh A: a model's name or a file")->type_name("MESH");
  command.add_option("--b", arguments.b, "Moving mesh B, likewise")->type_name("MESH")->default_str("A");
  command
      .add_option("--grid", arguments.grid,
                  "Directions from A to B, and rotations of B. 45: both in steps of 45 degrees. 45/90: directions in "
                  "steps of 45, rotations of 90. so3:N or so3:N:M: N evenly spread rotations, M directions. paper: "
                  "steps of 15 degrees, 2 million poses a bucket. paper-volume: the paper's for volumes, 268,128 poses")
      ->type_name("GRID");
  command.add_option("--volume-grid", arguments.volume_grid, "Grid of the volumes")
      ->type_name("GRID")
      ->default_str("that of --grid; paper-volume with --grid paper");
  command
      .add_option("--distances", arguments.distances,
                  "Distances, in percent of the diagonal of A's box: 0,0.5,5:10 (5:10 is 5,6,...,10)")
      ->type_name("PERCENTS")
      ->default_str("0:30, if no --volumes are given");
  command
      .add_option("--volumes", arguments.volumes,
                  "Overlaps, in percent of A's volume: 0.1,1:10; A and B must be solids")
      ->type_name("PERCENTS");
  command
      .add_option("--method", arguments.method,
                  "raycast: search the pairs of triangles along each ray; advance: step by step with the distances of "
                  "--oracle")
      ->type_name("METHOD")
      ->default_str("raycast; with --oracle, advance")
      ->check(CLI::IsMember({"raycast", "advance"}));
  command
      .add_option("--oracle", arguments.oracle, "Algorithm with exact distances that --method advance measures with")
      ->type_name("ALGORITHM")
      ->default_str(k_default_oracle);
}

/// How it is made, and where to.
void add_run_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--threads", arguments.threads, "Threads; 0: as many as the machine has")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("-o,--output", arguments.output,
                  "The set to write (HDF5), replaced if it exists; with --shards a folder, made if missing")
      ->type_name("FILE");
  command
      .add_option("--shards", arguments.shards,
                  "Divide the work into N files of equal size, which sixdof merge joins to a set")
      ->type_name("N")
      ->check(CLI::Range(1, k_most_shards));
  command.add_option("--shard", arguments.shard, "Make only this one of the --shards")
      ->type_name("I")
      ->default_str("all")
      ->check(CLI::Range(1, k_most_shards));
  command.add_flag("--no-absolute-paths", arguments.no_absolute_paths,
                   "Of mesh files store only the path as typed: the set has the same bytes in every folder");
  command.add_flag("--resume", arguments.resume, "Keep the valid shards of the folder, make the others");
  command.add_flag("--progress", arguments.progress, "Show progress where stderr is not a terminal, too");
  command.add_flag("--plan", arguments.plan,
                   "Make nothing: print the size of the set and, with --a, time and memory estimated from a sample");
  command.add_flag("--json", arguments.json, "With --plan: as JSON");
  command.add_option("--plan-seconds", arguments.plan_seconds, "Time for the sample of --plan; 0: no sample")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of the sample of --plan")->type_name("N")->capture_default_str();
}

}  // namespace

std::unique_ptr<DistanceGenerator> generator_of(const std::string& oracle, const Registry& registry) {
  auto ray_cast = make_ray_cast();
  if (oracle.empty() || oracle == ray_cast->oracle_name()) return ray_cast;
  return make_sphere_method(registry.find(oracle));
}

void add_generate_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("generate", "Make a configuration set of two meshes: poses at given distances and overlaps");
  const auto arguments = std::make_shared<Arguments>();
  add_set_options(*command, *arguments);
  add_run_options(*command, *arguments);
  add_examples(
      *command, "sixdof generate --a torus-knot-10k --b cone-1k --grid 90 --distances 0,5:10 --volumes 5 -o set.h5",
      "sixdof generate --a cone-1k --grid paper --distances 0:30 --volumes 0:10 --plan --plan-seconds 1", k_keys);
  command->callback([arguments] { generate(*arguments); });
}

}  // namespace sixdof::cli
