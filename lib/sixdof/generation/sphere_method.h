#pragma once

#include <memory>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// How B comes in.
enum class SphereMarch {
  certified,     ///< By steps as long as can be certified; a narrower target goes on from where a wider one was met.
  conservative,  ///< By the distance less the target and no farther; every target alone, from outside.
};

/// The paper's sphere method on top of any distance oracle: B comes from outside and stops where the target is met for the
/// first time.
///
/// Steps are as long as can be certified to skip no hit. Let f(s) be the distance at translation s. Two facts bound it:
/// - |f(s) - f(s')| <= |s - s'|, since B moves by |s - s'| (conservative advancement; Mirtich 1996);
/// - f(s)^2 - s^2 is concave, as the least over all pairs of points (p on A, q on B) of a linear function of s. So
///   between two measurements f^2 lies above the parabola with leading coefficient 1 through both.
/// The second makes a Newton step from the witnesses certain in one further measurement wherever the target is not small
/// against the step, so a configuration costs a handful of measurements instead of dozens.
///
/// That is SphereMarch::certified. SphereMarch::conservative is plain conservative advancement, on the first fact
/// alone: what other ways are compared with. It takes dozens of measurements for each configuration, and many more
/// where B grazes A.
///
/// Below k_first_hit_resolution gaps are not looked into: a hit and its loss again within that length of translation may be
/// passed over by certified steps; conservative ones pass over nothing.
/// @param algorithm measures the distances with its default settings. They have to be exact and depend on the pose alone,
/// to the last bit. It outlives the generator.
/// @throws BadArgument if it answers no distance queries
std::unique_ptr<DistanceGenerator> make_sphere_method(const Algorithm& algorithm,
                                                      SphereMarch march = SphereMarch::certified);

/// In units of A's box diagonal. A feature that lets the distance dip below the target for so short a translation dips by at
/// most half of it.
constexpr double k_first_hit_resolution = 1e-6;

}  // namespace sixdof
