#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <sixdof/conformance/declaration.h>
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

constexpr const char* to_string(Kind kind) {
  return kind == Kind::collide ? "collide" : kind == Kind::distance ? "distance" : "respond";
}

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

/// How a user asks what a check asked.
struct Commands {
  std::string program = "sixdof";  ///< One that knows the algorithm.
  std::string options = {};        ///< Behind all others, with a space before: " --external 'mine=python3 mine.py'".
  /// Where meshes that are no models of the catalogue are written; made when the first one is.
  std::filesystem::path folder = {};
};

/// The algorithm under test with what it claims.
struct Subject {
  /// @param asked outlives the subject
  /// @throws BadArgument for settings that the algorithm does not have
  Subject(const Algorithm& asked, Declaration declaration, Commands how);

  const Algorithm& algorithm;
  Declaration declared;
  Commands commands;
  Settings settings;  ///< Default ones with those of the declaration.

  const Traits& traits() const { return algorithm.traits(); }
  bool answers(Kind kind) const { return conformance::answers(traits().answers, kind); }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b) const;
  /// Asks all kinds that the algorithm answers. What is thrown counts as failed, an answer with a NaN as non_finite.
  Answers ask(Query& query, const Pose& X_AB) const;
  /// The same of one kind, whether the algorithm answers it or not.
  Answers ask(Query& query, Kind kind, const Pose& X_AB) const;
};

/// Where a check asked.
struct At {
  const Subject& subject;
  const Mesh& a;
  const Mesh& b;
  const TypedPose& pose;
};

/// "torus-300 (A), cone-100 (B)"
std::string meshes_of(const At& at);

/// `sixdof query ...`, which asks the same. A mesh that is no model of the catalogue is written to a file for it.
std::string command_of(const At& at);

}  // namespace sixdof::conformance
