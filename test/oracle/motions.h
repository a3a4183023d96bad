#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/advancement.h>
#include <sixdof/oracle/cast_search.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/translation_cast.h>

#include "../geometry/shapes.h"
#include "distance_truth.h"

/// Moving bodies, and when they touch by sampling, shared by tests.
namespace sixdof::motions {

/// Two meshes with both methods.
struct Bodies {
  const Mesh& a;
  const Mesh& b;
  DistanceOracle oracle{a, b};
  DistanceQuery query{oracle};
  CastSearch search{oracle.tree_a(), oracle.tree_b()};
  TranslationCast translations{oracle.tree_a(), oracle.tree_b()};

  Bodies(const Mesh& fixed, const Mesh& moving) : a(fixed), b(moving) {}

  /// What `exact` answers.
  Outcome<Impact> cast(const Motion& motion) {
    if (const auto apart = translations.find(motion)) {
      return apart->next ? search.find_after(motion, apart->t, *apart->next) : Impact{};
    }
    if (query.collide(motion.start)) return Impact{.hit = true};
    return search.find(motion);
  }
  ImpactBracket bracket(const Motion& motion) { return advance(query, b.box(), motion); }
};

/// From a few diagonals away, usually towards A: translations (kind 0), rotations (1) about a point inside A or near
/// it, tumbling flights (2).
inline Motion random_motion(const Mesh& a, const Mesh& b, shapes::Generator& generator, int kind) {
  using shapes::uniform;
  const double size = 0.5 * (a.diagonal() + b.diagonal());
  const Eigen::Vector3d away = shapes::unit_vector(generator);
  Pose start = shapes::random_pose(generator, 0.0);
  start.t = a.center() + size * uniform(generator, 0.8, 2.0) * away - start.R * b.center();
  const Eigen::Vector3d goal = a.center() + shapes::uniform_vector(generator, 0.4 * size);
  Motion motion = Motion::of(b, start, uniform(generator, 0.8, 2.0) * (goal - start * b.center()));
  const double angle = uniform(generator, 0.0, kind == 1 ? 6.0 : 9.0);
  if (kind != 0) motion.rotation = angle * shapes::unit_vector(generator);
  if (kind == 1) {
    motion.translation.setZero();
    motion.reference = start.inverse() * Eigen::Vector3d(goal + 0.5 * size * shapes::unit_vector(generator));
  }
  return motion;
}

/// Whether any two triangles have a point in common.
inline bool touches(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  for (std::size_t j = 0; j < b.triangles().size(); ++j) {
    const TriangleCorners q = distance_truth::corners_of(b, j, X_AB);
    for (std::size_t i = 0; i < a.triangles().size(); ++i) {
      if (triangles_intersect(distance_truth::corners_of(a, i), q)) return true;
    }
  }
  return false;
}

/// The first of `samples` equal steps at which the surfaces touch, by brute force; none if there is none.
inline std::optional<double> first_touching_sample(const Mesh& a, const Mesh& b, const Motion& motion, int samples) {
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    if (touches(a, b, motion.pose_at(t))) return t;
  }
  return {};
}

}  // namespace sixdof::motions
