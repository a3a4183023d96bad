#include <sixdof/query/settings.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Whole-text parse, independent of the locale; NaN if it is not a number.
double parse_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? value : std::nan("");
}

void check(const Parameter& parameter, const std::string& text) {
  if (!parameter.choices.empty()) {
    if (std::find(parameter.choices.begin(), parameter.choices.end(), text) == parameter.choices.end()) {
      throw BadArgument(
          fmt::format("{}={}: must be one of {}", parameter.name, text, fmt::join(parameter.choices, ", ")));
    }
    return;
  }
  const double value = parse_number(text);
  if (!(value >= parameter.low && value <= parameter.high)) {
    throw BadArgument(
        fmt::format("{}={}: must be a number from {} to {}", parameter.name, text, parameter.low, parameter.high));
  }
  if (parameter.integer && value != std::floor(value)) {
    throw BadArgument(fmt::format("{}={}: must be a whole number", parameter.name, text));
  }
}

}  // namespace

Settings::Settings(std::vector<Parameter> parameters) : parameters_(std::move(parameters)) {
  for (const Parameter& parameter : parameters_) {
    check(parameter, parameter.default_value);
    for (const std::string& value : parameter.sweep) check(parameter, value);
    values_.push_back(parameter.default_value);
  }
}

std::size_t Settings::find(const std::string& parameter) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i].name == parameter) return i;
    names.push_back(parameters_[i].name);
  }
  throw BadArgument(names.empty()
                        ? fmt::format("{}: this algorithm has no parameters", parameter)
                        : fmt::format("{}: no such parameter; there are {}", parameter, fmt::join(names, ", ")));
}

void Settings::set(const std::string& parameter, const std::string& text) {
  const std::size_t i = find(parameter);
  check(parameters_[i], text);
  values_[i] = text;
}

void Settings::set_all(const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw BadArgument(fmt::format("{}: must read parameter=value", assignment));
    set(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
}

double Settings::number(const std::string& parameter) const { return parse_number(choice(parameter)); }

const std::string& Settings::choice(const std::string& parameter) const { return values_[find(parameter)]; }

std::string Settings::to_string() const {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < values_.size(); ++i) parts.push_back(parameters_[i].name + "=" + values_[i]);
  return fmt::format("{}", fmt::join(parts, ","));
}

}  // namespace sixdof
