#include "bench/cli/verify.h"

#include <charconv>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/configuration/verification.h>
#include <sixdof/generation/repetition.h>
#include "bench/cli/commands.h"
#include "bench/cli/generate.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/pair_warnings.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_keys =
    "Keys of --json: file, a, b, grid, oracle {name, version}, seed, ok, problems[], buckets[] {bucket, sampled,\n"
    "reachable, largest_residual, tolerance (both in diagonals of A's box or in A's volumes), wrong_value,\n"
    "earlier_hit, false_nan, measured_by}. With --again: file, generator_version, program_version, seed, ok, values,\n"
    "changed, differences[], buckets[] {bucket, values, changed, and of the largest change rotation, direction, "
    "stored,\n"
    "made}. With --motions: file, oracle, seed, ok, motions[] {motion, percent, motions, hits, misses, at_start,\n"
    "grazing, widest, wide, changed, earlier, apart, problems[]}.";

void print_table(const Verdict& verdict) {
  fmt::print("{:<13} {:>8} {:>10} {:>13} {:>10} {:>8} {:>8} {:>8}  {}\n", "bucket", "sampled", "reachable", "residual",
             "allowed", "wrong", "earlier", "nan", "measured by");
  for (const BucketVerdict& bucket : verdict.buckets) {
    fmt::print("{:<13} {:>8} {:>10} {:>13.2e} {:>10.0e} {:>8} {:>8} {:>8}  {}\n", bucket.summary.key.name(),
               bucket.sampled, bucket.reachable, bucket.largest_residual / bucket.scale,
               bucket.tolerance / bucket.scale, bucket.wrong_value, bucket.earlier_hit, bucket.false_nan,
               bucket.oracle);
  }
  fmt::print("residual and tolerance: of distances in diagonals of A's box, of volumes in A's volume\n");
}

nlohmann::ordered_json as_json(const BucketVerdict& bucket) {
  return {{"bucket", bucket.summary.key.name()},
          {"sampled", bucket.sampled},
          {"reachable", bucket.reachable},
          {"largest_residual", bucket.largest_residual / bucket.scale},
          {"tolerance", bucket.tolerance / bucket.scale},
          {"wrong_value", bucket.wrong_value},
          {"earlier_hit", bucket.earlier_hit},
          {"false_nan", bucket.false_nan},
          {"measured_by", bucket.oracle}};
}

void print_json(const VerifyArguments& arguments, const ConfigurationSet& set, const Traits& oracle,
                const Verdict& verdict) {
  auto buckets = nlohmann::ordered_json::array();
  for (const BucketVerdict& bucket : verdict.buckets) buckets.push_back(as_json(bucket));
  fmt::print("{}\n", json_text({{"file", arguments.file},
                                {"a", set.description().a.name},
                                {"b", set.description().b.name},
                                {"grid", set.grid(BucketKind::distance).spec},
                                {"oracle", {{"name", oracle.name}, {"version", oracle.version}}},
                                {"seed", arguments.seed},
                                {"ok", verdict.ok()},
                                {"problems", verdict.problems},
                                {"buckets", std::move(buckets)}}));
}

void print_text(const VerifyArguments& arguments, const ConfigurationSet& set, const Traits& oracle,
                const Verdict& verdict) {
  fmt::print("{}: {} with {}, grid {}, distances by {} {}, seed {}\n", arguments.file, set.description().a.name,
             set.description().b.name, set.grid(BucketKind::distance).spec, oracle.name, oracle.version,
             arguments.seed);
  print_table(verdict);
  for (const std::string& problem : verdict.problems) fmt::print("{}\n", problem);
}

/// A translation as JSON takes it: null if the target is not met.
nlohmann::ordered_json translation_as_json(double s) {
  return std::isnan(s) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(s);
}

void print_repetition(const VerifyArguments& arguments, const ConfigurationSet& set, const Repetition& repetition) {
  const std::string& version = set.description().generator_version;
  if (!arguments.json) {
    for (const BucketRepetition& bucket : repetition.buckets) {
      if (bucket.changed == 0) continue;
      fmt::print("{}: {} of {} values have other bits; most at rotation {}, direction {}: {} is now {}\n",
                 bucket.key.name(), bucket.changed, bucket.values, bucket.largest.rotation, bucket.largest.direction,
                 bucket.largest.stored, bucket.largest.made);
    }
    for (const std::string& difference : repetition.differences) fmt::print("{}\n", difference);
    fmt::print("{}: {} values made again, {} with other bits (set by sixdof {}, this is {})\n", arguments.file,
               repetition.values(), repetition.changed(), version, SIXDOF_VERSION);
    return;
  }
  auto buckets = nlohmann::ordered_json::array();
  for (const BucketRepetition& bucket : repetition.buckets) {
    nlohmann::ordered_json entry{{"bucket", bucket.key.name()}, {"values", bucket.values}, {"changed", bucket.changed}};
    if (bucket.changed != 0) {
      entry["rotation"] = bucket.largest.rotation;
      entry["direction"] = bucket.largest.direction;
      entry["stored"] = translation_as_json(bucket.largest.stored);
      entry["made"] = translation_as_json(bucket.largest.made);
    }
    buckets.push_back(std::move(entry));
  }
  fmt::print("{}\n", json_text({{"file", arguments.file},
                                {"generator_version", version},
                                {"program_version", SIXDOF_VERSION},
                                {"seed", arguments.seed},
                                {"ok", repetition.same()},
                                {"values", repetition.values()},
                                {"changed", repetition.changed()},
                                {"differences", repetition.differences},
                                {"buckets", std::move(buckets)}}));
}

