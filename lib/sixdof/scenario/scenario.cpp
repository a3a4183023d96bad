#include <sixdof/scenario/scenario.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/query/variant.h>
#include <sixdof/scenario/kinds.h>

namespace sixdof {
namespace {

/// In the order of IdealLaw.
constexpr std::array<std::string_view, 10> k_law_words{"depth",       "volume",        "gradient", "energy",
                                                       "traction",    "wall-traction", "normals",  "descent",
                                                       "paper-depth", "paper-volume"};

struct Limit {
  std::string_view algorithm;
  IdealLaw law;
};

/// By test/quality/limit_test.cpp and the convergence tests of the algorithms.
constexpr std::array k_limits{Limit{"exact", IdealLaw::gradient}, Limit{"vps", IdealLaw::traction},
                              Limit{"vps-field", IdealLaw::wall_traction}, Limit{"ist", IdealLaw::normals},
                              Limit{"ist-descent", IdealLaw::descent}};

struct Kind {
  const char* name;
  Settings (*settings)();
  std::unique_ptr<Scenario> (*make)(const Settings&);
};

constexpr std::array k_kinds{
    Kind{"Ia", [] { return cone_block_settings(false); }, [](const Settings& s) { return make_cone_block(s, false); }},
    Kind{"Ib", [] { return cone_block_settings(true); }, [](const Settings& s) { return make_cone_block(s, true); }},
    Kind{"II", sphere_cylinder_settings, make_sphere_cylinder},
    Kind{"III", rotating_pin_settings, make_rotating_pin},
    Kind{"IV", orbiting_pins_settings, make_orbiting_pins},
};

const Kind& find_kind(std::string_view name) {
  const auto* const found = std::find_if(k_kinds.begin(), k_kinds.end(), [&](const Kind& k) { return k.name == name; });
  if (found == k_kinds.end()) {
    throw BadArgument(
        fmt::format("no scenario is called \"{}\"; there are {}", name, fmt::join(scenario_names(), ", ")));
  }
  return *found;
}

}  // namespace

std::string_view to_string(IdealLaw law) { return k_law_words.at(static_cast<std::size_t>(law)); }

std::vector<IdealLaw> all_ideal_laws() {
  std::vector<IdealLaw> laws;
  for (std::size_t i = 0; i < k_law_words.size(); ++i) laws.push_back(static_cast<IdealLaw>(i));
  return laws;
}

IdealLaw own_law(const Traits& traits) {
  const auto* const known = std::ranges::find(k_limits, base_name(traits.name), &Limit::algorithm);
  if (known != k_limits.end()) return known->law;
  if (traits.law == ResponseLaw::none) {
    throw BadArgument(fmt::format("{} declares no law, so \"own\" has no meaning; name a law", traits.name));
  }
  return is_of_depth(traits.law) ? IdealLaw::depth : IdealLaw::volume;
}

IdealLaw parse_ideal_law(std::string_view word, const Traits& traits) {
  if (word == "own") return own_law(traits);
  if (word == "paper") {
    if (traits.law == ResponseLaw::none) {
      throw BadArgument(fmt::format("{} declares no law, so \"paper\" has no meaning; name a law", traits.name));
    }
    return is_of_depth(traits.law) ? IdealLaw::paper_depth : IdealLaw::paper_volume;
  }
  for (const IdealLaw law : all_ideal_laws()) {
    if (to_string(law) == word) return law;
  }
  throw BadArgument(
      fmt::format("no ideal law is called \"{}\"; there are own, paper, {}", word, fmt::join(k_law_words, ", ")));
}

std::vector<double> Scenario::steps(std::size_t count) const {
  if (count < 2) throw BadArgument(fmt::format("{} steps are too few; 2 or more are needed", count));
  std::vector<double> progress(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<double>(k);
    const auto total = static_cast<double>(count);
    progress[k] = description_.closed ? (index + 0.5) / total : index / (total - 1.0);
  }
  return progress;
}

std::vector<std::string> scenario_names() {
  std::vector<std::string> names;
  for (const Kind& kind : k_kinds) names.emplace_back(kind.name);
  return names;
}

Settings scenario_settings(std::string_view name) { return find_kind(name).settings(); }

std::unique_ptr<Scenario> make_scenario(std::string_view name, const Settings& settings) {
  return find_kind(name).make(settings);
}

std::unique_ptr<Scenario> make_scenario(std::string_view name) { return make_scenario(name, scenario_settings(name)); }

Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& default_value) {
  return Parameter::number(name, meaning, "length", default_value, 1e-6, 1e6);
}

Settings settings_with_round_parts(std::vector<Parameter> parameters) {
  // Fewer than 8 facets do not approximate a circle; with 4096 a sphere has 16 million triangles.
  parameters.push_back(Parameter::count("facets", "sides of the polygon that stands for a circle", "96", 8, 4096));
  parameters.push_back(
      Parameter::choice("round", "polygons with vertices on the circle, or with the circle's area (spheres: volume)",
                        "equal_area", {"equal_area", "inscribed"}));
  return Settings(std::move(parameters));
}

RoundParts round_parts_of(const Settings& settings) {
  return settings.choice("round") == "inscribed" ? RoundParts::inscribed : RoundParts::equal_area;
}

IdealWrench descent(const IdealWrench& gradient, const OverlapMoments& moments, const Eigen::Vector3d& about) {
  const double norm = moments.gradient_norm(gradient.force, gradient.torque - about.cross(gradient.force));
  const double factor = norm > 0.0 ? moments.volume / norm : 0.0;
  return {gradient.penalty, factor * gradient.force, factor * gradient.torque};
}

void require(bool holds, const std::string& message) {
  if (!holds) throw BadArgument(message);
}

}  // namespace sixdof
