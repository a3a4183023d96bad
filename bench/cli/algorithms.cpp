#include "bench/cli/commands.h"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bench/cli/shared.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

std::vector<std::string> names_of(const QuerySet& answers) {
  std::vector<std::string> names;
  if (answers.collide) names.emplace_back("collide");
  if (answers.distance) names.emplace_back("distance");
  if (answers.respond) names.emplace_back("respond");
  if (answers.cast) names.emplace_back("cast");
  if (answers.contacts) names.emplace_back("contacts");
  return names;
}

std::string range_of(const Parameter& parameter) {
  if (!parameter.choices.empty()) return fmt::format("{}", fmt::join(parameter.choices, " | "));
  return fmt::format("{} .. {}{}", parameter.low, parameter.high, parameter.integer ? ", whole" : "");
}

nlohmann::ordered_json as_json(const Parameter& parameter) {
  nlohmann::ordered_json json = {{"name", parameter.name}, {"meaning", parameter.meaning}, {"unit", parameter.unit}};
  json["default"] = parameter.default_value;
  if (parameter.choices.empty()) {
    json["low"] = parameter.low;
    json["high"] = parameter.high;
    json["integer"] = parameter.integer;
  } else {
    json["choices"] = parameter.choices;
  }
  if (!parameter.sweep.empty()) json["sweep"] = parameter.sweep;
  return json;
}

void print_json(const Registry& registry) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    auto parameters = nlohmann::ordered_json::array();
    for (const Parameter& parameter : traits.parameters) parameters.push_back(as_json(parameter));
    list.push_back({{"name", traits.name},
                    {"version", traits.version},
                    {"summary", traits.summary},
                    {"answers", names_of(traits.answers)},
                    {"law", to_string(traits.law)},
                    {"timed", traits.timed},
                    {"by_default", traits.in_default_runs()},
                    {"body", to_string(traits.body)},
                    {"runtime", traits.is_rival() ? nlohmann::ordered_json(traits.runtime) : nlohmann::ordered_json()},
                    {"parameters", parameters}});
  }
  fmt::print("{}\n", json_text(list));
}

std::string remark_of(const Traits& traits) {
  if (!traits.timed) return " (not timed)";
  if (traits.is_rival()) return fmt::format(" (rival, {}: only where it is named)", traits.runtime);
  if (traits.body != Body::mesh) return " (another question: only where it is named)";
  return traits.by_default ? "" : " (slow: only where it is named)";
}

void print_text(const Registry& registry) {
  fmt::print("{:<16} {:<13} {:<28} {:<8} {}\n", "algorithm", "version", "answers", "law", "summary");
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    fmt::print("{:<16} {:<13} {:<28} {:<8} {}\n", traits.name, traits.version,
               fmt::format("{}", fmt::join(names_of(traits.answers), ",")), to_string(traits.law),
               traits.summary + remark_of(traits));
    for (const Parameter& parameter : traits.parameters) {
      fmt::print("  {}={}  [{}]  unit {}: {}\n", parameter.name, parameter.default_value, range_of(parameter),
                 parameter.unit.empty() ? "none" : parameter.unit, parameter.meaning);
    }
  }
}

}  // namespace

void add_algorithms_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("algorithms", "List the algorithms: what each answers, its parameters and version");
  struct Options {
    ProcessOptions process;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  add_process_options(*command, options->process);
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] {
    Registry registry;
    register_all_algorithms(registry, options->process);
    options->json ? print_json(registry) : print_text(registry);
  });
  add_examples(*command, "sixdof algorithms", "sixdof algorithms --json",
               "Rivals are the libraries that bench/rivals/setup has made ready, below $SIXDOF_RIVALS or "
               "~/.cache/sixdof-rivals. Lists of algorithms may name all of them: rivals. No program is started here.");
}

}  // namespace sixdof::cli
