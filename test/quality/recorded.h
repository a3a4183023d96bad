#pragma once

#include <memory>
#include <optional>
#include <string>

#include <sixdof/scenario/evaluation.h>

#include "bounds.h"

namespace sixdof {

/// An algorithm's responses along a scenario's path, with what made them.
struct Recorded {
  std::unique_ptr<Scenario> scenario;
  Settings settings;
  std::unique_ptr<Query> query;
  Recording recording;
};

/// Prepared and recorded once per process. @param algorithm see subject()
const Recorded& recorded(const std::string& scenario, const std::string& algorithm);

/// The measure of `bound` for a recording of its scenario; none if it is undefined there. Jumps, for which queries are
/// asked again, are left out.
std::optional<double> measured(const Bound& bound, const Recording& recording);

/// "Ia_vps_depth_sigma_F": letters, digits and '_' only, as GoogleTest needs it.
std::string test_name(std::initializer_list<std::string_view> parts);

}  // namespace sixdof
