#include <sixdof/generation/distance_generator.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>

#include "../configuration/shapes.h"

namespace sixdof {
namespace {

using test::boxes_mesh;
using test::BoxShape;
using test::lump_mesh;
using test::random_direction;
using test::random_rotation;

const std::unique_ptr<Algorithm> k_brute_force = make_brute_force_algorithm();

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// |distance - target| at which the search has converged, in units of the diagonal of A's box (k_converged of
/// sphere_method.cpp), with room for the rounding of this test's own distances.
constexpr double k_found = 1.1e-12;

/// An oracle given by a function of the pose, for shapes whose distance is known. The meshes only give the boxes.
class FunctionAlgorithm final : public Algorithm {
 public:
  using Function = std::function<Separation(const Pose&)>;
  explicit FunctionAlgorithm(Function function) : function_(std::move(function)) {}
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& /*a*/, const Mesh& /*b*/, const Settings& /*settings*/) const override {
    struct FunctionQuery final : Query {
      explicit FunctionQuery(const Function& f) : function(f) {}
      Outcome<Separation> distance(const Pose& X_AB) override { return function(X_AB); }
      const Function& function;
    };
    return std::make_unique<FunctionQuery>(function_);
  }

 private:
  const Function function_;
  const Traits traits_{.name = "closed-form", .version = "1", .summary = "", .answers = {.distance = true}};
};

struct Ray {
  std::vector<double> translations, residuals;
  std::uint64_t measurements = 0;
};

Ray shoot(const Algorithm& oracle, const Mesh& a, const Mesh& b, const Eigen::Vector3d& direction,
          const Eigen::Vector4d& rotation, const std::vector<double>& targets,
          SphereMarch march = SphereMarch::certified) {
  const auto generator = make_sphere_method(oracle, march);
  const auto solver = generator->prepare(a, b);
  Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
  solver->set_rotation(rotation);
  solver->solve(direction, targets, ray.translations, ray.residuals);
  ray.measurements = solver->measurements();
  return ray;
}

struct Ball {
  Eigen::Vector3d center;
  double radius;
};

/// Distance of two unions of ball surfaces, with witnesses where the closest balls are apart.
Separation balls_distance(const std::vector<Ball>& a, const std::vector<Ball>& b, const Pose& X_AB, bool witnesses) {
  Separation best{.distance = std::numeric_limits<double>::infinity()};
  for (const Ball& first : a) {
    for (const Ball& second : b) {
      const Eigen::Vector3d across = X_AB * second.center - first.center;
      const double d = across.norm();
      // Apart, one inside the other, or meeting.
      const double gap = std::max(
          {0.0, d - first.radius - second.radius, first.radius - d - second.radius, second.radius - d - first.radius});
      if (gap >= best.distance) continue;
      best.distance = gap;
      best.has_witnesses = witnesses && d > first.radius + second.radius;
      if (best.has_witnesses) {
        best.witness_a = first.center + across / d * first.radius;
        best.witness_b = first.center + across / d * (d - second.radius);
      }
    }
  }
  return best;
}

/// The largest s >= 0 with |offset + s u| = reach; NaN if there is none.
double largest_root(const Eigen::Vector3d& offset, const Eigen::Vector3d& u, double reach) {
  const double along = offset.dot(u);
  const double discriminant = along * along - offset.squaredNorm() + reach * reach;
  const double s = -along + std::sqrt(discriminant);
  return discriminant < 0.0 || s < 0.0 ? k_nan : s;
}

/// First translation from outside at which the target is met: the largest over all pairs of balls.
double first_hit(const std::vector<Ball>& a, const std::vector<Ball>& b, const Pose& X_AB_at_0,
                 const Eigen::Vector3d& u, double target) {
  double s = k_nan;
  for (const Ball& first : a) {
    for (const Ball& second : b) {
      s = std::fmax(s,
                    largest_root(X_AB_at_0 * second.center - first.center, u, first.radius + second.radius + target));
    }
  }
  return s;
}

/// Compares one ray with closed forms and counts {hits, misses}.
void check_ray(const std::vector<Ball>& balls_a, const std::vector<Ball>& balls_b, const Mesh& a, const Mesh& b,
               const Eigen::Vector3d& u, const Eigen::Vector4d& q, const std::vector<double>& targets, const Ray& ray,
               std::array<int, 2>& count) {
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double expected = first_hit(balls_a, balls_b, ConfigurationRay(a, b, q, u).pose(0.0), u, targets[k]);
    ++count[std::isnan(expected) ? 1 : 0];
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(ray.translations[k])) << "target " << targets[k] << ": " << ray.translations[k];
      EXPECT_EQ(ray.residuals[k], 0.0);
      continue;
    }
    const auto distance_at = [&](double s) {
      return balls_distance(balls_a, balls_b, ConfigurationRay(a, b, q, u).pose(s), false).distance;
    };
    EXPECT_LE(std::abs(distance_at(ray.translations[k]) - targets[k]), k_found * a.diagonal());
    EXPECT_LE(ray.residuals[k], k_found * a.diagonal());
    // At grazing incidence a small error of the distance is a large error of the translation: near a quadratic minimum
    // of curvature 1 / reach an error e of the distance is at most sqrt(2 e reach) in translation.
    const double reach = a.diagonal() + b.diagonal();
    EXPECT_NEAR(ray.translations[k], expected, std::sqrt(2.0 * k_found * a.diagonal() * reach));
    const double slope = (distance_at(expected + 1e-6) - targets[k]) / 1e-6;
    if (slope > 0.05) {
      EXPECT_NEAR(ray.translations[k], expected, k_found * a.diagonal() / slope * 1.1);
    }
  }
}

