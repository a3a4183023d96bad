#include <sixdof/bench/cli/algorithms.h>

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/bench/algorithms.h>

namespace sixdof::cli {
namespace {

std::string_view to_string(ResponseLaw law) {
  switch (law) {
    case ResponseLaw::none:
      return "none";
    case ResponseLaw::depth:
      return "depth";
    case ResponseLaw::volume:
      return "volume";
  }
  return "unknown";
}

std::vector<std::string> names_of(const QuerySet& answers) {
  std::vector<std::string> names;
  if (answers.collide) names.emplace_back("collide");
  if (answers.distance) names.emplace_back("distance");
  if (answers.respond) names.emplace_back("respond");
  return names;
}

std::string range_of(const Knob& knob) {
  if (!knob.choices.empty()) return fmt::format("{}", fmt::join(knob.choices, " | "));
  return fmt::format("{} .. {}{}", knob.low, knob.high, knob.integer ? ", whole" : "");
}

nlohmann::ordered_json as_json(const Knob& knob) {
  nlohmann::ordered_json json = {{"name", knob.name}, {"meaning", knob.meaning}, {"unit", knob.unit}};
  json["default"] = knob.standard;
  if (knob.choices.empty()) {
    json["low"] = knob.low;
    json["high"] = knob.high;
    json["integer"] = knob.integer;
  } else {
    json["choices"] = knob.choices;
  }
  return json;
}

void print_json(const Registry& registry) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    auto knobs = nlohmann::ordered_json::array();
    for (const Knob& knob : traits.knobs) knobs.push_back(as_json(knob));
    list.push_back({{"name", traits.name},
                    {"version", traits.version},
                    {"summary", traits.summary},
                    {"answers", names_of(traits.answers)},
                    {"law", to_string(traits.law)},
                    {"knobs", knobs}});
  }
  fmt::print("{}\n", list.dump(2));
}

void print_text(const Registry& registry) {
  fmt::print("{:<16} {:<10} {:<28} {:<7} {}\n", "algorithm", "version", "answers", "law", "what it is");
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    fmt::print("{:<16} {:<10} {:<28} {:<7} {}\n", traits.name, traits.version,
               fmt::format("{}", fmt::join(names_of(traits.answers), ",")), to_string(traits.law), traits.summary);
    for (const Knob& knob : traits.knobs) {
      fmt::print("  {}={}  [{}]  unit {}: {}\n", knob.name, knob.standard, range_of(knob),
                 knob.unit.empty() ? "none" : knob.unit, knob.meaning);
    }
  }
}

}  // namespace

void add_algorithms_command(CLI::App& app) {
  auto* const command = app.add_subcommand("algorithms", "What each algorithm answers, its knobs and version");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "As JSON");
  command->callback([json] {
    Registry registry;
    register_all_algorithms(registry);
    *json ? print_json(registry) : print_text(registry);
  });
}

}  // namespace sixdof::cli
