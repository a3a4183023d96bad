#include "bench/cli/commands.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/ask.h>
#include "bench/cli/query_contacts.h"
#include "bench/cli/query_depth.h"
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"
#include "bench/common/pair_warnings.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_details =
    "colliding: the bodies have a point in common. Their surfaces meet, or one body lies inside the other (then nested "
    "is true; algorithms that look at surfaces only say no). distance: between the two surfaces, also for nested "
    "bodies; 0 where the surfaces meet. Lengths are in the meshes' own unit, the volume in its cube. The force of "
    "exact is the negative gradient of the overlap volume (unit squared); for other algorithms see "
    "`sixdof algorithms`. t: of the first contact, from 0 to 1 of the motion; normal: from A to B there. "
    "Contacts: normals from A to B; behind each stands what exact geometry says of solids: off, its distance from "
    "being "
    "in both; normal_degrees, to the nearest true normal; thickness of the intersection along the normal. Times are "
    "those of single calls with cold caches, in ns. Open meshes have no inside: yes/no "
    "and distance are those of their surfaces, and there is no response. --depth: of two solids; exact answers, "
    "whatever the algorithm. All translations of B shorter than depth_lo leave a common interior point, and that of "
    "length depth_hi leaves none; closed says whether both are within the tolerance.";

struct Arguments {
  std::string a, b, about;
  std::vector<std::string> pose, motion, only;
  std::string along;
  DepthRequest depth;
  AlgorithmOptions algorithm{.name = "exact", .parameters = {}};
  std::size_t contacts = 0;  ///< How many at most; 0 if others are asked.
  bool json = false;
};

/// Numbers separated by white space or commas; `what` names them in the message.
std::vector<double> parse_numbers(const std::string& text, const char* what) {
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
  return numbers;
}

/// The same, exactly `count` numbers.
std::vector<double> parse_numbers(const std::string& text, std::size_t count, const char* what) {
  const std::vector<double> numbers = parse_numbers(text, what);
  if (numbers.size() == count) return numbers;
  throw BadArgument(fmt::format("{} \"{}\": {} numbers instead of {}", what, text, numbers.size(), count));
}

/// Numbers of a rotation matrix, by rows, and a translation.
constexpr std::size_t k_matrix_numbers = 12;

/// Seven numbers, or twelve, which may be no rigid motion.
/// @param words the numbers, in one argument or in several
Pose parse_pose(const std::vector<std::string>& words) {
  const std::string text = fmt::format("{}", fmt::join(words, " "));
  std::vector<double> n = parse_numbers(text, "--pose");
  if (n.size() == k_matrix_numbers) {
    Pose X_AB{.R = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(n.data()), .t = {n[9], n[10], n[11]}};
    return X_AB;
  }
  n = parse_numbers(text, 7, "--pose");
  return Pose::from_quaternion(n[3], n[4], n[5], n[6], {n[0], n[1], n[2]});
}

/// Numbers of --motion: translation, rotation vector, reference point.
constexpr std::size_t k_motion_numbers = 9;

/// @param words three, six or nine numbers, in one argument or in several
Motion parse_motion(const std::vector<std::string>& words, const Pose& start, const Mesh& b) {
  const std::string text = fmt::format("{}", fmt::join(words, " "));
  const std::vector<double> n = parse_numbers(text, "--motion");
  if (n.size() != 3 && n.size() != 6 && n.size() != k_motion_numbers) {
    throw BadArgument(fmt::format("--motion \"{}\": {} numbers instead of 3, 6 or 9", text, n.size()));
  }
  Motion motion = Motion::of(b, start, {n[0], n[1], n[2]});
  if (n.size() >= 6) motion.rotation = {n[3], n[4], n[5]};
  if (n.size() == k_motion_numbers) motion.reference = {n[6], n[7], n[8]};
  return motion;
}

using Clock = std::chrono::steady_clock;

std::int64_t nanoseconds_since(Clock::time_point begin) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
}

using Json = nlohmann::ordered_json;

