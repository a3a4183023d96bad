#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/query/algorithm.h>
#include <sixdof/stability/judge.h>

/// The generators of configuration sets on hard cases: the ray through each shot's pose is solved for some targets, and
/// the translations found are checked against the definition of a configuration.
namespace sixdof::stability {

/// What a generator solves for.
enum class TargetKind {
  distance,  ///< By ray cast.
  volume     ///< By the overlap oracle; the bodies are solids.
};

/// A ray of a shot, with targets.
struct RayProblem {
  Eigen::Vector3d direction;    ///< Unit vector in A's frame: from A's box centre to B's.
  std::vector<double> targets;  ///< In the order that RaySolver::solve() takes.
};

/// A generator in a list of algorithms. It answers no query: what it finds on rays is judged.
class RayAlgorithm final : public Algorithm {
 public:
  /// Makes a solver for two meshes that outlive it.
  using MakeSolver = std::function<std::unique_ptr<RaySolver>(const Mesh& a, const Mesh& b)>;

  explicit RayAlgorithm(TargetKind kind);
  /// With a solver of the caller's choice. @param name see Traits::name
  RayAlgorithm(TargetKind kind, std::string name, MakeSolver make_solver);

  const Traits& traits() const override { return traits_; }
  TargetKind kind() const { return kind_; }

  /// @throws BadArgument always
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override;

  /// The ray of a shot. Where the box centres are in one place its direction is a fixed one of the first shot.
  /// @param first sets the targets: of distances 20 % and 1 % of the diagonal of A's box and contact, of volumes 1 %
  /// and 50 % of the smaller body's volume
  RayProblem problem(const Shot& first, const Shot& shot) const;

  /// Each target must be met at the translation that is found, and nowhere farther out; where none is found, nowhere.
  /// The translations of shots that are tied by Relation::same must be the same. Lengths are those of
  /// reference_distance(), volumes those of overlap_volume_by_columns(), divided by the area that may move. Meshes of
  /// more than 40,000 pairs of triangles are timed only.
  /// @param asks is told the pose on the ray far outside, before a ray is solved
  Judgement judge_rays(const Case& member, const std::function<void(const Pose& X_AB)>& asks) const;

 private:
  TargetKind kind_;
  MakeSolver make_solver_;
  Traits traits_;
};

}  // namespace sixdof::stability
