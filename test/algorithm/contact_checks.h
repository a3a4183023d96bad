#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/scenario/solids.h>

/// What every algorithm that turns contacts of a library into a response is checked for.

namespace sixdof::test {

inline Pose generic_pose(std::mt19937_64& random, double reach) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  return {q.toRotationMatrix(), reach * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized()};
}

inline Mesh moved(const Mesh& mesh, const Pose& X) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& v : vertices) v = X * v;
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name());
}

inline std::unique_ptr<Query> prepare(const Algorithm& algorithm, const Mesh& a, const Mesh& b,
                                      const std::vector<std::string>& parameters = {}) {
  Settings settings = algorithm.settings();
  settings.set_all(parameters);
  return algorithm.prepare(a, b, settings);
}

/// Poses of two closed bodies, none wholly inside the other, that are clearly apart or clearly overlap.
struct ClearPoses {
  /// Fractions of A's box diagonal, and of its cube: far more than the size of a triangle, or a few triangles' overlap.
  static constexpr double k_apart = 0.05, k_overlap = 1e-3;
  Mesh a = load_model("torus-1k"), b = load_model("cone-1k");
  std::vector<std::pair<Pose, bool>> poses;  ///< With the truth.

  explicit ClearPoses(int count) {
    const double diagonal = a.box().diagonal().norm();
    const auto exact = make_exact_algorithm();
    const auto truth = prepare(*exact, a, b);
    std::mt19937_64 random(2031);
    std::uniform_real_distribution<double> reach(0.2, 0.9);
    while (static_cast<int>(poses.size()) < count) {
      const Pose X_AB = generic_pose(random, reach(random) * diagonal);
      const double distance = truth->distance(X_AB).value.distance;
      if (distance > k_apart * diagonal) {
        poses.emplace_back(X_AB, false);
      } else if (distance == 0.0 && truth->respond(X_AB).value.volume > k_overlap * std::pow(diagonal, 3)) {
        poses.emplace_back(X_AB, true);
      }
    }
  }
};

/// Yes/no as `exact`: in both orders, repeated, and after a rigid motion of both meshes. Calls
/// check(query of A and B, pose, truth) for each pose.
template <class Check>
void expect_clear_answers(const Algorithm& algorithm, const std::vector<std::string>& parameters, const Check& check) {
  const ClearPoses clear(60);
  std::mt19937_64 random(5);
  const Pose move_a = generic_pose(random, 1.7), move_b = generic_pose(random, 0.9);
  const Mesh moved_a = moved(clear.a, move_a), moved_b = moved(clear.b, move_b);
  const auto ab = prepare(algorithm, clear.a, clear.b, parameters),
             ba = prepare(algorithm, clear.b, clear.a, parameters);
  const auto elsewhere = prepare(algorithm, moved_a, moved_b, parameters);
  std::size_t hits = 0;
  for (const auto& [X_AB, truth] : clear.poses) {
    const auto forth = ab->collide(X_AB), again = ab->collide(X_AB), back = ba->collide(X_AB.inverse());
    const auto there = elsewhere->collide(move_a * X_AB * move_b.inverse());
    ASSERT_TRUE(forth.ok() && again.ok() && back.ok() && there.ok());
    EXPECT_EQ(forth.value, truth);
    EXPECT_EQ(again.value, truth);
    EXPECT_EQ(back.value, truth);
    EXPECT_EQ(there.value, truth);
    check(*ab, X_AB, truth);
    hits += truth;
  }
  EXPECT_GT(hits, clear.poses.size() / 4);
  EXPECT_LT(hits, clear.poses.size() * 3 / 4);
}

/// For an algorithm without a response.
inline void expect_clear_yes_no(const Algorithm& algorithm, const std::vector<std::string>& parameters = {}) {
  expect_clear_answers(algorithm, parameters, [](Query&, const Pose&, bool) {});
}