/// Outcomes, and times in ns of these single calls, with cold caches.
struct Answers {
  Outcome<bool> collide;
  Outcome<Separation> distance;
  Outcome<Response> respond;
  Outcome<Impact> cast;
  Outcome<Contacts> contacts;
  Json times_ns;  ///< By kind of call, null for queries that the algorithm does not answer.
  std::int64_t query_ns = 0;
  Status status = Status::ok;  ///< Of the first query that was asked and gave no answer,
  std::string diagnosis;       ///< with its words.
  std::string no_response;     ///< Why there is no response of these meshes though there are other answers.

  /// One body lies inside the other, and their surfaces do not meet.
  bool nested() const { return collide.ok() && collide.value && distance.ok() && distance.value.distance > 0.0; }
};

/// Why a mesh is no solid, of the first that is none; empty if both are.
std::string why_not_solid(const Mesh& a, const Mesh& b) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) return mesh->name() + ": " + mesh->why_not_solid() + k_repair_hint;
  }
  return {};
}

/// The questions of --only, or all, as far as the algorithm answers them; cast alone of a motion, contacts alone where
/// some are asked for.
/// @throws BadArgument for one that it does not
QuerySet chosen_questions(const Traits& traits, const std::vector<std::string>& only, bool moves, bool contacts) {
  if (contacts && !traits.answers.contacts) {
    throw BadArgument(fmt::format("{} gives no contacts; sixdof algorithms says who does", traits.name));
  }
  if (contacts) return {.contacts = true};
  if (moves && !traits.answers.cast) {
    throw BadArgument(fmt::format("{} gives no answer to a motion; sixdof algorithms says who does", traits.name));
  }
  if (moves) return {.cast = true};
  QuerySet chosen = traits.answers;
  chosen.cast = chosen.contacts = false;
  if (!chosen.any()) {
    throw BadArgument(traits.answers.contacts
                          ? fmt::format("{} answers with contacts only: ask for them by --contacts", traits.name)
                          : fmt::format("{} answers for motions only: give it a --motion", traits.name));
  }
  if (only.empty()) return chosen;
  chosen = {};
  for (const std::string& word : only) {
    const auto choose = [&](bool QuerySet::*question) {
      if (!(traits.answers.*question)) {
        throw BadArgument(fmt::format("{} gives no answer to {}; sixdof algorithms says who does", traits.name, word));
      }
      chosen.*question = true;
    };
    choose(word == "collide" ? &QuerySet::collide : word == "distance" ? &QuerySet::distance : &QuerySet::respond);
  }
  return chosen;
}

/// @param question returns the outcome
template <class T, class Question>
void ask_one(Query& query, const char* kind, bool asked, const Question& question, Outcome<T>& outcome,
             Answers& answers) {
  answers.times_ns[kind] = nullptr;
  if (!asked) return;
  const auto begin = Clock::now();
  outcome = question();
  const std::int64_t round_trip = nanoseconds_since(begin);
  const RemoteQuery* const remote = as_remote(query);
  const std::int64_t took = remote == nullptr ? round_trip : std::llround(remote->last_ns());
  answers.times_ns[kind] = took;
  answers.query_ns += took;
  examine(query, outcome, [&](const std::string& words) {
    if (answers.status != Status::ok) return;
    answers.status = outcome.status;
    answers.diagnosis = words;
  });
}

/// @param most contacts
Answers ask(const Algorithm& algorithm, const Mesh& a, const Mesh& b, const Settings& settings, const Motion& motion,
            const QuerySet& kinds, std::size_t most) {
  const Pose& X_AB = motion.start;
  Answers answers;
  const auto begin = Clock::now();
  const std::unique_ptr<Query> query = algorithm.prepare(a, b, settings);
  answers.times_ns["prepare"] = nanoseconds_since(begin);
  const RemoteQuery* const remote = as_remote(*query);
  if (remote != nullptr && remote->prepared().wall_ns) {
    answers.times_ns["prepare"] = std::llround(*remote->prepared().wall_ns);
  }
  const auto ask = [&](const char* kind, bool asked, const auto& question, auto& outcome) {
    ask_one(*query, kind, asked, question, outcome, answers);
  };
  ask(
      "collide", kinds.collide, [&] { return query->collide(X_AB); }, answers.collide);
  ask(
      "distance", kinds.distance, [&] { return query->distance(X_AB); }, answers.distance);
  ask(
      "cast", kinds.cast, [&] { return query->cast(motion); }, answers.cast);
  if (kinds.contacts)
    ask(
        "contacts", true, [&] { return query->contacts(X_AB, most); }, answers.contacts);
  const Status before = answers.status;
  ask(
      "respond", kinds.respond, [&] { return query->respond(X_AB); }, answers.respond);
  // A surface with a border has yes/no and distance, but no inside that a force could push out of.
  const bool other_answers = answers.collide.ok() || answers.distance.ok();
  if (const std::string why = why_not_solid(a, b);
      other_answers && !why.empty() && kinds.respond && answers.respond.status == Status::failed) {
    answers.no_response = why;
    if (before == Status::ok) answers.status = Status::ok;
  }
  return answers;
}

