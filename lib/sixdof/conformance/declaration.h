#pragma once

#include <limits>
#include <string>
#include <vector>

namespace sixdof::conformance {

/// What yes/no answers for.
enum class Meaning {
  surfaces,  ///< No where one body is inside the other and the surfaces have no point in common.
  bodies     ///< Yes there, if both meshes are solid.
};

/// A check that an algorithm fails for a known reason. It runs nonetheless, and fails if the algorithm passes it.
struct KnownFailure {
  std::string check;   ///< As README.md lists it: "ScaleOfCollide".
  std::string reason;  ///< In words.
  std::string issue;   ///< Where it is reported upstream; empty if nowhere.
};

/// An error that is not checked.
inline constexpr double k_no_claim = std::numeric_limits<double>::infinity();

/// What an algorithm claims. The defaults are those of an exact algorithm in double precision that sees surfaces only.
///
/// Poses are clear: the surfaces are apart by 2 % of A's box diagonal at least, or the bodies overlap by 5 % of the
/// smaller one's volume at least, or one is inside the other. So yes/no has no tolerance.
struct Declaration {
  std::vector<std::string> settings = {};  ///< "parameter=value", for all checks. @see Settings::set_all()
  Meaning collide = Meaning::surfaces;     ///< Of yes/no. Responses are judged where the surfaces meet only.
  /// Whether meshes with a border are taken; if not, prepare() refuses them by BadMesh.
  bool open_meshes = true;

  double distance_error = 1e-12;  ///< Largest |distance - exact one|, in diagonals of A's box.
  double witness_error = 1e-12;   ///< Largest distance of a witness from its surface, likewise.
  double volume_error = 1e-9;     ///< Largest error of a response's volume, |volume - exact one| by the exact one.
  /// Largest mean angle between forces and minus the gradients of the intersection volume, in degrees.
  double force_degrees = 1e-4;

  /// Largest difference of a time of impact from the true one, early or late, as a part of the motion.
  double cast_error = 1e-9;

  // Of contacts nothing is claimed by default: those of pairs of triangles differ from those of bodies.
  double contact_error = k_no_claim;    ///< Largest distance of a point from being in both bodies, in A's diagonals.
  double contact_degrees = k_no_claim;  ///< Largest mean angle of the normals of a pose to true ones, none reversed.
  /// Largest error of the sum of depths, by the sum of thicknesses (JudgedContact::thickness).
  double depth_error = k_no_claim;
  /// Largest angle between the mean normals of (A, B) and of (B, A), and before and after a rigid motion of both.
  double contact_change_degrees = k_no_claim;

  // Largest difference of two wrenches that should be the same: of the forces by the force, of the torques by the
  // force times A's diagonal.
  double order_error = 1e-9;   ///< Asked for (A, B), and for (B, A) with the inverse pose.
  double motion_error = 1e-9;  ///< Before and after rigid motions of both meshes.
  double scale_error = 1e-9;   ///< Of meshes 1000 times smaller and larger; a force may grow with any whole power.
  /// The same pose again, after others: of wrenches as above, of distances in diagonals of A's box. 0: the same bits.
  /// An algorithm with a warm start may need the size of roundings.
  double repeat_error = 0.0;

  std::vector<KnownFailure> known_failures = {};  ///< Checks that are expected to fail.
};

/// Sets a member of the declaration by its name, as typed: "collide" to "surfaces" or "bodies", "open_meshes" to "yes"
/// or "no", one of the errors to a number that is not negative, or to "none" (k_no_claim).
/// @throws BadArgument for another name or value
void set_claim(Declaration& declaration, const std::string& name, const std::string& value);

}  // namespace sixdof::conformance