/// For an algorithm with a response.
inline void expect_clear_answers(const Algorithm& algorithm) {
  expect_clear_answers(algorithm, {}, [](Query& query, const Pose& X_AB, bool truth) {
    const auto response = query.respond(X_AB);
    ASSERT_TRUE(response.ok()) << query.diagnosis();
    EXPECT_EQ(response.value.penalty > 0.0, truth);
    EXPECT_EQ(response.value.force.norm() > 0.0, truth);
  });
}

/// Yes/no as `exact` where B is moved along the line of the closest points to a gap of either sign that is far below a
/// float's resolution, in both orders. For algorithms whose test of triangles is exact.
inline void expect_close_yes_no(const Algorithm& algorithm, const std::vector<std::string>& parameters = {}) {
  const Mesh a = load_model("torus-1k"), b = load_model("cone-1k");
  const auto exact = make_exact_algorithm();
  const auto truth = prepare(*exact, a, b);
  const auto ab = prepare(algorithm, a, b, parameters), ba = prepare(algorithm, b, a, parameters);
  std::mt19937_64 random(77);
  int apart = 0, touching = 0;
  while (apart + touching < 400) {
    const Pose X_AB = generic_pose(random, 1.3 * a.diagonal());
    const Separation far = truth->distance(X_AB).value;
    if (far.distance == 0.0) continue;
    const Eigen::Vector3d way = far.witness_b - far.witness_a;
    for (const double gap : {1e-4, 1e-6, 1e-8, 1e-10, -1e-4, -1e-6, -1e-8, -1e-10}) {
      Pose close = X_AB;
      close.t -= way * (1.0 - gap * a.diagonal() / far.distance);
      const bool meet = truth->collide(close).value;
      EXPECT_EQ(ab->collide(close).value, meet) << gap;
      EXPECT_EQ(ba->collide(close.inverse()).value, meet) << gap;
      (meet ? touching : apart)++;
    }
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(touching, 100);
}

/// Boxes that share a face's plane, with coordinates that no float has: contact counts, the smallest gap does not.
inline void expect_touching_boxes_collide(const Algorithm& algorithm, const std::vector<std::string>& parameters = {}) {
  const Mesh a = box_solid({-0.7, -0.3, -0.9}, {0.3, 0.1, 0.2}, "a");
  const Mesh b = box_solid({-0.1, 0.1, -0.2}, {0.6, 0.4, 0.8}, "b");
  const auto ab = prepare(algorithm, a, b, parameters), ba = prepare(algorithm, b, a, parameters);
  Pose X_AB;
  EXPECT_TRUE(ab->collide(X_AB).value);
  EXPECT_TRUE(ba->collide(X_AB).value);
  X_AB.t.y() = 1e-15;
  EXPECT_FALSE(ab->collide(X_AB).value);
  EXPECT_FALSE(ba->collide(X_AB.inverse()).value);
  X_AB.t.y() = -1e-15;
  EXPECT_TRUE(ab->collide(X_AB).value);
  EXPECT_TRUE(ba->collide(X_AB.inverse()).value);
}

/// The same bits for the same pose, whatever was asked in between.
inline void expect_repeatable(const Algorithm& algorithm) {
  const ClearPoses clear(20);
  const auto query = prepare(algorithm, clear.a, clear.b);
  std::vector<Response> first;
  for (const auto& [X_AB, truth] : clear.poses) first.push_back(query->respond(X_AB).value);
  for (std::size_t i = clear.poses.size(); i-- > 0;) {
    const Response again = query->respond(clear.poses[i].first).value;
    EXPECT_EQ(again.force, first[i].force);
    EXPECT_EQ(again.torque, first[i].torque);
    EXPECT_EQ(again.penalty, first[i].penalty);
  }
}

/// A ball in the upper face, y = 0, of a block.
struct BallOnFace {
  static constexpr double k_radius = 3.0;
  static constexpr int k_facets = 24;
  /// Length of the ball's edges by its radius, and so of a contact's arm about the ball's centre along the face.
  static constexpr double k_edge = 2.0 * std::numbers::pi / k_facets;
  Mesh block = box_solid({-50.0, -30.0, -40.0}, {45.0, 0.0, 43.0}, "block");
  Mesh ball = sphere_solid(k_radius, k_facets, RoundParts::inscribed, "ball");
  /// Turned, so that no facet is parallel to the face.
  Pose X_AB{(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()))
                .toRotationMatrix(),
            {13.1, k_radius - 0.4, 12.2}};

  /// Of the ball's lowest vertex.
  double depth() const {
    double low = 0.0;
    for (const Eigen::Vector3d& v : ball.vertices()) low = std::min(low, (X_AB * v).y());
    return -low;
  }
};