/// nlohmann::json prints numbers with as few digits as identify the double, and NaN as null.
Json describe(const Traits& traits, const Settings& settings, const Answers& answers) {
  const bool separated = answers.distance.ok(), responded = answers.respond.ok();
  const Separation& gap = answers.distance.value;
  const Impact& impact = answers.cast.value;
  const bool hit = answers.cast.ok() && impact.hit;
  const bool witnesses = hit ? impact.has_witnesses : separated && gap.has_witnesses;
  const Response& response = answers.respond.value;
  const auto or_null = [](bool given, const Json& value) { return given ? value : Json(nullptr); };
  return {{"algorithm", traits.name},
          {"version", traits.version},
          {"settings", settings.to_string()},
          {"body", or_null(traits.body != Body::mesh, to_string(traits.body))},
          {"status", to_string(answers.status)},
          {"diagnosis", or_null(answers.status != Status::ok, answers.diagnosis)},
          {"colliding", or_null(answers.collide.ok(), answers.collide.value)},
          {"distance", or_null(separated, gap.distance)},
          {"nested", or_null(answers.nested(), true)},
          {"hit", or_null(answers.cast.ok(), impact.hit)},
          {"t", or_null(hit, impact.t)},
          {"contact_at_start", or_null(hit, impact.at_start())},
          {"witness_a", or_null(witnesses, coordinates(hit ? impact.witness_a : gap.witness_a))},
          {"witness_b", or_null(witnesses, coordinates(hit ? impact.witness_b : gap.witness_b))},
          {"normal", or_null(hit && !impact.normal.isZero(0.0), coordinates(impact.normal))},
          {"penalty", or_null(responded, response.penalty)},
          {"volume", or_null(responded, response.volume)},
          {"force", or_null(responded, coordinates(response.force))},
          {"torque", or_null(responded, coordinates(response.torque))},
          {"reference_point", or_null(responded, coordinates(response.reference))},
          {"no_response", or_null(!answers.no_response.empty(), answers.no_response)},
          {"time_ns", answers.query_ns},
          {"times_ns", answers.times_ns}};
}

void print_text(const Json& answers) {
  for (const auto& [key, value] : answers.items()) {
    if (value.is_null()) continue;
    if (key == "contacts") {
      for (const Json& each : value) fmt::print("{:<16} {}\n", "contact", json_text(each, -1));
      continue;
    }
    fmt::print("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : json_text(value, -1));
  }
}

void run_query(const Arguments& arguments) {
  const auto [registry, algorithm, settings] = select_algorithm(arguments.algorithm);
  const QuerySet kinds =
      chosen_questions(algorithm->traits(), arguments.only, !arguments.motion.empty(), arguments.contacts > 0);
  const Pose X_AB = parse_pose(arguments.pose);
  std::vector<double> about;
  if (!arguments.about.empty()) about = parse_numbers(arguments.about, 3, "--about");

  const Mesh a = load_model(arguments.a);
  const Mesh b = arguments.b == arguments.a ? a : load_model(arguments.b);
  say_notes("sixdof", a, arguments.a);
  if (arguments.b != arguments.a) say_notes("sixdof", b, arguments.b);
  warn_of_sizes("sixdof", MeshIdentity::of(a), MeshIdentity::of(b));
  if (arguments.depth.asked) {
    DepthRequest request = arguments.depth;
    if (!arguments.along.empty()) request.along = parse_numbers(arguments.along, 3, "--along");
    const Json depth = describe_depth(a, b, X_AB, request);
    return arguments.json ? fmt::print("{}\n", json_text(depth)) : print_text(depth);
  }
  const Motion motion = arguments.motion.empty() ? Motion{.start = X_AB} : parse_motion(arguments.motion, X_AB, b);
  Answers answers = ask(*algorithm, a, b, settings, motion, kinds, arguments.contacts);
  if (!about.empty() && answers.respond.ok()) {
    answers.respond.value = answers.respond.value.about({about[0], about[1], about[2]});
  }
  Json json = describe(algorithm->traits(), settings, answers);
  if (answers.contacts.ok()) {
    json["depth_of"] = to_string(algorithm->traits().depth);
    json["contacts"] = describe_contacts(answers.contacts.value, a, b, X_AB);
  }
  arguments.json ? fmt::print("{}\n", json_text(json)) : print_text(json);
  if (answers.status != Status::ok) {
    throw Error(fmt::format("{}: {}: {}", arguments.algorithm.name, to_string(answers.status), answers.diagnosis));
  }
}

}  // namespace

