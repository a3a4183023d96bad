#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/models/model_catalogue.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/cli/study_options.h"
#include "bench/common/duration.h"
#include "bench/common/hulls.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/study/stand_ins.h"
#include "bench/study/study_pairs.h"
#include "bench/study/verdict_sample.h"

namespace sixdof::cli {
namespace {

constexpr std::size_t k_poses = 1500;

constexpr const char* k_details =
    R"(Engines replace meshes by their convex hulls, or by convex parts. This command says what that changes for a pair:
how often the hulls touch where the meshes do not (false yes), how much too small their distances are, and how much
less time exact takes for them. The poses are those of `sixdof recommend`. Without --parts-a and --parts-b each mesh is
replaced by its convex hull; the parts of a decomposition are files of closed meshes, in the frame of their mesh.

Keys of --json: pair, triangles {a, b, stand_in_a, stand_in_b}; false_yes {apart, near} and false_no {overlapping},
each {wrong, of}; bias {mean, p05, median, p95} of distances in diagonals of A, below zero: too small; yes_no_ns and
distance_ns {meshes, stand_ins}.)";

struct Options {
  StudyOptions study;
  std::vector<std::string> parts_a, parts_b;
};

Mesh stand_in(const Mesh& mesh, const std::vector<std::string>& files) {
  if (files.empty()) return hull_of(mesh);
  std::vector<Mesh> parts;
  for (const std::string& file : files) parts.push_back(load_model(file));
  return study::joined(parts, mesh.name() + " in parts");
}

double percent(const study::StandInErrors::Share& share) {
  return share.of == 0 ? 0.0 : 100.0 * static_cast<double>(share.wrong) / static_cast<double>(share.of);
}

std::string share_text(const study::StandInErrors::Share& share) {
  return fmt::format("{} of {} poses ({:.3g} %)", share.wrong, share.of, percent(share));
}

std::string times_text(const study::TimingRounds& meshes, const study::TimingRounds& stand_ins) {
  const double before = meshes.cpu_ns().value, after = stand_ins.cpu_ns().value;
  return fmt::format("{} instead of {}, {:.3g} times as fast", duration_text(1e-9 * after),
                     duration_text(1e-9 * before), before / after);
}

struct Bodies {
  const Mesh &a, &b;
  Mesh stand_in_a, stand_in_b;
};

void print_text(const std::string& pair, const Bodies& bodies, const study::StandInErrors& found) {
  fmt::print("{}: {} and {} triangles, stand-ins of {} and {}\n\n", pair, bodies.a.triangles().size(),
             bodies.b.triangles().size(), bodies.stand_in_a.triangles().size(), bodies.stand_in_b.triangles().size());
  const auto& [apart, near, overlapping] = found.yes_no;
  fmt::print("false yes, 1 % of the size or more apart   {}\n", share_text(apart));
  fmt::print("wrong yes/no, within 0.3 % of contact      {}\n", share_text(near));
  fmt::print("false no, overlapping                      {}\n", share_text(overlapping));
  if (!found.bias.empty()) {
    fmt::print("distances, mean error                      {:.3g} % of the size (5 % to 95 %: {:.3g} to {:.3g} %)\n",
               100.0 * found.mean_bias(), 100.0 * found.quantile(0.05), 100.0 * found.quantile(0.95));
  }
  fmt::print("yes/no by exact, mean time                 {}\n",
             times_text(found.yes_no_meshes, found.yes_no_stand_ins));
  fmt::print("distance by exact, mean time               {}\n",
             times_text(found.distance_meshes, found.distance_stand_ins));
}

void print_json(const std::string& pair, const Bodies& bodies, const study::StandInErrors& found) {
  using Json = nlohmann::ordered_json;
  const auto share = [](const study::StandInErrors::Share& s) { return Json{{"wrong", s.wrong}, {"of", s.of}}; };
  const auto times = [](const study::TimingRounds& meshes, const study::TimingRounds& stand_ins) {
    return Json{{"meshes", meshes.cpu_ns().value}, {"stand_ins", stand_ins.cpu_ns().value}};
  };
  Json json{{"pair", pair},
            {"triangles",
             {{"a", bodies.a.triangles().size()},
              {"b", bodies.b.triangles().size()},
              {"stand_in_a", bodies.stand_in_a.triangles().size()},
              {"stand_in_b", bodies.stand_in_b.triangles().size()}}},
            {"false_yes", {{"apart", share(found.yes_no[0])}, {"near", share(found.yes_no[1])}}},
            {"false_no", {{"overlapping", share(found.yes_no[2])}}}};
  if (!found.bias.empty()) {
    json["bias"] = {{"mean", found.mean_bias()},
                    {"p05", found.quantile(0.05)},
                    {"median", found.quantile(0.5)},
                    {"p95", found.quantile(0.95)}};
  }
  json["yes_no_ns"] = times(found.yes_no_meshes, found.yes_no_stand_ins);
  json["distance_ns"] = times(found.distance_meshes, found.distance_stand_ins);
  fmt::print("{}\n", json_text(json));
}

void run(const Options& options) {
  study::StudyPairs pairs(harness_options(options.study, k_poses, arguments_of("hulls", options.study)),
                          options.study.pairs);
  const CatalogueEntry& pair = *pairs.pairs().front();
  bench::PairCache& cache = pairs.cache();
  StatusLine status;
  status.show("poses and their truth");
  const Mesh &a = cache.mesh(pair.a), &b = cache.mesh(pair.b);
  const Bodies bodies{a, b, stand_in(a, options.parts_a), stand_in(b, options.parts_b)};
  const auto yes_no = study::draw_verdict_sample(cache, pair, bench::QueryKind::collide, k_poses);
  const auto distance = study::draw_verdict_sample(cache, pair, bench::QueryKind::distance, k_poses);
  status.show("answers about the stand-ins");
  const study::StandInErrors found =
      study::measure_stand_ins(a, b, bodies.stand_in_a, bodies.stand_in_b, yes_no, distance);
  status.clear();
  options.study.json ? print_json(pair.pair, bodies, found) : print_text(pair.pair, bodies, found);
}

}  // namespace

void add_hulls_command(CLI::App& app) {
  auto* const command = app.add_subcommand("hulls", "Say what convex hulls or convex parts cost instead of two meshes");
  const auto options = std::make_shared<Options>();
  auto* const pair = command->add_option("--pair", options->study.pairs, "A pair of the sets that come with sixdof");
  pair->type_name("PAIR")->expected(1);
  auto* const a = command->add_option("--a", options->study.a, "Fixed mesh A: a model's name or a file");
  a->type_name("MESH")->excludes(pair);
  command->add_option("--b", options->study.b, "Moving mesh B, likewise")
      ->type_name("MESH")
      ->default_str("a copy of A")
      ->needs(a);
  command
      ->add_option("--parts-a", options->parts_a,
                   "Files of the convex parts of A, instead of its hull; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--parts-b", options->parts_b, "Those of B")->type_name("FILE")->allow_extra_args(false);
  command->add_flag("--json", options->study.json, "As JSON");
  command->callback([options] { run(*options); });
  add_examples(*command, "sixdof hulls --a torus-1k --b cone-1k", "sixdof hulls --a torus-1k --json", k_details);
}

}  // namespace sixdof::cli
