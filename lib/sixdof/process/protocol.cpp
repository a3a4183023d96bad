#include <sixdof/process/protocol.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/visible_text.h>
#include <sixdof/process/protocol_values.h>
#include <sixdof/query/ask.h>

namespace sixdof::protocol {
namespace {

constexpr std::array k_kinds{"collide", "distance", "respond", "cast", "contacts"};
constexpr std::array k_kind_members{&QuerySet::collide, &QuerySet::distance, &QuerySet::respond, &QuerySet::cast,
                                    &QuerySet::contacts};
constexpr std::array k_laws{"none", "depth", "volume", "way_out", "contacts"};
constexpr std::array k_depths{"none", "triangles", "point", "local", "bodies"};
constexpr std::array k_bodies{"mesh", "convex_hull"};
constexpr std::array k_limits{"collide_of_surfaces", "respond_of_surfaces", "distance_of_bodies", "own_direction",
                              "points_of_b_only"};
constexpr std::array k_refusals{"error", "bad_mesh", "bad_argument"};

/// What is said last may hold bytes that are no text.
std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Why a line cannot be read.
Malformed malformed(const std::string& line, std::string_view words) {
  constexpr std::size_t k_most = 60;
  return Malformed(visible_words(fmt::format("\"{}\": {}", visible_text(line, k_most), words)));
}

/// Calls read(JSON object) and turns what goes wrong into Malformed.
template <class Read>
auto read_line(const std::string& line, Read read) {
  try {
    const Json json = Json::parse(line);
    if (!json.is_object()) throw Malformed("not a JSON object");
    return read(json);
  } catch (const Json::exception& e) {
    // "[json.exception.out_of_range.403] key 'ns' not found"
    const std::string words = e.what();
    const std::size_t end = words.find("] ");
    throw malformed(line, end == std::string::npos ? words : words.substr(end + 2));
  } catch (const Malformed& e) {
    throw malformed(line, e.what());
  }
}

/// The same of a reply: all its texts are visible.
template <class Read>
auto read_reply(const std::string& line, Read read) {
  return read_line(visible_json(line), read);
}

/// A name, a description or words of a failure.
std::string words_of(const Json& json) { return visible_words(json.get<std::string>()); }

std::string words_at(const Json& json, const char* key) {
  return json.contains(key) ? words_of(json.at(key)) : std::string();
}

template <class List>
std::size_t place_of(const List& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw Malformed(fmt::format("\"{}\" is not known", name));
  return static_cast<std::size_t>(found - names.begin());
}

Status status_of(const std::string& name) {
  for (const Status status :
       {Status::unsupported, Status::failed, Status::non_finite, Status::timed_out, Status::out_of_memory}) {
    if (name == to_string(status)) return status;
  }
  throw Malformed(fmt::format("\"{}\" is no status", name));
}

/// In the order of k_limits.
std::array<bool*, k_limits.size()> members_of(MethodLimits& limits) {
  return {&limits.surfaces_only.collide, &limits.surfaces_only.respond, &limits.distance_of_bodies,
          &limits.own_direction, &limits.points_of_b_only};
}

Json mesh(const MeshPlace& place) {
  return {{"name", place.name},
          {"vertices", place.vertices},
          {"vertex_count", place.vertex_count},
          {"triangles", place.triangles},
          {"triangle_count", place.triangle_count}};
}

MeshPlace mesh_of(const Json& json) {
  return {json.at("name"), json.at("vertices"), json.at("triangles"), count_of<std::size_t>(json.at("vertex_count")),
          count_of<std::size_t>(json.at("triangle_count"))};
}

Json parameter(const Parameter& p) {
  Json json = {{"name", p.name}, {"meaning", p.meaning}, {"unit", p.unit}, {"default", p.default_value}};
  if (p.choices.empty()) {
    json.update({{"low", p.low}, {"high", p.high}, {"integer", p.integer}});
  } else {
    json["choices"] = p.choices;
  }
  if (!p.sweep.empty()) json["sweep"] = p.sweep;
  return json;
}

Parameter parameter_of(const Json& json) {
  Parameter p{.name = json.at("name"),
              .meaning = words_at(json, "meaning"),
              .unit = words_at(json, "unit"),
              .default_value = json.at("default")};
  if (json.contains("choices")) {
    json.at("choices").get_to(p.choices);
  } else {
    p.low = json.at("low");
    p.high = json.at("high");
    p.integer = json.value("integer", false);
  }
  if (json.contains("sweep")) json.at("sweep").get_to(p.sweep);
  return p;
}

std::optional<double> optional_time(const Json& json, const char* key) {
  return json.contains(key) ? std::optional(time_of(json.at(key))) : std::nullopt;
}

struct RequestWriter {
  Json operator()(const Hello&) const { return {{"do", "hello"}, {"protocol", k_version}}; }
  Json operator()(const Prepare& prepare) const {
    Json settings = Json::object();
    for (const auto& [name, value] : prepare.settings) settings[name] = value;
    return {{"do", "prepare"},
            {"a", mesh(prepare.a)},
            {"b", mesh(prepare.b)},
            {"settings", settings},
            {"progress", prepare.progress}};
  }
  Json operator()(const Ask& ask) const {
    Json json = {{"do", "ask"}, {"query", ask.query}, {"pose", pose(ask.X_AB)}};
    if (ask.motion) {
      json.update({{"translation", vector(ask.motion->translation)},
                   {"rotation", vector(ask.motion->rotation)},
                   {"reference", vector(ask.motion->reference)}});
    }
    if (ask.query == k_query<Contacts>) json["most"] = ask.most;
    return json;
  }
  Json operator()(const Time& time) const {
    Json poses = Json::array();
    for (const Pose& X_AB : time.poses) poses.push_back(pose(X_AB));
    return {{"do", "time"},
            {"query", time.query},
            {"passes", time.passes},
            {"each", time.each},
            {"evict_bytes", time.evict_bytes},
            {"poses", std::move(poses)}};
  }
};

}  // namespace

std::string to_line(const Request& request) { return text(std::visit(RequestWriter(), request)); }

Request request_of(const std::string& line) {
  return read_line(line, [](const Json& json) -> Request {
    const auto what = json.at("do").get<std::string>();
    if (what == "hello") {
      if (json.at("protocol") != k_version) throw Malformed(fmt::format("not version {} of the protocol", k_version));
      return Hello{};
    }
    if (what == "prepare") {
      Prepare prepare{mesh_of(json.at("a")), mesh_of(json.at("b")), {}, json.at("progress")};
      for (const auto& [name, value] : json.at("settings").items()) prepare.settings.emplace_back(name, value);
      return prepare;
    }
    if (what == "ask") {
      Ask ask{json.at("query"), pose_of(json.at("pose"))};
      if (ask.query == k_query<Impact>) ask.motion = motion_of(json, ask.X_AB);
      if (ask.query == k_query<Contacts>) ask.most = count_of<std::size_t>(json.at("most"));
      return ask;
    }
    if (what != "time") throw Malformed(fmt::format("\"{}\" is not known", what));
    Time time{json.at("query"),
              {},
              count_of<std::size_t>(json.at("passes")),
              json.at("each"),
              count_of<std::size_t>(json.at("evict_bytes"))};
    for (const Json& each : json.at("poses")) time.poses.push_back(pose_of(each));
    return time;
  });
}

std::string to_line(const Greeting& greeting) {
  const Traits& traits = greeting.traits;
  Json answers = Json::array(), limits = Json::array(), can = Json::array(), parameters = Json::array();
  for (std::size_t i = 0; i < k_kinds.size(); ++i) {
    if (traits.answers.*k_kind_members.at(i)) answers.push_back(k_kinds.at(i));
  }
  MethodLimits copy = traits.limits;
  for (std::size_t i = 0; i < k_limits.size(); ++i) {
    if (*members_of(copy).at(i)) limits.push_back(k_limits.at(i));
  }
  if (greeting.times) can.push_back("time");
  if (greeting.progress) can.push_back("progress");
  if (greeting.again) can.push_back("again");
  for (const Parameter& each : traits.parameters) parameters.push_back(parameter(each));
  return text({{"protocol", k_version},
               {"name", traits.name},
               {"version", traits.version},
               {"summary", traits.summary},
               {"answers", answers},
               {"law", k_laws.at(static_cast<std::size_t>(traits.law))},
               {"depth", k_depths.at(static_cast<std::size_t>(traits.depth))},
               {"body", k_bodies.at(static_cast<std::size_t>(traits.body))},
               {"limits", limits},
               {"parameters", parameters},
               {"can", can}});
}

Greeting greeting_of(const std::string& line) {
  return read_reply(line, [](const Json& json) {
    if (json.at("protocol") != k_version) throw Malformed(fmt::format("not version {} of the protocol", k_version));
    Greeting greeting;
    Traits& traits = greeting.traits;
    traits.name = words_of(json.at("name"));
    traits.version = words_of(json.at("version"));
    traits.summary = words_at(json, "summary");
    for (const std::string kind : json.at("answers")) traits.answers.*k_kind_members.at(place_of(k_kinds, kind)) = true;
    traits.law = static_cast<ResponseLaw>(place_of(k_laws, json.value("law", "none")));
    traits.depth = static_cast<ContactDepth>(place_of(k_depths, json.value("depth", "none")));
    traits.body = static_cast<Body>(place_of(k_bodies, json.value("body", "mesh")));
    for (const std::string limit : json.value("limits", Json::array())) {
      *members_of(traits.limits).at(place_of(k_limits, limit)) = true;
    }
    for (const Json& each : json.value("parameters", Json::array())) traits.parameters.push_back(parameter_of(each));
    for (const std::string ability : json.value("can", Json::array())) {
      greeting.times = greeting.times || ability == "time";
      greeting.progress = greeting.progress || ability == "progress";
      greeting.again = greeting.again || ability == "again";
    }
    return greeting;
  });
}

std::string to_line(const Prepared& prepared) {
  Json counts = Json::object();
  for (const auto& [name, count] : prepared.footprint.counts) counts[name] = number(count);
  Json json = {{"prepared", true}, {"bytes", prepared.footprint.bytes}, {"counts", counts}};
  if (prepared.wall_ns) json["ns"] = *prepared.wall_ns;
  if (prepared.cpu_ns) json["cpu_ns"] = *prepared.cpu_ns;
  return text(json);
}

std::string to_line(const Refusal& refusal) {
  return text({{"error", refusal.words}, {"kind", k_refusals.at(static_cast<std::size_t>(refusal.kind))}});
}

std::variant<Prepared, Refusal> prepared_of(const std::string& line) {
  return read_reply(line, [](const Json& json) -> std::variant<Prepared, Refusal> {
    if (json.contains("error")) {
      return Refusal{static_cast<Refusal::Kind>(place_of(k_refusals, json.value("kind", k_refusals.front()))),
                     words_of(json.at("error"))};
    }
    if (!json.at("prepared").get<bool>()) throw Malformed("nothing is prepared, and no \"error\" says why");
    Prepared prepared{optional_time(json, "ns"), optional_time(json, "cpu_ns"), {}};
    if (json.contains("bytes")) prepared.footprint.bytes = count_of<std::size_t>(json.at("bytes"));
    const Json counts = json.value("counts", Json::object());
    for (const auto& [name, count] : counts.items()) {
      prepared.footprint.counts.emplace_back(visible_words(name), number_of(count));
    }
    return prepared;
  });
}

template <class Answer>
std::string to_line(const Asked<Answer>& asked) {
  Json json = Json::object();
  if (asked.outcome.ok()) {
    put(json, asked.outcome.value);
  } else {
    json.update({{"status", to_string(asked.outcome.status)}, {"words", asked.words}});
  }
  if (asked.ns) json["ns"] = *asked.ns;
  for (const Work& each : asked.work) json["work"].push_back({each.unit, number(each.tested), number(each.total)});
  return text(json);
}

template <class Answer>
Asked<Answer> asked_of(const std::string& line) {
  return read_reply(line, [](const Json& json) {
    Asked<Answer> asked;
    if (json.contains("status")) {
      asked.outcome = status_of(json.at("status"));
      asked.words = words_at(json, "words");
    } else {
      Answer answer{};
      take(json, answer);
      asked.outcome = std::move(answer);
    }
    asked.ns = optional_time(json, "ns");
    for (const Json& each : json.value("work", Json::array())) {
      asked.work.push_back({words_of(each.at(0)), number_of(each.at(1)), number_of(each.at(2))});
    }
    return asked;
  });
}

template <class Answer>
Asked<Answer> answer_of(const std::string& line) {
  auto asked = asked_of<Answer>(line);
  if (asked.outcome.ok() && !is_finite(asked.outcome.value)) {
    asked.outcome = Status::non_finite;
    asked.words = "the answer is not finite";
  } else if (const char* const why = asked.outcome.ok() ? why_no_answer(asked.outcome.value) : nullptr) {
    asked.outcome = Status::failed;
    asked.words = why;
  }
  return asked;
}

template std::string to_line(const Asked<bool>&);
template std::string to_line(const Asked<Separation>&);
template std::string to_line(const Asked<Response>&);
template std::string to_line(const Asked<Impact>&);
template std::string to_line(const Asked<Contacts>&);
template Asked<bool> asked_of(const std::string&);
template Asked<Separation> asked_of(const std::string&);
template Asked<Response> asked_of(const std::string&);
template Asked<Impact> asked_of(const std::string&);
template Asked<Contacts> asked_of(const std::string&);
template Asked<bool> answer_of(const std::string&);
template Asked<Separation> answer_of(const std::string&);
template Asked<Response> answer_of(const std::string&);
template Asked<Impact> answer_of(const std::string&);
template Asked<Contacts> answer_of(const std::string&);

std::string to_line(const Timed& timed) {
  Json failed = Json::array();
  for (const Failed& each : timed.failed) failed.push_back({each.place, to_string(each.status), each.words});
  return text({{"wall_ns", timed.wall_ns},
               {"cpu_ns", timed.cpu_ns},
               {"once_ns", numbers(timed.once_ns)},
               {"least_ns", numbers(timed.least_ns)},
               {"failed", failed}});
}

Timed timed_of(const std::string& line, std::size_t count, bool each) {
  return read_reply(line, [&](const Json& json) {
    Timed timed;
    if (each) {
      timed.once_ns = times_of(json.at("once_ns"));
      timed.least_ns = times_of(json.at("least_ns"));
      if (timed.once_ns.size() != count || timed.least_ns.size() != count) {
        throw Malformed(fmt::format("not {} times for as many poses", count));
      }
    } else {
      timed.wall_ns = time_of(json.at("wall_ns"));
      timed.cpu_ns = time_of(json.at("cpu_ns"));
    }
    std::vector<bool> has_failed(count);
    for (const Json& one : json.value("failed", Json::array())) {
      timed.failed.push_back({count_of<std::size_t>(one.at(0)), status_of(one.at(1)), words_of(one.at(2))});
      const std::size_t place = timed.failed.back().place;
      if (place >= count) throw Malformed("a place beyond the last pose");
      if (has_failed[place]) throw Malformed("a place is there twice");
      has_failed[place] = true;
    }
    return timed;
  });
}

}  // namespace sixdof::protocol
