#include "bench/cli/commands.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/variant.h>
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/harness/query_command.h"
#include "bench/harness/run_context.h"
#include "bench/study/survey_file.h"

namespace sixdof::cli {
namespace {

struct Arguments {
  std::string set, a, b;
  AlgorithmOptions algorithm;
  std::vector<std::string> questions{"distance", "respond"};
  std::size_t shards = 1, shard = 1, sample = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> merge;
  std::string output;
  bool resume = false, progress = false;
};

/// A query on a bucket.
struct Part {
  bench::QueryKind question;
  BucketKey key;
};

/// Of the queries asked for those that the algorithm answers, on the set's buckets: distances of bodies that are apart,
/// responses of all.
std::vector<Part> parts_of(const Arguments& arguments, const Traits& traits, const ConfigurationSet& set) {
  std::vector<Part> parts;
  for (const bench::QueryKind question : bench::k_query_kinds) {
    const bool is_wanted = std::ranges::find(arguments.questions, to_string(question)) != arguments.questions.end();
    if (!is_wanted || !bench::answers(traits.answers, question)) continue;
    for (const BucketSummary& bucket : set.buckets()) {
      if (bench::has_row(bucket.key, question)) parts.push_back({question, bucket.key});
    }
  }
  if (parts.empty()) {
    throw BadArgument(fmt::format("{} answers none of these queries on the set's buckets", traits.name));
  }
  return parts;
}

/// "elephant", as rows call the pair.
CatalogueEntry entry_of(const ConfigurationSet& set) {
  SetCatalogue catalogue;
  return catalogue.add(set.path(), set.description().a, set.description().b, {});
}

std::string argument_of(const MeshIdentity& mesh, const std::string& option) {
  return !option.empty() ? option : mesh.path.empty() ? mesh.name : mesh.path;
}

class Survey {
 public:
  explicit Survey(const Arguments& arguments)
      : arguments_(arguments), set_(arguments.set), selected_(select_algorithm(arguments.algorithm)) {
    if (arguments.shard < 1 || arguments.shard > arguments.shards) {
      throw BadArgument(fmt::format("--shard {}: there are {} shards", arguments.shard, arguments.shards));
    }
    if (traits().body != Body::mesh) {
      throw BadArgument(fmt::format("{} answers for convex hulls, whose truth no set has", traits().name));
    }
    parts_ = parts_of(arguments, traits(), set_);
    identity_ = identity();
  }

  void run() {
    if (arguments_.resume && study::has_shard(arguments_.output, identity_, arguments_.shard)) {
      fmt::print("{}: is there\n", arguments_.output);
      return;
    }
    check_writable(arguments_.output);
    const study::SurveyShard shard = ask();
    study::write_shard(arguments_.output, shard);
    std::uint64_t asked = 0;
    double seconds = 0.0;
    for (const study::SurveyCell& cell : shard.cells) {
      asked += cell.asked;
      seconds += cell.seconds;
    }
    fmt::print("{}: {} shard {} of {}, {} queries in {:.1f} s\n", arguments_.output, identity_.algorithm,
               arguments_.shard, arguments_.shards, asked, seconds);
  }

 private:
  const Traits& traits() const { return selected_.algorithm->traits(); }

  study::SurveyIdentity identity() const {
    const SetDescription& description = set_.description();
    const std::string a = argument_of(description.a, arguments_.a), b = argument_of(description.b, arguments_.b);
    const std::vector<std::string>& parameters = arguments_.algorithm.parameters;
    return {.set = set_.hash(),
            .grid = description.grid.spec,
            .pair = entry_of(set_).pair,
            .a = a,
            .b = b,
            .algorithm = parameters.empty() ? traits().name : variant_name(traits().name, parameters),
            .version = traits().version,
            .settings = selected_.settings.to_string(),
            .command = bench::query_command(a, b, *selected_.algorithm, selected_.settings),
            .questions = arguments_.questions,
            .approximates = traits().approximates,
            .isolated = is_isolated(*selected_.algorithm),
            .runtime = traits().runtime,
            .shards = arguments_.shards,
            .sample = arguments_.sample,
            .seed = arguments_.seed};
  }

  study::SurveyShard ask() const {
    const MeshIdentity &a_identity = set_.description().a, &b_identity = set_.description().b;
    const Mesh a = find_mesh(a_identity, set_.path(), arguments_.a);
    const bool copy = arguments_.b.empty() && a_identity.hash == b_identity.hash;
    const Mesh b = copy ? a : find_mesh(b_identity, set_.path(), arguments_.b);
    set_.check_meshes(a, b);
    const auto start = std::chrono::steady_clock::now();
    const auto query = selected_.algorithm->prepare(a, b, selected_.settings);
    const double prepare_ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    const Footprint footprint = query->footprint();
    study::SurveyShard shard{.identity = identity_,
                             .number = arguments_.shard,
                             .context = context(),
                             .prepare_ns = prepare_ns,
                             .bytes = static_cast<double>(footprint.bytes),
                             .counts = footprint.counts,
                             .cells = {}};
    study::SurveyOptions options{
        .shard = {arguments_.shard, arguments_.shards}, .sample = arguments_.sample, .seed = arguments_.seed};
    if (traits().approximates) {
      const auto found = std::ranges::find(footprint.counts, "resolution", &std::pair<std::string, double>::first);
      if (found != footprint.counts.end()) options.resolution = found->second;
    }
    ProgressLine line("buckets", arguments_.progress);
    for (const Part& part : parts_) {
      line.show(shard.cells.size(), parts_.size());
      // Open meshes have no inside, and no response.
      if (part.question == bench::QueryKind::respond && !(a.solid() && b.solid())) continue;
      shard.cells.push_back(study::survey_bucket(set_, part.key, part.question, a, b, *query, options));
    }
    if (shard.cells.empty()) throw BadArgument("only responses are asked, and a mesh is no solid");
    return shard;
  }

