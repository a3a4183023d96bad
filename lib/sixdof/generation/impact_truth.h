#pragma once

#include <memory>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/oracle/advancement.h>

namespace sixdof {

/// A bracket, and how it was found.
struct TrueImpact {
  ImpactBracket bracket;
  bool by_ray_cast = false;       ///< The advancement began where a ray cast ended.
  double residual = 0.0;          ///< Of the ray cast: |distance - target| at its hit (length).
  double clearance_at_end = 0.0;  ///< Distance of the surfaces at the end of the motion (length).
};

/// When two bodies first touch. Translations along a line through the centre of A's box, as those of a configuration
/// set are, take the ray cast's hit: up to there the bodies are apart by k_contact_target of A's diagonal, and the
/// advancement (oracle/advancement.h) goes on from there. All other motions are advanced from their start. One object
/// per thread; both meshes outlive it.
class ImpactTruth {
 public:
  /// @throws BadMesh as Tree does
  ImpactTruth(const Mesh& a, const Mesh& b);
  ~ImpactTruth();

  /// @throws BadArgument if the motion cannot be computed
  TrueImpact find(const Motion& motion);

  /// Distance of the surfaces at a time of the motion (length).
  double distance_at(const Motion& motion, double t);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sixdof
