#pragma once

#include <memory>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

enum class PinsPath {
  turn,   ///< III: only the square pin is in its hole, and turns about its own axis.
  orbit,  ///< IV: both pins are in their holes, and are carried round a small circle without turning.
};

/// Scenarios III and IV: a plate with a square and a round pin in a block with the matching holes.
///
/// A's frame: the block's top is z = 0, its middle on the z axis; square hole at (-b/4, 0), round hole at (+b/4, 0).
/// B's frame is the same for the plate, whose underside lies ON the block's top all along both paths: a superfluous
/// contact that must not act. README.md derives the ideal models.
///
/// III: X_AB turns by pi - phi about the square hole's axis, phi = 0 .. turn_degrees: at pi the round pin stands
/// outside the block. The turn is clockwise, so that the torque that undoes it points along +z, as the paper has it.
/// Reference: middle of the square pin. IV: translation by orbit_radius (cos 2 pi s, sin 2 pi s, 0). Reference: between
/// the pins, at the middle of their length.
Settings pins_settings(PinsPath path);

/// @throws BadArgument
std::unique_ptr<Scenario> make_pins(const Settings& settings, PinsPath path);

}  // namespace sixdof