TEST(SphereMethod, MeetsTheFirstHitOfUnionsOfBalls) {
  const std::vector<Ball> shape_a{{{0.4, 0.1, -0.2}, 0.5}, {{-1.1, 0.7, 0.3}, 0.3}, {{0.1, -1.2, 0.9}, 0.2}};
  const std::vector<Ball> shape_b{{{2.0, -1.1, 0.4}, 0.4}, {{2.6, 0.1, 1.2}, 0.15}};
  const Mesh mesh_a = boxes_mesh({{{-0.3, -0.1, 0.2}, {1.4, 1.5, 1.2}}});
  const Mesh mesh_b = boxes_mesh({{{2.2, -0.5, 0.7}, {0.8, 1.1, 0.9}}});
  std::mt19937_64 random(3);
  std::array<int, 2> count{};
  std::array<std::uint64_t, 2> measurements{};
  std::uint64_t conservative = 0;
  constexpr int k_rays = 300;
  for (const bool swapped : {false, true}) {
    const auto& balls_a = swapped ? shape_b : shape_a;
    const auto& balls_b = swapped ? shape_a : shape_b;
    const Mesh& a = swapped ? mesh_b : mesh_a;
    const Mesh& b = swapped ? mesh_a : mesh_b;
    std::vector<double> targets;
    for (const double percent : {30.0, 17.0, 4.0, 1.0, 1e-9}) targets.push_back(percent * 0.01 * a.diagonal());
    for (const bool witnesses : {true, false}) {
      const FunctionAlgorithm oracle(
          [&, witnesses](const Pose& X_AB) { return balls_distance(balls_a, balls_b, X_AB, witnesses); });
      for (int repeat = 0; repeat < k_rays; ++repeat) {
        const Eigen::Vector3d u = random_direction(random);
        const Eigen::Vector4d q = random_rotation(random);
        const Ray ray = shoot(oracle, a, b, u, q, targets);
        measurements[witnesses ? 0 : 1] += ray.measurements;
        check_ray(balls_a, balls_b, a, b, u, q, targets, ray, count);
        if (!witnesses) continue;
        const Ray plain = shoot(oracle, a, b, u, q, targets, SphereMarch::conservative);
        conservative += plain.measurements;
        check_ray(balls_a, balls_b, a, b, u, q, targets, plain, count);
      }
    }
  }
  EXPECT_GT(count[0], 6000);
  EXPECT_GT(count[1], 75);
  // Bounds on measurements per target: certified steps take fewer than 8, conservative ones more than 20.
  EXPECT_LT(measurements[0], 8u * 2 * k_rays * 5);
  EXPECT_GT(conservative, 20u * 2 * k_rays * 5);
  EXPECT_LT(measurements[0], measurements[1]);
}

