#include "bench/cli/generate.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/algorithms.h"
#include "bench/cli/generate_plan.h"
#include "bench/cli/generate_profile.h"
#include "bench/cli/generate_shards.h"
#include "bench/cli/program_version.h"
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/ray_cast.h>
#include <sixdof/generation/sphere_method.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof::cli {
namespace {

constexpr int k_most_shards = 1'000'000;
const std::string k_default_oracle = "fcl-rss";

struct Arguments {
  std::string a, b, grid, output;
  std::string distances, volumes;
  std::string method, oracle;  // empty: not given
  std::string volume_grid;     // empty: not given
  unsigned threads = 0;
  std::size_t shards = 0, shard = 0;  // 0: not given
  double sample_seconds = 5.0;
  std::uint64_t sample_seed = 1;
  std::optional<std::size_t> rotations;
  bool plan = false, profile = false, resume = false, progress = false;
};

int parse_percent(std::string_view list, std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > BucketKey::k_max_percent) {
    throw BadArgument(
        fmt::format("percentages '{}': '{}' is not a whole number from 0 to {}", list, text, BucketKey::k_max_percent));
  }
  return value;
}

std::vector<int> parse_list(std::string_view text) { return text.empty() ? std::vector<int>{} : parse_percents(text); }

std::unique_ptr<DistanceGenerator> make_generator(const Arguments& arguments, const Registry& registry) {
  if (arguments.oracle.empty() && arguments.method != "advance") return make_ray_cast();
  if (arguments.method == "raycast") throw BadArgument("--oracle is for --method advance");
  return make_sphere_method(registry.find(arguments.oracle.empty() ? k_default_oracle : arguments.oracle));
}

/// The grids of a job, still without meshes.
SetDescription describe(const Arguments& arguments, const std::vector<int>& distances,
                        const std::vector<int>& volumes) {
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

void check_shards(const Arguments& arguments) {
  if (arguments.shards == 0 && (arguments.shard != 0 || arguments.resume)) {
    throw BadArgument("--shard and --resume go with --shards N");
  }
  if (arguments.shards != 0 && arguments.profile) throw BadArgument("--profile makes no shards");
}

void generate(const Arguments& arguments) {
  check_shards(arguments);
  const bool all_distances = arguments.distances.empty() && arguments.volumes.empty();
  const std::vector<int> distances = parse_list(all_distances ? "0:30" : arguments.distances);
  const std::vector<int> volumes = parse_list(arguments.volumes);
  SetDescription set = describe(arguments, distances, volumes);
  if (arguments.plan) {
    print_counts(set, distances.size(), volumes.size());
    if (arguments.a.empty() || arguments.sample_seconds == 0.0) return;
  } else if (arguments.a.empty() || (arguments.output.empty() && !arguments.profile)) {
    throw BadArgument("--a and -o are needed (or --plan, or --a and --profile)");
  }

  Registry registry;
  register_all_algorithms(registry);
  const auto generator = make_generator(arguments, registry);
  const Mesh a = load_model(arguments.a);
  const Mesh b = arguments.b.empty() || arguments.b == arguments.a ? a : load_model(arguments.b);
  set.a = MeshIdentity::of(a);
  set.b = MeshIdentity::of(b);
  const auto job = GenerationJob::of(program_version(), generator->oracle_name(), generator->oracle_version(), a, b, set,
                                     distances, volumes);
  const GenerationWork work{.generator = *generator,
                            .a = a,
                            .b = b,
                            .set = set,
                            .job = job,
                            .threads = arguments.threads,
                            .progress = arguments.progress};
  if (arguments.plan) {
    if (arguments.shards != 0) check_shard_number({.number = 1, .count = arguments.shards}, set, job);
    return print_estimate(
        work, {.shards = arguments.shards, .seconds = arguments.sample_seconds, .seed = arguments.sample_seed});
  }
  if (arguments.profile) return print_profile(work, {.rotations = arguments.rotations, .seed = arguments.sample_seed});
  if (arguments.shards == 0) return generate_set(work, arguments.output);
  generate_shards(
      work,
      {.folder = arguments.output, .count = arguments.shards, .only = arguments.shard, .resume = arguments.resume});
}

}  // namespace

std::vector<int> parse_percents(std::string_view text) {
  std::vector<int> percents;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    const std::size_t colon = item.find(':');
    const int first = parse_percent(text, item.substr(0, colon));
    const int last = colon == std::string_view::npos ? first : parse_percent(text, item.substr(colon + 1));
    if (last < first) throw BadArgument(fmt::format("percentages '{}': {} runs backwards", text, item));
    for (int percent = first; percent <= last; ++percent) percents.push_back(percent);
    if (comma == std::string_view::npos) return percents;
    rest.remove_prefix(comma + 1);
  }
}

void add_generate_command(CLI::App& app) {
  auto* const command = app.add_subcommand("generate", "Make a configuration set of two meshes");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--a", arguments->a, "Fixed mesh A: a model's name or a file");
  command->add_option("--b", arguments->b, "Moving mesh B; A if left out");
  command->add_option("--grid", arguments->grid,
                      "paper | paper-volume | STEP | STEP/STEP (degrees: directions/rotations) | so3:N | so3:N:M");
  command->add_option("--distances", arguments->distances,
                      "Percent of A's box diagonal, e.g. 0,1,5:10; 0:30 if no --volumes are given either");
  command->add_option("--volumes", arguments->volumes, "Percent of A's volume, e.g. 0:10 (A and B must be solids)");
  command
      ->add_option("--method", arguments->method,
                   "raycast: on the project's own trees; advance: step by step with the distances of --oracle. "
                   "Default: raycast, with --oracle advance")
      ->check(CLI::IsMember({"raycast", "advance"}));
  command->add_option(
      "--oracle", arguments->oracle,
      "What --method advance measures with: brute-force, or an algorithm with exact distances (default " +
          k_default_oracle + ")");
  command->add_option("--threads", arguments->threads, "0: as many as the machine has")->capture_default_str();
  command->add_option("--volume-grid", arguments->volume_grid,
                      "Grid of the volumes; that of the distances if left out, but paper-volume with --grid paper");
  auto* const output =
      command->add_option("-o,--output", arguments->output,
                          "The set (HDF5); replaced if it exists. With --shards a folder, made if missing");
  command
      ->add_option("--shards", arguments->shards,
                   "Cut the work into N files of equal size, which sixdof merge makes a set of")
      ->check(CLI::Range(1, k_most_shards));
  command->add_option("--shard", arguments->shard, "Make only this one, 1 to N; all in turn if left out")
      ->check(CLI::Range(1, k_most_shards));
  command->add_flag("--resume", arguments->resume, "Keep shards that are there and sound, make the others");
  command->add_flag("--progress", arguments->progress, "Show progress where stderr is no terminal, too");
  auto* const plan =
      command->add_flag("--plan", arguments->plan,
                        "Only print what would be made and, given --a, what it would take, from a timed sample of it");
  command->add_option("--sample-seconds", arguments->sample_seconds, "Of --plan; 0: no sample")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  auto* const profile =
      command->add_flag("--profile", arguments->profile,
                        "Only solve, and print how evenly the work is spread: median and worst configuration");
  profile->excludes(plan)->excludes(output);
  command
      ->add_option("--rotations", arguments->rotations,
                   "Of --profile: how many besides those that turn an axis onto an axis; all if left out")
      ->needs(profile);
  command->add_option("--sample-seed", arguments->sample_seed, "Of --plan and --profile")->capture_default_str();
  command->callback([arguments] { generate(*arguments); });
}

}  // namespace sixdof::cli
