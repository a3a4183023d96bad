#include "bench/cli/query.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>

#include "bench/cli/algorithm_options.h"
#include "bench/common/examples.h"

namespace sixdof::cli {
namespace {

struct Arguments {
  std::string a, b, pose, about;
  AlgorithmOptions algorithm{.name = "exact", .parameters = {}};
  bool json = false;
};

/// Exactly `count` numbers separated by white space or commas; `what` names them in the message.
std::vector<double> parse_numbers(const std::string& text, std::size_t count, const char* what) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto separates = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n'; };
  while (true) {
    while (at != end && separates(*at)) ++at;
    if (at == end) break;
    double value = 0.0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (stop != end && !separates(*stop))) {
      throw BadArgument(fmt::format("{} \"{}\": number {} cannot be read", what, text, numbers.size() + 1));
    }
    numbers.push_back(value);
    at = stop;
  }
  if (numbers.size() != count) {
    throw BadArgument(fmt::format("{} \"{}\": {} numbers instead of {}", what, text, numbers.size(), count));
  }
  return numbers;
}

Pose parse_pose(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 7, "--pose");
  return Pose::from_quaternion(n[3], n[4], n[5], n[6], {n[0], n[1], n[2]});
}

using Clock = std::chrono::steady_clock;

std::int64_t nanoseconds_since(Clock::time_point begin) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
}

/// One kind of query: its outcome and the time of this one call, with cold caches.
template <class T>
struct Timed {
  bool asked = false;  ///< The algorithm answers this kind of query.
  Outcome<T> outcome;
  std::string diagnosis;
  std::int64_t nanoseconds = 0;
};

template <class T, class Ask>
Timed<T> timed(Query& query, bool answers, const Ask& ask) {
  Timed<T> result;
  result.asked = answers;
  if (!answers) return result;
  const auto begin = Clock::now();
  result.outcome = ask();
  result.nanoseconds = nanoseconds_since(begin);
  if (!result.outcome.ok()) result.diagnosis = query.diagnosis();
  return result;
}

struct Answers {
  Timed<bool> collide;
  Timed<Separation> distance;
  Timed<Response> respond;
  std::int64_t prepare_ns = 0;

  /// ok, or the status of the first query that was asked and gave no answer, with its diagnosis.
  std::pair<Status, std::string> status() const {
    if (collide.asked && !collide.outcome.ok()) return {collide.outcome.status, collide.diagnosis};
    if (distance.asked && !distance.outcome.ok()) return {distance.outcome.status, distance.diagnosis};
    if (respond.asked && !respond.outcome.ok()) return {respond.outcome.status, respond.diagnosis};
    return {Status::ok, {}};
  }
};

Answers ask(const Algorithm& algorithm, const Mesh& a, const Mesh& b, const Settings& settings, const Pose& X_AB) {
  Answers answers;
  const auto begin = Clock::now();
  const std::unique_ptr<Query> query = algorithm.prepare(a, b, settings);
  answers.prepare_ns = nanoseconds_since(begin);
  const QuerySet kinds = algorithm.traits().answers;
  answers.collide = timed<bool>(*query, kinds.collide, [&] { return query->collide(X_AB); });
  answers.distance = timed<Separation>(*query, kinds.distance, [&] { return query->distance(X_AB); });
  answers.respond = timed<Response>(*query, kinds.respond, [&] { return query->respond(X_AB); });
  return answers;
}

using Json = nlohmann::ordered_json;

Json as_json(const Eigen::Vector3d& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; }

/// nlohmann::json prints numbers with as few digits as identify the double, and NaN as null.
Json describe(const Traits& traits, const Settings& settings, const Answers& answers) {
  const auto [status, diagnosis] = answers.status();
  const bool separated = answers.distance.outcome.ok();
  const Separation& gap = answers.distance.outcome.value;
  const bool witnesses = separated && gap.has_witnesses;
  const bool responded = answers.respond.outcome.ok();
  const Response& response = answers.respond.outcome.value;
  const auto or_null = [](bool given, const Json& value) { return given ? value : Json(nullptr); };
  const auto time = [](const auto& t) { return t.asked ? Json(t.nanoseconds) : Json(nullptr); };
  return {{"algorithm", traits.name},
          {"version", traits.version},
          {"settings", settings.to_string()},
          {"status", to_string(status)},
          {"diagnosis", or_null(!diagnosis.empty(), diagnosis)},
          {"colliding", or_null(answers.collide.outcome.ok(), answers.collide.outcome.value)},
          {"distance", or_null(separated, gap.distance)},
          {"witness_a", or_null(witnesses, as_json(gap.witness_a))},
          {"witness_b", or_null(witnesses, as_json(gap.witness_b))},
          {"penalty", or_null(responded, response.penalty)},
          {"volume", or_null(responded, response.volume)},
          {"force", or_null(responded, as_json(response.force))},
          {"torque", or_null(responded, as_json(response.torque))},
          {"reference_point", or_null(responded, as_json(response.reference))},
          {"time_ns", answers.collide.nanoseconds + answers.distance.nanoseconds + answers.respond.nanoseconds},
          {"times_ns",
           {{"prepare", answers.prepare_ns},
            {"collide", time(answers.collide)},
            {"distance", time(answers.distance)},
            {"respond", time(answers.respond)}}}};
}

void print_text(const Json& answers) {
  for (const auto& [key, value] : answers.items()) {
    if (value.is_null()) continue;
    fmt::print("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  }
}

void run_query(const Arguments& arguments) {
  const auto [registry, algorithm, settings] = select_algorithm(arguments.algorithm);
  const Pose X_AB = parse_pose(arguments.pose);
  std::vector<double> about;
  if (!arguments.about.empty()) about = parse_numbers(arguments.about, 3, "--about");

  const Mesh a = load_model(arguments.a);
  const Mesh b = arguments.b == arguments.a ? a : load_model(arguments.b);
  Answers answers = ask(*algorithm, a, b, settings, X_AB);
  if (!about.empty() && answers.respond.outcome.ok()) {
    answers.respond.outcome.value = answers.respond.outcome.value.about({about[0], about[1], about[2]});
  }
  const Json json = describe(algorithm->traits(), settings, answers);
  arguments.json ? fmt::print("{}\n", json.dump(2)) : print_text(json);
  if (const auto [status, diagnosis] = answers.status(); status != Status::ok) {
    throw Error(fmt::format("{}: {}: {}", arguments.algorithm.name, to_string(status), diagnosis));
  }
}

}  // namespace

void add_query_command(CLI::App& app) {
  auto* const command = app.add_subcommand("query", "Print all answers of one algorithm at one pose");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--a", arguments->a, "The fixed object: a model's name or a mesh file")->required();
  command->add_option("--b", arguments->b, "The moving object")->required();
  command
      ->add_option(
          "--pose", arguments->pose,
          "Pose of B in A's frame, as one argument: \"tx ty tz qw qx qy qz\"; a point p of B is at q p q* + t in A")
      ->required();
  add_algorithm_options(*command, arguments->algorithm, "Name of an algorithm (sixdof algorithms lists them)")
      ->capture_default_str();
  command->add_option("--about", arguments->about,
                      "Reference point \"x y z\" of the torque, in A's frame (default: centre of B's bounding box)");
  command->add_flag("--json", arguments->json, "As JSON; null where the algorithm gives no answer");
  command->callback([arguments] { run_query(*arguments); });
  add_examples(
      *command, "sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0'",
      "sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0' --algorithm ist -p spheres=500 --json");
}

}  // namespace sixdof::cli