TEST(SphereMethod, StopsAtANeedleBesideThePath) {
  // A tiny ball beside the ray lowers the distance below the target over a short interval only, far outside the big
  // ball.
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> exponent(-8.0, -1.0);
  std::uniform_real_distribution<double> position(1.2, 2.5);
  const Mesh a = boxes_mesh({{{0.2, 0.1, -0.3}, {3.0, 3.0, 3.0}}});
  const Mesh b = boxes_mesh({{{0.7, 0.3, 0.0}, {0.1, 0.1, 0.1}}});
  std::array<int, 2> count{};
  for (int repeat = 0; repeat < 400; ++repeat) {
    const Eigen::Vector3d u = random_direction(random);
    const Eigen::Vector4d q = random_rotation(random);
    const double target = (repeat % 4 + 1) * 0.01 * a.diagonal();
    const double dip = std::pow(10.0, exponent(random)) * a.diagonal();
    const double needle = 0.001;
    const std::vector<Ball> balls_b{{b.center(), 0.1}};
    const Eigen::Vector3d aside = u.cross(random_direction(random)).normalized();
    const std::vector<Ball> balls_a{
        {a.center(), 0.4}, {a.center() + position(random) * u + (target + 0.1 + needle - dip) * aside, needle}};
    const FunctionAlgorithm oracle([&](const Pose& X_AB) { return balls_distance(balls_a, balls_b, X_AB, true); });
    const std::vector<double> targets{target + 0.3, target};
    check_ray(balls_a, balls_b, a, b, u, q, targets, shoot(oracle, a, b, u, q, targets), count);
  }
  EXPECT_EQ(count[0], 800);
}

TEST(SphereMethod, ConservativeMarchesSolveEveryTargetAlone) {
  const Mesh a = lump_mesh(3, {0.2, 1.4, -0.7});
  const Mesh b = lump_mesh(4, {-0.6, 0.3, 0.5});
  std::mt19937_64 random(9);
  const std::vector<double> targets{0.3 * a.diagonal(), 0.07 * a.diagonal(), k_contact_target * a.diagonal()};
  const Eigen::Vector3d u = random_direction(random);
  const Eigen::Vector4d q = random_rotation(random);
  const Ray together = shoot(*k_brute_force, a, b, u, q, targets, SphereMarch::conservative);
  std::uint64_t measurements = 0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const Ray alone = shoot(*k_brute_force, a, b, u, q, {targets[k]}, SphereMarch::conservative);
    EXPECT_EQ(alone.translations[0], together.translations[k]);
    EXPECT_EQ(alone.residuals[0], together.residuals[k]);
    measurements += alone.measurements;
  }
  EXPECT_EQ(measurements, together.measurements);
}

TEST(SphereMethod, IsExactForBoxesFaceToFace) {
  // Rotations by right angles permute the half edges; along an axis the translation is the sum of both and the target.
  const Eigen::Vector3d half_a(1.1, 0.7, 0.4), half_b(0.3, 0.55, 0.8);
  const Mesh first = boxes_mesh({{{0.9, -2.0, 0.3}, half_a}});
  const Mesh second = boxes_mesh({{{-4.0, 0.1, 7.7}, half_b}});
  const auto rotations = make_grid("90").rotations;
  const auto distinct = DistinctRotations(rotations).representative;
  for (const auto& [a, b, ha, hb] :
       {std::tuple(&first, &second, half_a, half_b), std::tuple(&second, &first, half_b, half_a)}) {
    const std::vector<double> targets{0.3 * a->diagonal(), 0.013 * a->diagonal(), k_contact_target * a->diagonal()};
    for (std::size_t r = 0; r < rotations.size(); ++r) {
      if (distinct[r] != r) continue;
      const Eigen::Vector4d& q = rotations[r];
      const Eigen::Matrix3d R = ConfigurationRay(*a, *b, q).R;
      const Eigen::Vector3d rotated = (R * hb).cwiseAbs();
      for (const Eigen::Vector3d& u : make_grid("90").directions) {
        const double reach = u.cwiseAbs().dot(ha + rotated);
        const Ray ray = shoot(*k_brute_force, *a, *b, u, q, targets);
        for (std::size_t k = 0; k < targets.size(); ++k) {
          EXPECT_NEAR(ray.translations[k], reach + targets[k], k_found * a->diagonal());
        }
      }
    }
  }
}

TEST(SphereMethod, TakesTheOuterWallNotTheInnerOne) {
  // Two walls across the ray. Between them the target is met again on both sides; the first hit is outside the outer
  // wall.
  const Mesh a = boxes_mesh({{{1.0, 0, 0}, {0.01, 0.8, 0.8}}, {{-1.0, 0, 0}, {0.01, 0.8, 0.8}}}, "walls");
  const Mesh b = boxes_mesh({{{5.0, 5.0, 5.0}, {0.1, 0.12, 0.14}}});
  const std::vector<double> targets{0.1, 0.03, 1e-6};
  const Eigen::Vector4d identity(1, 0, 0, 0);
  for (const double side : {1.0, -1.0}) {
    const Ray ray = shoot(*k_brute_force, a, b, {side, 0, 0}, identity, targets);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      EXPECT_NEAR(ray.translations[k], 1.0 + 0.01 + 0.1 + targets[k], k_found * a.diagonal());
    }
  }
  // The same with the walls as B.
  const Ray swapped = shoot(*k_brute_force, b, a, {1, 0, 0}, identity, targets);
  EXPECT_NEAR(swapped.translations[0], 1.11 + targets[0], k_found * b.diagonal());
}