/// A response of the ball on the face by the ideal: along the face's normal, as deep as the ball, without a torque
/// about its centre.
struct BallResponse {
  double degrees = 0.0;  ///< Angle of the force to the face's normal.
  double depth = 0.0;    ///< Penalty by the ideal.
  double arm = 0.0;      ///< |T| / (|F| radius).
};

inline BallResponse ball_response(const Algorithm& algorithm, const std::string& combine, bool block_first) {
  const BallOnFace t;
  const auto query = block_first ? prepare(algorithm, t.block, t.ball, {"combine=" + combine})
                                 : prepare(algorithm, t.ball, t.block, {"combine=" + combine});
  const Pose X_BA = t.X_AB.inverse();
  const auto outcome = query->respond(block_first ? t.X_AB : X_BA);
  EXPECT_TRUE(outcome.ok()) << query->diagnosis();
  // The force on the ball, in the block's frame, and the torque about the ball's centre.
  const Response r = outcome.value.about(block_first ? t.X_AB * t.ball.center() : t.ball.center());
  const Eigen::Vector3d force = block_first ? r.force : Eigen::Vector3d(-(t.X_AB.R * r.force));
  const double cosine = force.normalized().y();
  return {.degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi,
          .depth = r.penalty / t.depth(),
          .arm = r.torque.norm() / (r.force.norm() * BallOnFace::k_radius)};
}

/// @param least_depth smallest penalty by the ball's depth that is accepted
inline void expect_ball_pushed_out(const Algorithm& algorithm, double least_depth) {
  // Vertices are at the radius to rounding; the face's normal is an axis.
  constexpr double k_rounding = 1e-6;
  for (const char* combine : {"mean", "sum", "deepest"}) {
    for (const bool block_first : {true, false}) {
      const BallResponse r = ball_response(algorithm, combine, block_first);
      EXPECT_LT(r.degrees, 1.0) << combine << block_first;
      EXPECT_GT(r.depth, least_depth) << combine << block_first;
      EXPECT_LT(r.depth, 1.0 + k_rounding) << combine << block_first;
      EXPECT_LT(r.arm, BallOnFace::k_edge) << combine << block_first;
    }
  }
}

/// A pose that is not finite is a failed query with words, of every kind.
inline void expect_no_answer_where_not_finite(const Algorithm& algorithm) {
  const BallOnFace t;
  const auto query = prepare(algorithm, t.block, t.ball);
  Pose bad = t.X_AB;
  bad.t.x() = std::nan("");
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not finite"));
  bad = t.X_AB;
  bad.R(0, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(query->respond(bad).status, Status::failed);
  EXPECT_TRUE(query->respond(t.X_AB).ok());
  EXPECT_EQ(query->distance(t.X_AB).status, Status::unsupported);
}

/// Known limit of all of them: a body wholly inside the other has no contact.
inline void expect_no_contact_inside(const Algorithm& algorithm) {
  const BallOnFace t;
  const auto query = prepare(algorithm, t.block, t.ball);
  Pose inside = t.X_AB;
  inside.t.y() = -14.0;
  EXPECT_FALSE(query->collide(inside).value);
  EXPECT_EQ(query->respond(inside).value.force.norm(), 0.0);
}

}  // namespace sixdof::test
