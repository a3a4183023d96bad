#include "bench/study/sweep.h"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

SweepPoint with(SweepPoint point, const std::string& parameter, const std::string& value) {
  point.settings.set(parameter, value);
  point.assignments.push_back(parameter + "=" + value);
  return point;
}

std::vector<SweepPoint> joint_sweep(const Algorithm& algorithm) {
  std::size_t steps = 0;
  for (const Parameter& parameter : algorithm.traits().parameters) steps = std::max(steps, parameter.sweep.size());
  std::vector<SweepPoint> points(std::max<std::size_t>(steps, 1), {algorithm.settings(), {}});
  for (std::size_t k = 0; k < steps; ++k) {
    for (const Parameter& parameter : algorithm.traits().parameters) {
      if (!parameter.sweep.empty()) points[k] = with(points[k], parameter.name, parameter.sweep[k]);
    }
  }
  return points;
}

/// Whether it has this parameter, and no parameter is swept without a word: values of one would end the joint sweep.
bool has_but_sweeps_none(const Traits& traits, const std::string& name) {
  return std::ranges::any_of(traits.parameters, [&](const Parameter& x) { return x.name == name; }) &&
         std::ranges::all_of(traits.parameters, [](const Parameter& x) { return x.sweep.empty(); });
}

}  // namespace

SweptValues parse_swept_values(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::size_t equals = text.find('=', colon == std::string::npos ? 0 : colon);
  if (colon == std::string::npos || equals == std::string::npos || equals + 1 == text.size()) {
    throw BadArgument(fmt::format("--params {}: must read ALGORITHM:NAME=VALUE,VALUE,...", text));
  }
  SweptValues swept{text.substr(0, colon), text.substr(colon + 1, equals - colon - 1), {}};
  std::istringstream words(text.substr(equals + 1));
  for (std::string value; std::getline(words, value, ',');) swept.values.push_back(value);
  return swept;
}

std::vector<SweptValues> warm_starts(const std::vector<const Algorithm*>& algorithms,
                                     const std::vector<SweptValues>& values) {
  std::vector<SweptValues> all;
  for (const Algorithm* const algorithm : algorithms) {
    const Traits& traits = algorithm->traits();
    const auto is_its = [&](const SweptValues& swept) { return swept.algorithm == traits.name; };
    if (std::ranges::none_of(values, is_its) && has_but_sweeps_none(traits, "warm_start"))
      all.push_back({traits.name, "warm_start", {"on", "off"}});
  }
  return all;
}

std::vector<SweptValues> thread_counts(const std::vector<const Algorithm*>& algorithms,
                                       const std::vector<SweptValues>& values, unsigned most) {
  std::vector<std::string> counts;
  for (unsigned count = most; count > 1; count /= 2) counts.push_back(std::to_string(count));
  counts.emplace_back("1");
  std::vector<SweptValues> all;
  for (const Algorithm* const algorithm : algorithms) {
    const Traits& traits = algorithm->traits();
    const auto has_them = [&](const SweptValues& x) { return x.algorithm == traits.name && x.parameter == "threads"; };
    if (most > 1 && std::ranges::none_of(values, has_them) && has_but_sweeps_none(traits, "threads"))
      all.push_back({traits.name, "threads", counts});
  }
  return all;
}

std::vector<SweepPoint> sweep_points(const Algorithm& algorithm, const std::vector<SweptValues>& values) {
  std::vector<SweepPoint> points{{algorithm.settings(), {}}};
  bool chosen = false;
  for (const SweptValues& swept : values) {
    if (swept.algorithm != algorithm.traits().name) continue;
    chosen = true;
    std::vector<SweepPoint> product;
    for (const SweepPoint& point : points) {
      for (const std::string& value : swept.values) product.push_back(with(point, swept.parameter, value));
    }
    points = std::move(product);
  }
  return chosen ? points : joint_sweep(algorithm);
}

}  // namespace sixdof::study
