#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>

/// The conformance kit: GoogleTest cases that hold an algorithm to the rules of query/README.md. A test program links
/// sixdof::conformance and GTest::gtest_main, and has a line per algorithm:
///
///     SIXDOF_CONFORMANCE("mine", {.distance_error = 1e-9});                  // made by a Registrar of the program
///     SIXDOF_CONFORMANCE(make_my_algorithm, {.collide = Meaning::bodies});   // made by a function
///
/// The cases are called `Algorithms/Conformance.Of/NAME_CHECK`, with '_' for the '-' of the name; README.md lists the
/// checks. A message names the meshes and the pose, and ends with a line `sixdof query ...` that asks the same.

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
  double volume_error = 1e-9;     ///< Largest |Response::volume - exact one| by the exact one.
  /// Largest mean angle between forces and minus the gradients of the intersection volume, in degrees.
  double force_degrees = 1e-4;

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

/// Where the algorithm comes from: the name of one that a Registrar of the program makes, or a function.
class Source {
 public:
  /// An algorithm that a Registrar makes.
  Source(const char* name) : name_(name) {}  // NOLINT(google-explicit-constructor): reads as a value
  /// One that a function makes.
  template <class Make>
  requires std::is_invocable_r_v<std::unique_ptr<Algorithm>, Make> Source(Make maker)
      : make_(std::move(maker)) {}  // NOLINT(google-explicit-constructor)

  /// @throws BadArgument if no Registrar makes an algorithm of the name
  std::unique_ptr<Algorithm> make() const;

 private:
  std::string name_;
  std::function<std::unique_ptr<Algorithm>()> make_;
};

/// Adds the cases of one algorithm, before main(). Nothing is made until GoogleTest begins.
bool add_algorithm(Source source, Declaration declaration = {});

/// Names of all checks.
std::vector<std::string> check_names();

}  // namespace sixdof::conformance

/// Joins two words; for SIXDOF_CONFORMANCE alone.
#define SIXDOF_CONFORMANCE_JOIN_(a, b) a##b
/// A name for each use; for SIXDOF_CONFORMANCE alone.
#define SIXDOF_CONFORMANCE_NAME_(number) SIXDOF_CONFORMANCE_JOIN_(k_sixdof_conformance_, number)

/// At namespace scope: SIXDOF_CONFORMANCE(source) or SIXDOF_CONFORMANCE(source, {members of a Declaration}).
#define SIXDOF_CONFORMANCE(source, ...)                                      \
  [[maybe_unused]] static const bool SIXDOF_CONFORMANCE_NAME_(__COUNTER__) = \
      ::sixdof::conformance::add_algorithm(source __VA_OPT__(, ) __VA_ARGS__)
