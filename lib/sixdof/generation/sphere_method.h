#pragma once

#include <memory>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// How B moves along a ray.
enum class SphereMarch {
  certified,     ///< By the longest certified steps; each target continues where the larger one before it was met.
  conservative,  ///< By the distance less the target (conservative advancement); every target alone, from outside.
};

/// The paper's sphere method on top of a distance algorithm: B moves from outside towards A and stops where the target
/// is met for the first time.
///
/// Steps are as long as is certain to pass no hit. Let f(s) be the distance at translation s. Two facts bound it:
/// - |f(s) - f(s')| <= |s - s'|, since B moves by |s - s'| (conservative advancement; Mirtich 1996);
/// - f(s)^2 - s^2 is concave: it is the minimum over all pairs of points (p on A, q on B) of a linear function of s. So
///   between two measurements f^2 lies above the parabola with leading coefficient 1 through both.
/// SphereMarch::certified uses both. By the second, one further measurement certifies a Newton step from the witnesses
/// wherever the target is not small against the step. SphereMarch::conservative uses the first alone and needs many
/// more measurements, most of all where B grazes A.
///
/// Certified steps may pass a hit that begins and ends within k_first_hit_resolution; conservative ones pass none.
/// @param algorithm measures the distances, with its default settings. They have to be exact and depend on the pose
/// alone, in every bit. It outlives the generator.
/// @throws BadArgument if it answers no distance queries
std::unique_ptr<DistanceGenerator> make_sphere_method(const Algorithm& algorithm,
                                                      SphereMarch march = SphereMarch::certified);

/// In units of the diagonal of A's box. The distance falls below the target by at most half of it in a hit so short.
constexpr double k_first_hit_resolution = 1e-6;

}  // namespace sixdof
