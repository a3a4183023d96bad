#pragma once

#include <memory>
#include <string>
#include <vector>

#include <sixdof/query/settings.h>
#include <sixdof/scenario/normals.h>
#include <sixdof/scenario/plane.h>
#include <sixdof/scenario/scenario.h>
#include <sixdof/scenario/solids.h>

/// How scenario.cpp makes each kind of scenario, and what the kinds share. Internal: use scenario.h.

namespace sixdof {

Settings cone_block_settings(bool thin);
Settings sphere_cylinder_settings();
Settings rotating_pin_settings();
Settings orbiting_pins_settings();

// All throw BadArgument if the lengths contradict each other.
std::unique_ptr<Scenario> make_cone_block(const Settings& settings, bool thin);
std::unique_ptr<Scenario> make_sphere_cylinder(const Settings& settings);
std::unique_ptr<Scenario> make_rotating_pin(const Settings& settings);
std::unique_ptr<Scenario> make_orbiting_pins(const Settings& settings);

/// A length between 1e-6 and 1e6 in the meshes' unit.
Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& default_value);

/// These parameters, "facets" (a count) and "round", which round_parts_of() reads.
Settings settings_with_round_parts(std::vector<Parameter> parameters);
RoundParts round_parts_of(const Settings& settings);

/// Traction on one pin in its hole, summed over the pin's wall: force in length^3, torque about the pin's axis in
/// length^4, in the frame of the hole.
///
/// It is the integral over the pin's wall outside the hole of the distance to the block's nearest face, along the pin's
/// inward normals or (along_wall) along the outward normals of that face. The block's top and bottom are faces too and
/// are nearer than the hole's wall within the depth d of them. So a vertical line at depth d carries d (length - d)
/// along the pin's normals and d (length - 2 d) along the wall's; what top and bottom push along z cancels.
/// @param side of pin and hole; @param angle rotation of the pin, radians; @param shift of the pin's axis from the
/// hole's
PlaneWrench square_pin_traction(double side, double length, double angle, const Eigen::Vector2d& shift,
                                bool along_wall);

/// The same for a round pin of radius r in a round hole of radius r.
PlaneWrench round_pin_traction(double r, double length, const Eigen::Vector2d& shift, bool along_wall);

/// IdealLaw::descent: the gradient's wrench with the volume as its size.
/// @param moments about the point `about`, which is relative to the reference point of the torques
IdealWrench descent(const IdealWrench& gradient, const OverlapMoments& moments,
                    const Eigen::Vector3d& about = Eigen::Vector3d::Zero());

/// @throws BadArgument with this message unless `holds`
void require(bool holds, const std::string& message);

}  // namespace sixdof