/// The number of rotations that --again asks for; 0: all.
std::size_t parse_again(const std::string& text) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error == std::errc() && end == text.data() + text.size() && count > 0) return count;
  if (text == "all") return 0;
  throw BadArgument(fmt::format("--again {}: is neither a positive number of rotations nor all", text));
}

void verify_again(const VerifyArguments& arguments, const ConfigurationSet& set, const Mesh& a, const Mesh& b) {
  Registry registry;
  register_all_algorithms(registry);
  Repetition repetition;
  {
    ProgressLine line("made again");
    repetition = make_again(set, a, b, *generator_of(distance_oracle(set), registry),
                            {.rotations = parse_again(arguments.again), .seed = arguments.seed},
                            {.progress = [&](std::uint64_t done, std::uint64_t total) { line.show(done, total); },
                             .cancelled = InterruptGuard::requested});
  }
  print_repetition(arguments, set, repetition);
  if (!repetition.same()) {
    throw DefectsFound(fmt::format("{}: this build does not make the same set", arguments.file));
  }
}

void verify(const VerifyArguments& arguments) {
  const ConfigurationSet set(arguments.file);
  const MeshIdentity& a_identity = set.description().a;
  const MeshIdentity& b_identity = set.description().b;
  const Mesh a = find_mesh(a_identity, set.path(), arguments.a);
  const bool copy = arguments.b.empty() && a_identity.hash == b_identity.hash;
  const Mesh b = copy ? a : find_mesh(b_identity, set.path(), arguments.b);
  warn_of_sizes("sixdof", a_identity, b_identity);
  if (!arguments.again.empty()) return verify_again(arguments, set, a, b);
  const SelectedAlgorithm selected = select_algorithm({.name = arguments.oracle, .parameters = {}});
  const Traits& oracle = selected.algorithm->traits();
  if (arguments.motions > 0) return verify_motions(arguments, set, a, b, *selected.algorithm);
  Verdict verdict;
  {
    ProgressLine line("verified");
    verdict = verify_set(set, a, b, *selected.algorithm, {.size = arguments.sample, .seed = arguments.seed},
                         {.progress = [&](std::uint64_t done, std::uint64_t total) { line.show(done, total); },
                          .cancelled = InterruptGuard::requested});
  }
  arguments.json ? print_json(arguments, set, oracle, verdict) : print_text(arguments, set, oracle, verdict);
  if (!verdict.ok()) throw Error(fmt::format("{}: verification failed", arguments.file));
}

}  // namespace

void add_verify_command(CLI::App& app) {
  auto* const command = app.add_subcommand(
      "verify", "Check a configuration set: measure a sample of its poses again, or make poses again");
  const auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("file", arguments->file, "The configuration set")->required()->type_name("FILE");
  command->add_option("--a", arguments->a, "Mesh A, if it is not where the set says: a model's name or a file")
      ->type_name("MESH");
  command->add_option("--b", arguments->b, "Mesh B, likewise")->type_name("MESH");
  auto* const sample = command->add_option("--sample", arguments->sample, "Poses per bucket, drawn at random")
                           ->type_name("N")
                           ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Seed of the draw")->type_name("N")->capture_default_str();
  auto* const measuring =
      command->add_option("--oracle", arguments->oracle, "Algorithm with exact distances that measures the poses")
          ->type_name("ALGORITHM")
          ->capture_default_str();
  command
      ->add_option(
          "--again", arguments->again,
          "Instead of measuring, make all poses of N random rotations, or of all rotations, again and compare their "
          "bits; exit code 3 if any differ")
      ->type_name("N|all")
      ->excludes(sample)
      ->excludes(measuring);
  command
      ->add_option("--motions", arguments->motions,
                   "Instead, check the first contacts of N motions of each kind and length from poses of contact "
                   "(0 %), which rows of casts are judged by: again, and by distances of the oracle")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->excludes(sample)
      ->excludes("--again");
  command->add_flag("--json", arguments->json, "As JSON; the exit code is the same");
  add_examples(*command, "sixdof generate --a torus-knot-10k --grid 90 --distances 0,10 -o set.h5",
               "sixdof verify set.h5 --again 2", k_keys);
  command->callback([arguments] { verify(*arguments); });
}

}  // namespace sixdof::cli
