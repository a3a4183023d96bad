#pragma once

#include "contact_checks.h"

/// What every algorithm is checked for that takes the boundary of the intersection from a library.

namespace sixdof::test {

inline constexpr double k_volume_rounding = 1e-9;  // relative: of a sum over all triangles of a ball

/// Volume, force and torque as `exact`, in both orders; zero where bodies are apart.
/// @param tolerance of each, as a fraction of the exact one
inline void expect_response_of_exact(const Algorithm& algorithm, double tolerance) {
  const ClearPoses clear(40);
  const auto exact = make_exact_algorithm();
  const auto truth_ab = prepare(*exact, clear.a, clear.b), truth_ba = prepare(*exact, clear.b, clear.a);
  const auto ab = prepare(algorithm, clear.a, clear.b), ba = prepare(algorithm, clear.b, clear.a);
  for (const auto& [X_AB, overlap] : clear.poses) {
    for (const auto& [query, truth, X] :
         {std::tuple(ab.get(), truth_ab.get(), X_AB), std::tuple(ba.get(), truth_ba.get(), X_AB.inverse())}) {
      const auto outcome = query->respond(X);
      ASSERT_TRUE(outcome.ok()) << query->diagnosis();
      const Response expected = truth->respond(X).value, got = outcome.value.about(expected.reference);
      EXPECT_EQ(got.volume > 0.0, overlap);
      EXPECT_EQ(got.penalty, got.volume);
      EXPECT_NEAR(got.volume, expected.volume, tolerance * expected.volume);
      EXPECT_LE((got.force - expected.force).norm(), tolerance * expected.force.norm());
      EXPECT_LE((got.torque - expected.torque).norm(), tolerance * (expected.torque.norm() + expected.force.norm()));
    }
  }
}

/// A body wholly inside the other: its volume, and no force.
inline void expect_volume_of_inner_body(const Algorithm& algorithm) {
  const BallOnFace t;
  Pose inside = t.X_AB;
  inside.t.y() = -14.0;
  for (const bool block_first : {true, false}) {
    const auto query = block_first ? prepare(algorithm, t.block, t.ball) : prepare(algorithm, t.ball, t.block);
    const auto outcome = query->respond(block_first ? inside : inside.inverse());
    ASSERT_TRUE(outcome.ok()) << query->diagnosis();
    EXPECT_NEAR(outcome.value.volume, t.ball.volume(), k_volume_rounding * t.ball.volume());
    EXPECT_EQ(outcome.value.force.norm(), 0.0);
    EXPECT_EQ(outcome.value.torque.norm(), 0.0);
  }
}

}  // namespace sixdof::test
