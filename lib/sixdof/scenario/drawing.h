#pragma once

#include <string>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// An SVG drawing of a scenario from its own meshes, path and ideal model: a plan (x to the right, y up, seen along -z)
/// with dimensions, and an oblique view. A is grey, B translucent blue at the progress in sketch(); the path of the
/// reference point is dashed red, the ideal force or torque of the volume law a dark blue arrow (its length has no
/// scale). The same scenario gives the same bytes.
std::string draw(const Scenario& scenario);

}  // namespace sixdof
