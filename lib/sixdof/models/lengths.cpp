#include <sixdof/models/lengths.h>

#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

void check_length(const std::string& recipe, const std::string& which, double value) {
  check_shape(std::isfinite(value) && value > 0.0, recipe,
              fmt::format("{} is {}, but must be positive and finite", which, value));
}

void check_shape(bool holds, const std::string& recipe, const std::string& message) {
  if (!holds) throw BadArgument(recipe + ": " + message);
}

}  // namespace sixdof