  nlohmann::ordered_json context() const {
    const std::string name = traits().name;
    const auto is_it = [&](const Traits& each) { return each.name == name; };
    std::map<std::string, Settings> settings;
    for (const auto& algorithm : selected_.registry.all()) {
      settings.emplace(algorithm->traits().name, algorithm->settings());
    }
    settings.insert_or_assign(name, selected_.settings);
    return bench::run_context({.program = "sixdof",
                               .seed = arguments_.seed,
                               .arguments = fmt::format("survey of all configurations, {} shards", arguments_.shards)},
                              selected_.registry, settings, is_it);
  }

  const Arguments& arguments_;
  const ConfigurationSet set_;
  const SelectedAlgorithm selected_;
  std::vector<Part> parts_;
  study::SurveyIdentity identity_;
};

/// The shards in folders, and files as they are.
std::vector<std::filesystem::path> shard_files(const std::vector<std::string>& words) {
  std::vector<std::filesystem::path> files;
  for (const std::string& word : words) {
    if (!std::filesystem::is_directory(word)) {
      files.emplace_back(word);
      continue;
    }
    std::vector<std::filesystem::path> here;
    for (const auto& entry : std::filesystem::directory_iterator(word)) {
      if (entry.path().extension() == ".json") here.push_back(entry.path());
    }
    std::ranges::sort(here);
    files.insert(files.end(), here.begin(), here.end());
  }
  return files;
}

void merge(const Arguments& arguments) {
  const nlohmann::ordered_json document = study::survey_document(shard_files(arguments.merge));
  write_file_atomically(arguments.output, json_text(document) + "\n");
  for (const auto& each : document.at("survey").at("algorithms")) {
    fmt::print("{}: {} configurations, {} asked, {} without an answer, {} wrong\n",
               each.at("algorithm").get<std::string>(), each.at("tests").get<std::uint64_t>(),
               each.at("asked").get<std::uint64_t>(), each.at("failed").get<std::uint64_t>(),
               each.at("wrong").get<std::uint64_t>());
  }
}

}  // namespace

void add_survey_command(CLI::App& app) {
  auto* const command = app.add_subcommand(
      "survey", "Ask one algorithm every configuration of a set, in shards; bench/paper runs it for several");
  const auto arguments = std::make_shared<Arguments>();
  auto* const set =
      command->add_option("set", arguments->set, "The configuration set")->type_name("FILE")->check(CLI::ExistingFile);
  add_algorithm_options(*command, arguments->algorithm, "Whom to ask")->needs(set);
  command
      ->add_option("--query", arguments->questions,
                   "What to ask, of what the algorithm answers: distances of bodies that are apart, responses of all, "
                   "yes/no of all")
      ->type_name("QUERY")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"collide", "distance", "respond"}))
      ->capture_default_str();
  command->add_option("--shards", arguments->shards, "How many parts the set has")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--shard", arguments->shard, "Which part to ask, from 1")
      ->type_name("I")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--sample", arguments->sample, "Configurations of each bucket of a part, at random; 0: all")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Seed of the order")->type_name("N")->capture_default_str();
  command->add_option("--a", arguments->a, "Mesh A, if it is not where the set says: a model's name or a file")
      ->type_name("MESH");
  command->add_option("--b", arguments->b, "Mesh B, likewise")->type_name("MESH");
  add_process_options(*command, arguments->algorithm.process);
  command->add_option("--merge", arguments->merge, "Instead: make a result of the shards in these folders or files")
      ->type_name("FOLDER")
      ->excludes(set);
  command->add_option("-o,--output", arguments->output, "File of the shard, or of the result (JSON)")
      ->required()
      ->type_name("FILE");
  command->add_flag("--resume", arguments->resume, "Ask nothing if FILE has this shard of the same survey");
  command->add_flag("--progress", arguments->progress, "Show progress where stderr is not a terminal, too");
  add_examples(
      *command, "sixdof survey set.h5 --algorithm exact --query distance -o exact-1.json",
      "sixdof survey --merge exact-1.json -o survey.json",
      "The result has a row for each query and bucket (sixdof table, sixdof report): mean and longest time over "
      "all configurations, answers that are missing or wrong, and the worst poses.");
  command->callback([arguments] {
    if (!arguments->merge.empty()) return merge(*arguments);
    if (arguments->set.empty()) throw BadArgument("a configuration set is needed, or --merge");
    if (arguments->algorithm.name.empty()) throw BadArgument("--algorithm is needed");
    Survey(*arguments).run();
  });
}

}  // namespace sixdof::cli
