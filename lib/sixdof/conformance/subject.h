#pragma once

#include <iosfwd>
#include <memory>
#include <span>
#include <string>

#include <sixdof/conformance/conformance.h>
#include <sixdof/geometry/typed_pose.h>
#include <sixdof/query/algorithm.h>

namespace sixdof::conformance {

/// Kinds of query.
enum class Kind {
  collide,
  distance,
  respond
};
constexpr Kind k_kinds[] = {Kind::collide, Kind::distance, Kind::respond};

inline bool answers(const QuerySet& set, Kind kind) {
  return kind == Kind::collide ? set.collide : kind == Kind::distance ? set.distance : set.respond;
}

/// The answers of one pose, of the kinds that were asked; those of other kinds are unsupported.
struct Answers {
  Outcome<bool> collide;
  Outcome<Separation> distance;
  Outcome<Response> respond;
  std::string words;  ///< Of the last failure.

  Status status(Kind kind) const {
    return kind == Kind::collide ? collide.status : kind == Kind::distance ? distance.status : respond.status;
  }
};

/// The algorithm under test with what it claims.
struct Subject {
  /// @throws BadArgument for settings that the algorithm does not have
  Subject(std::unique_ptr<Algorithm> made, Declaration declaration);

  std::unique_ptr<Algorithm> algorithm;
  Declaration declared;
  Settings settings;  ///< Default ones with those of the declaration.

  const Traits& traits() const { return algorithm->traits(); }
  bool answers(Kind kind) const { return conformance::answers(traits().answers, kind); }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b) const;
  /// Asks all kinds that the algorithm answers. What is thrown counts as failed, an answer with a NaN as non_finite.
  Answers ask(Query& query, const Pose& X_AB) const;
  /// The same of one kind, whether the algorithm answers it or not.
  Answers ask(Query& query, Kind kind, const Pose& X_AB) const;
};

/// Where a check failed: meshes, pose and a command line that asks the same. A mesh that is no model of the catalogue
/// is written to a file for it. To be streamed into the message of an assertion.
struct At {
  const Subject& subject;
  const Mesh& a;
  const Mesh& b;
  const TypedPose& pose;
};
std::ostream& operator<<(std::ostream& out, const At& at);

/// Largest relative difference of two wrenches about one point: of forces by |x.force|, of torques by |x.force| length.
/// 0 if both are zero; infinite if only x is.
double wrench_difference(const Response& x, const Response& y, double length);

/// Angle in degrees, exact for small ones.
double angle_between(const Eigen::Vector3d& x, const Eigen::Vector3d& y);

/// Whether every kind that the algorithm answers has an answer; fails with the words if not.
bool expect_answered(const Subject& subject, const Answers& answers, const At& at);

/// Two answers of one pose must agree within Declaration::repeat_error.
void expect_repeated(const Subject& subject, const Answers& first, const Answers& again, const At& at);

/// One check of the kit.
struct Check {
  const char* name;
  /// Whether it applies to an algorithm that answers these kinds.
  bool (*applies)(const QuerySet&);
  /// Fails by GoogleTest's assertions.
  void (*run)(const Subject&);
};

inline bool always(const QuerySet&) { return true; }
inline bool if_collide(const QuerySet& set) { return set.collide; }
inline bool if_distance(const QuerySet& set) { return set.distance; }
inline bool if_respond(const QuerySet& set) { return set.respond; }

std::span<const Check> agreement_checks();   ///< With the oracles.
std::span<const Check> invariance_checks();  ///< What must not change the answers.
std::span<const Check> state_checks();       ///< Statuses, repetition, threads, lifetimes.

}  // namespace sixdof::conformance
