#pragma once

#include <memory>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// Scenario II: a sphere moves around a cylinder at a constant depth, without rotation.
///
/// A's frame: the cylinder's axis is z, its middle the origin. B's frame: the sphere's centre is the origin, which is
/// also the reference point. Pose: translation by orbit * (cos 2 pi s, sin 2 pi s, 0). README.md derives the ideal
/// models.
Settings sphere_cylinder_settings();

/// @throws BadArgument
std::unique_ptr<Scenario> make_sphere_cylinder(const Settings& settings);

}  // namespace sixdof
