#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>

/// Motions of a pair, made from the poses of contact of its configuration set.
namespace sixdof {

/// How B moves.
enum class MotionKind {
  translation,
  rotation,  ///< About the centre of B's box.
  tumble     ///< Both: the surface of B turns as fast as its centre moves.
};

inline constexpr std::array<MotionKind, 3> k_motion_kinds{MotionKind::translation, MotionKind::rotation,
                                                          MotionKind::tumble};

/// The name as it stands in names of rows.
constexpr std::string_view to_string(MotionKind kind) {
  constexpr std::string_view k_names[] = {"translation", "rotation", "tumble"};
  return k_names[static_cast<std::size_t>(kind)];
}

/// How far B moves per step, in percent of the diagonal of A's box: from the step of a fine simulation to a flight.
inline constexpr std::array<double, 4> k_motion_steps{0.01, 1.0, 10.0, 100.0};

/// One motion for each pose of contact (distance bucket 0 of a set). B moves by `percent` of A's diagonal:
/// - towards the centre of A's box, so that the contact lies between a quarter and three quarters of the translation;
/// - one in four past A instead, across that line, starting up to a quarter of the step outside of the contact. Most
///   of these miss;
/// - a rotation turns B by the angle that moves the end of B's box by that length, from up to a quarter of the step
///   outside of the contact.
/// The same seed and poses give the same bits.
std::vector<Motion> motions_of(std::span<const Pose> contacts, const Mesh& a, const Mesh& b, MotionKind kind,
                               double percent, std::uint64_t seed);

}  // namespace sixdof
