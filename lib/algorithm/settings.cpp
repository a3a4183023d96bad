#include <sixdof/algorithm/settings.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Whole-text parse, independent of the locale; NaN if it is no number.
double parse_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? value : std::nan("");
}

void check(const Knob& knob, const std::string& text) {
  if (!knob.choices.empty()) {
    if (std::find(knob.choices.begin(), knob.choices.end(), text) == knob.choices.end()) {
      throw BadArgument(fmt::format("{}={}: must be one of {}", knob.name, text, fmt::join(knob.choices, ", ")));
    }
    return;
  }
  const double value = parse_number(text);
  if (!(value >= knob.low && value <= knob.high)) {
    throw BadArgument(fmt::format("{}={}: must be a number from {} to {}", knob.name, text, knob.low, knob.high));
  }
  if (knob.integer && value != std::floor(value)) {
    throw BadArgument(fmt::format("{}={}: must be a whole number", knob.name, text));
  }
}

}  // namespace

Settings::Settings(std::vector<Knob> knobs) : knobs_(std::move(knobs)) {
  for (const Knob& knob : knobs_) {
    check(knob, knob.standard);
    values_[knob.name] = knob.standard;
  }
}

const Knob& Settings::find(const std::string& knob) const {
  const auto found = std::find_if(knobs_.begin(), knobs_.end(), [&](const Knob& k) { return k.name == knob; });
  if (found != knobs_.end()) return *found;
  std::vector<std::string> names;
  for (const Knob& k : knobs_) names.push_back(k.name);
  throw BadArgument(names.empty() ? fmt::format("{}: this algorithm has no knobs", knob)
                                  : fmt::format("{}: no such knob; there are {}", knob, fmt::join(names, ", ")));
}

void Settings::set(const std::string& knob, const std::string& text) {
  check(find(knob), text);
  values_[knob] = text;
}

void Settings::set_all(const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw BadArgument(fmt::format("{}: must read knob=value", assignment));
    set(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
}

double Settings::number(const std::string& knob) const {
  find(knob);
  return parse_number(values_.at(knob));
}

const std::string& Settings::choice(const std::string& knob) const {
  find(knob);
  return values_.at(knob);
}

std::string Settings::to_string() const {
  std::vector<std::string> parts;
  for (const Knob& knob : knobs_) parts.push_back(knob.name + "=" + values_.at(knob.name));
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string Settings::differences() const {
  std::vector<std::string> parts;
  for (const Knob& knob : knobs_) {
    if (values_.at(knob.name) != knob.standard) parts.push_back(knob.name + "=" + values_.at(knob.name));
  }
  return fmt::format("{}", fmt::join(parts, ","));
}

}  // namespace sixdof
