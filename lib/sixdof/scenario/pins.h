#pragma once

#include <memory>

#include <sixdof/scenario/scenario.h>

/// Scenarios III and IV: a plate with a square and a round pin, and a block with the matching holes.
///
/// A's frame: the block's top is z = 0, its middle on the z axis; square hole at (-b/4, 0), round hole at (+b/4, 0).
/// B's frame is the same for the plate, whose underside lies ON the block's top along both paths: a superfluous contact
/// that must not act. README.md derives the ideal models.

namespace sixdof {

/// Scenario III: only the square pin is in its hole, and rotates about its own axis.
///
/// X_AB rotates by pi - phi about the square hole's axis, phi = 0 .. rotation_degrees: at pi the round pin is outside
/// the block. The rotation is clockwise, so that the torque that reverses it points along +z, as in the paper.
/// Reference: middle of the square pin.
Settings rotating_pin_settings();

/// @throws BadArgument
std::unique_ptr<Scenario> make_rotating_pin(const Settings& settings);

/// Scenario IV: both pins are in their holes, and move along a small circle without rotation.
///
/// X_AB is the translation by orbit_radius (cos 2 pi s, sin 2 pi s, 0). Reference: between the pins, at the middle of
/// their length.
Settings orbiting_pins_settings();

/// @throws BadArgument
std::unique_ptr<Scenario> make_orbiting_pins(const Settings& settings);

}  // namespace sixdof
