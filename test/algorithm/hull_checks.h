#pragma once

#include <sixdof/oracle/convex_hull.h>

#include "contact_checks.h"

/// What every algorithm is checked for that answers for convex hulls.

namespace sixdof::test {

/// Yes/no as `exact` says of the hulls where these are clearly apart or clearly overlap, in both orders.
inline void expect_answers_for_hulls(const Algorithm& algorithm, const std::vector<std::string>& parameters = {}) {
  const Mesh a = load_model("torus-1k"), b = load_model("cone-1k");
  const Mesh hull_a = convex_hull(a), hull_b = convex_hull(b);
  const auto exact = make_exact_algorithm();
  const auto truth = prepare(*exact, hull_a, hull_b);
  const auto ab = prepare(algorithm, a, b, parameters), ba = prepare(algorithm, b, a, parameters);
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> reach(0.1, 0.9);
  int apart = 0, overlapping = 0;
  while (apart + overlapping < 200) {
    const Pose X_AB = generic_pose(random, reach(random) * a.diagonal());
    const double distance = truth->distance(X_AB).value.distance;
    const bool overlap = truth->respond(X_AB).value.volume > 1e-4 * hull_a.volume();
    if (!overlap && distance < 1e-3 * a.diagonal()) continue;
    EXPECT_EQ(ab->collide(X_AB).value, overlap);
    EXPECT_EQ(ba->collide(X_AB.inverse()).value, overlap);
    (overlap ? overlapping : apart)++;
  }
  EXPECT_GT(apart, 40);
  EXPECT_GT(overlapping, 40);
}

/// A ball in the hole of a torus.
inline void expect_yes_where_meshes_are_apart(const Algorithm& algorithm,
                                              const std::vector<std::string>& parameters = {}) {
  const Mesh torus = load_model("torus-1k"), ball = sphere_solid(0.2, 12, RoundParts::inscribed, "ball");
  const Pose in_the_hole{Eigen::Matrix3d::Identity(), {0.05, 0.03, 0.02}};
  EXPECT_FALSE(prepare(*make_exact_algorithm(), torus, ball)->collide(in_the_hole).value);
  EXPECT_TRUE(prepare(algorithm, torus, ball, parameters)->collide(in_the_hole).value);
}

/// Its label, and its statuses.
inline void expect_hull_manners(const Algorithm& algorithm) {
  EXPECT_EQ(algorithm.traits().body, Body::convex_hull);
  EXPECT_FALSE(algorithm.traits().in_default_runs());
  const Mesh a = load_model("cone-1k");
  const auto query = prepare(algorithm, a, a);
  Pose bad;
  bad.t.y() = std::nan("");
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not finite"));
  EXPECT_TRUE(query->collide(Pose()).value);
  EXPECT_EQ(query->distance(Pose()).status, Status::unsupported);
}

}  // namespace sixdof::test
