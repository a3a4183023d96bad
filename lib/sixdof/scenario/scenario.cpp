#include <sixdof/scenario/scenario.h>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/scenario/cone_block.h>
#include <sixdof/scenario/pins.h>
#include <sixdof/scenario/sphere_cylinder.h>

namespace sixdof {
namespace {

void check_name(std::string_view name) {
  const auto& names = scenario_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw BadArgument(fmt::format("no scenario is called \"{}\"; there are {}", name, fmt::join(names, ", ")));
  }
}

}  // namespace

std::string_view to_string(IdealLaw law) {
  switch (law) {
    case IdealLaw::depth:
      return "depth";
    case IdealLaw::volume:
      return "volume";
    case IdealLaw::gradient:
      return "gradient";
    case IdealLaw::energy:
      return "energy";
    case IdealLaw::traction:
      return "traction";
    case IdealLaw::wall_traction:
      return "wall-traction";
    case IdealLaw::paper_depth:
      return "paper-depth";
    case IdealLaw::paper_volume:
      return "paper-volume";
  }
  return "unknown";
}

std::vector<IdealLaw> all_ideal_laws() {
  return {IdealLaw::depth,    IdealLaw::volume,        IdealLaw::gradient,    IdealLaw::energy,
          IdealLaw::traction, IdealLaw::wall_traction, IdealLaw::paper_depth, IdealLaw::paper_volume};
}

IdealLaw parse_ideal_law(std::string_view word, ResponseLaw own) {
  if (word == "paper" || word == "own") {
    if (own == ResponseLaw::none) {
      throw BadArgument(fmt::format("the algorithm declares no law, so \"{}\" means none; name one", word));
    }
    if (word == "own") return own == ResponseLaw::depth ? IdealLaw::depth : IdealLaw::volume;
    return own == ResponseLaw::depth ? IdealLaw::paper_depth : IdealLaw::paper_volume;
  }
  std::vector<std::string_view> words{"own", "paper"};
  for (const IdealLaw law : all_ideal_laws()) {
    if (to_string(law) == word) return law;
    words.push_back(to_string(law));
  }
  throw BadArgument(fmt::format("no ideal law is called \"{}\"; there are {}", word, fmt::join(words, ", ")));
}

std::vector<double> Scenario::stamps(std::size_t count) const {
  if (count < 2) throw BadArgument(fmt::format("{} time stamps are too few; 2 or more are needed", count));
  std::vector<double> progress(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<double>(k);
    const auto total = static_cast<double>(count);
    progress[k] = closed() ? (index + 0.5) / total : index / (total - 1.0);
  }
  return progress;
}

const std::vector<std::string>& scenario_names() {
  static const std::vector<std::string> names{"Ia", "Ib", "II", "III", "IV"};
  return names;
}

Settings scenario_settings(std::string_view name) {
  check_name(name);
  if (name == "Ia" || name == "Ib") return cone_block_settings(name == "Ib");
  if (name == "II") return sphere_cylinder_settings();
  return pins_settings(name == "III" ? PinsPath::turn : PinsPath::orbit);
}

std::unique_ptr<Scenario> make_scenario(std::string_view name, const Settings& settings) {
  check_name(name);
  if (name == "Ia" || name == "Ib") return make_cone_block(settings, name == "Ib");
  if (name == "II") return make_sphere_cylinder(settings);
  return make_pins(settings, name == "III" ? PinsPath::turn : PinsPath::orbit);
}

std::unique_ptr<Scenario> make_scenario(std::string_view name) { return make_scenario(name, scenario_settings(name)); }

}  // namespace sixdof
