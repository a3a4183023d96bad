#pragma once

#include <memory>

#include <sixdof/configuration/distance_generator.h>
#include <sixdof/configuration/distance_source.h>

namespace sixdof {

/// How B comes in.
enum class SphereMarch {
  certified,     ///< By steps as long as can be certified; a narrower aim goes on from where a wider one was met.
  conservative,  ///< By the distance less the aim and no farther; every aim alone, from outside.
};

/// The paper's sphere method on top of any distance oracle: B comes from outside and stops where the aim is met for the
/// first time.
///
/// Steps are as long as can be certified to skip no hit. Let f(s) be the distance at travel s. Two facts bound it:
/// - |f(s) - f(s')| <= |s - s'|, since B moves by |s - s'| (conservative advancement; Mirtich 1996);
/// - f(s)^2 - s^2 is concave, as the least over all pairs of points (p on A, q on B) of a linear function of s. So
///   between two measurements f^2 lies above the parabola with leading coefficient 1 through both.
/// The second makes a Newton step from the witnesses certain in one further measurement wherever the aim is not small
/// against the step, so a configuration costs a handful of measurements instead of dozens.
///
/// That is SphereMarch::certified. SphereMarch::conservative is plain conservative advancement, on the first fact
/// alone: what other ways are compared with. It takes dozens of measurements for each configuration, and many more
/// where B grazes A.
///
/// Below k_first_hit_resolution gaps are not looked into: a hit and its loss again within that length of travel may be
/// passed over by certified steps; conservative ones pass over nothing.
std::unique_ptr<DistanceGenerator> make_sphere_method(std::shared_ptr<const DistanceSource> oracle,
                                                      SphereMarch march = SphereMarch::certified);

/// In units of A's box diagonal. A feature that lets the distance dip below the aim for so short a travel dips by at
/// most half of it.
constexpr double k_first_hit_resolution = 1e-6;

}  // namespace sixdof
