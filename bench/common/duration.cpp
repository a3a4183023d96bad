#include "bench/common/duration.h"

#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr std::pair<std::string_view, double> k_units[] = {{"ns", 1e-9}, {"us", 1e-6},  {"ms", 1e-3},
                                                           {"s", 1.0},   {"min", 60.0}, {"h", 3600.0}};

}  // namespace

double parse_duration(std::string_view option, const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc()) {
    for (const auto& [unit, seconds] : k_units) {
      if (std::string_view(stop, static_cast<std::size_t>(end - stop)) != unit) continue;
      if (std::isfinite(number) && number > 0.0) return number * seconds;
    }
  }
  throw BadArgument(fmt::format(
      "{} {}: must be a positive time with its unit (ns, us, ms, s, min, h), as 0.9ms or 10min", option, text));
}

std::string duration_text(double seconds) {
  const std::pair<std::string_view, double>* best = &k_units[0];
  for (const auto& unit : k_units) {
    // What three digits show as 1000 ns is 1 us.
    if (seconds >= (1.0 - 5e-4) * unit.second) best = &unit;
  }
  return fmt::format("{:.3g} {}", seconds / best->second, best->first);
}

}  // namespace sixdof