void add_query_command(CLI::App& app) {
  auto* const command = app.add_subcommand("query", "Print whether two bodies collide, their distance and the force");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--a", arguments->a, "The fixed body A: a model's name or a mesh file")
      ->required()
      ->type_name("MESH");
  command->add_option("--b", arguments->b, "The moving body B, likewise")->required()->type_name("MESH");
  command
      ->add_option("--pose", arguments->pose,
                   "Where B is in A's frame: \"tx ty tz qw qx qy qz\", a translation (in the meshes' unit) and a unit "
                   "quaternion; a point p of B is at q p q* + t in A. Or twelve numbers, a matrix by rows and t, which "
                   "are passed on whatever they are")
      ->required()
      ->type_name("POSE")
      ->expected(1, static_cast<int>(k_matrix_numbers));
  auto* const motion =
      command
          ->add_option(
              "--motion", arguments->motion,
              "When do the bodies first touch while B moves from there? \"x y z\", its translation, then if it "
              "rotates a rotation vector (radians, in A's axes), then the point of B that moves straight, in "
              "B's frame, if not the centre of B's box")
          ->type_name("MOTION")
          ->expected(1, static_cast<int>(k_motion_numbers));
  command->add_option("--only", arguments->only, "Questions to ask: distance; collide,distance")
      ->type_name("QUESTION")
      ->delimiter(',')
      ->check(CLI::IsMember({"collide", "distance", "respond"}))
      ->allow_extra_args(false)
      ->excludes(motion)
      ->default_str("all that the algorithm answers");
  command->add_option("--contacts", arguments->contacts, "Ask for this many contacts at most, and for nothing else")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 1'000'000))
      ->excludes(motion)
      ->excludes("--only");
  auto* const depth = command
                          ->add_flag("--depth", arguments->depth.asked,
                                     "How far B has to be translated to leave A: an interval that holds the depth")
                          ->excludes(motion)
                          ->excludes("--only")
                          ->excludes("--contacts");
  command->add_option("--tolerance", arguments->depth.tolerance, "Of --depth: width of the interval by its upper end")
      ->type_name("PART")
      ->needs(depth)
      ->capture_default_str();
  command->add_option("--budget", arguments->depth.budget, "Of --depth: points measured before it is left open")
      ->type_name("COUNT")
      ->needs(depth)
      ->capture_default_str();
  command->add_option("--along", arguments->along, "Of --depth: the depth along this direction \"x y z\" of A's frame")
      ->type_name("DIRECTION")
      ->needs(depth);
  add_algorithm_options(*command, arguments->algorithm, "The algorithm to ask (sixdof algorithms lists them)")
      ->capture_default_str();
  command->add_option("--about", arguments->about, "Reference point \"x y z\" of the torque, in A's frame")
      ->type_name("POINT")
      ->default_str("centre of B's bounding box");
  command->add_flag("--json", arguments->json, "As JSON; null where there is no answer");
  add_process_options(*command, arguments->algorithm.process);
  command->callback([arguments] { run_query(*arguments); });
  add_examples(*command, "sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0'",
               "sixdof query --a cone-1k --b torus-1k --pose '1.9 0 0.1 1 0 0 0' --motion '-2 0 0 0 0 1.5' --json",
               k_details);
}

}  // namespace sixdof::cli
