#include "bench/cli/commands.h"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/configuration/verification.h>
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/pair_warnings.h"
#include "bench/common/progress_line.h"

namespace sixdof::cli {
namespace {

struct Arguments {
  std::string file, a, b;
  std::string oracle = "fcl-obbrss";
  std::size_t sample = 50;
  std::uint64_t seed = 1;
  bool json = false;
};

constexpr const char* k_keys =
    "Keys of --json: file, a, b, grid, oracle {name, version}, seed, ok, problems[], buckets[] {bucket, sampled,\n"
    "reachable, largest_residual, tolerance (both in diagonals of A's box or in A's volumes), wrong_value,\n"
    "earlier_hit, false_nan, measured_by}.";

void print_table(const Verdict& verdict) {
  fmt::print("{:<13} {:>8} {:>10} {:>13} {:>10} {:>8} {:>8} {:>8}  {}\n", "bucket", "sampled", "reachable", "residual",
             "allowed", "wrong", "earlier", "nan", "measured by");
  for (const BucketVerdict& bucket : verdict.buckets) {
    fmt::print("{:<13} {:>8} {:>10} {:>13.2e} {:>10.0e} {:>8} {:>8} {:>8}  {}\n", bucket.summary.key.name(),
               bucket.sampled, bucket.reachable, bucket.largest_residual / bucket.scale,
               bucket.tolerance / bucket.scale, bucket.wrong_value, bucket.earlier_hit, bucket.false_nan,
               bucket.oracle);
  }
  fmt::print("residuals and what is allowed: in diagonals of A's box and in A's volumes\n");
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

void print_json(const Arguments& arguments, const ConfigurationSet& set, const Traits& oracle, const Verdict& verdict) {
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

void print_text(const Arguments& arguments, const ConfigurationSet& set, const Traits& oracle, const Verdict& verdict) {
  fmt::print("{}: {} with {}, grid {}, distances by {} {}, seed {}\n", arguments.file, set.description().a.name,
             set.description().b.name, set.grid(BucketKind::distance).spec, oracle.name, oracle.version,
             arguments.seed);
  print_table(verdict);
  for (const std::string& problem : verdict.problems) fmt::print("{}\n", problem);
}

void verify(const Arguments& arguments) {
  const ConfigurationSet set(arguments.file);
  const SelectedAlgorithm selected = select_algorithm({.name = arguments.oracle, .parameters = {}});
  const Traits& oracle = selected.algorithm->traits();
  const MeshIdentity& a_identity = set.description().a;
  const MeshIdentity& b_identity = set.description().b;
  const Mesh a = find_mesh(a_identity, set.path(), arguments.a);
  const bool copy = arguments.b.empty() && a_identity.hash == b_identity.hash;
  const Mesh b = copy ? a : find_mesh(b_identity, set.path(), arguments.b);
  warn_of_sizes("sixdof", a_identity, b_identity);
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
  auto* const command = app.add_subcommand("verify", "Measure a sample of a configuration set again");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("file", arguments->file, "The set")->required();
  command->add_option("--a", arguments->a, "Mesh A, a model's name or a file, if it is not where the set says");
  command->add_option("--b", arguments->b, "Mesh B, likewise");
  command->add_option("--sample", arguments->sample, "Configurations per bucket, drawn at random")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Of the sample")->capture_default_str();
  command->add_option("--oracle", arguments->oracle, "Algorithm with exact distances that measures them")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "As JSON; the exit code is the same");
  add_examples(*command, "sixdof generate --a torus-knot-10k --grid 90 --distances 0,10 -o set.h5",
               "sixdof verify set.h5 --sample 20 --seed 7", k_keys);
  command->callback([arguments] { verify(*arguments); });
}

}  // namespace sixdof::cli