TEST(SphereMethod, PassesThroughAHoleButNotWhereItIsTooNarrow) {
  // A square ring about the ray with an opening of half width 0.5. B of half width 0.2 passes at a distance of 0.3.
  const Mesh a = boxes_mesh({{{0.75, 0, 0}, {0.25, 1.0, 0.1}},
                             {{-0.75, 0, 0}, {0.25, 1.0, 0.1}},
                             {{0, 0.75, 0}, {0.5, 0.25, 0.1}},
                             {{0, -0.75, 0}, {0.5, 0.25, 0.1}}},
                            "ring");
  const Mesh b = boxes_mesh({{{1.0, 2.0, 3.0}, {0.2, 0.2, 0.3}}});
  const Eigen::Vector4d identity(1, 0, 0, 0);
  const std::vector<double> targets{0.5, 0.31, 0.299, 0.1, 1e-6};
  const Ray ray = shoot(*k_brute_force, a, b, {0, 0, 1}, identity, targets);
  // Edges meet first, 0.3 apart sideways: target^2 = 0.3^2 + gap^2.
  EXPECT_NEAR(ray.translations[0], 0.1 + 0.3 + 0.4, k_found * a.diagonal());
  EXPECT_NEAR(ray.translations[1], 0.4 + std::sqrt(0.31 * 0.31 - 0.09), 10 * k_found * a.diagonal());
  EXPECT_TRUE(std::isnan(ray.translations[2]));
  EXPECT_TRUE(std::isnan(ray.translations[3]));
  EXPECT_TRUE(std::isnan(ray.translations[4]));
  EXPECT_LT(ray.measurements, 60u);

  // From the side it hits the ring's outside.
  const Ray side = shoot(*k_brute_force, a, b, {1, 0, 0}, identity, targets);
  EXPECT_NEAR(side.translations[4], 1.0 + 0.2 + targets[4], k_found * a.diagonal());
}

TEST(SphereMethod, AgreesWithFineMarchingOnMeshes) {
  const Mesh first = lump_mesh(1, {0.3, -7.0, 2.0});
  const Mesh second = lump_mesh(2, {4.0, 0.4, -0.9});
  std::mt19937_64 random(17);
  for (const auto& [a, b] : {std::pair(&first, &second), std::pair(&second, &first), std::pair(&first, &first)}) {
    const auto query = k_brute_force->prepare(*a, *b, k_brute_force->settings());
    const std::vector<double> targets{0.2 * a->diagonal(), 0.02 * a->diagonal(), k_contact_target * a->diagonal()};
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Eigen::Vector3d u = random_direction(random);
      const Eigen::Vector4d q = random_rotation(random);
      const Ray ray = shoot(*k_brute_force, *a, *b, u, q, targets);
      for (std::size_t k = 0; k < targets.size(); ++k) {
        // The bodies overlap at s = 0.
        ASSERT_FALSE(std::isnan(ray.translations[k]));
        const double found = query->distance(ConfigurationRay(*a, *b, q, u).pose(ray.translations[k])).value.distance;
        EXPECT_NEAR(found, targets[k], k_found * a->diagonal());
        // The distance is greater before.
        constexpr int k_steps = 20;
        const double start = 0.5 * (a->diagonal() + b->diagonal()) + targets[k];
        for (int i = 0; i < k_steps; ++i) {
          const double s = ray.translations[k] + (start - ray.translations[k]) * (i + 0.5) / k_steps;
          EXPECT_GT(query->distance(ConfigurationRay(*a, *b, q, u).pose(s)).value.distance, targets[k]);
        }
      }
    }
  }
}

TEST(SphereMethod, RefusesAnOracleThatIsNotADistance) {
  const Mesh a = boxes_mesh({{{0, 0, 0}, {1, 1, 1}}});
  // It jumps past the target.
  const FunctionAlgorithm jumping([](const Pose& X_AB) {
    const double s = X_AB.t.norm();
    return Separation{.distance = s > 1.7 ? s - 1.0 : 0.2};
  });
  for (const SphereMarch march : {SphereMarch::certified, SphereMarch::conservative}) {
    EXPECT_THAT(
        [&] {
          shoot(jumping, a, a, {0, 0, 1}, {1, 0, 0, 0}, {0.3}, march);
        },
        testing::ThrowsMessage<Error>(testing::HasSubstr("jumps")));
  }
}

}  // namespace
}  // namespace sixdof
