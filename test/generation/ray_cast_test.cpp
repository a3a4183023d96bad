#include <sixdof/generation/distance_generator.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/models/model_catalogue.h>

#include "../configuration/shapes.h"
#include "../oracle/rough_mesh.h"

namespace sixdof {
namespace {

using test::boxes_mesh;
using test::lump_mesh;
using test::random_direction;
using test::random_rotation;

const std::unique_ptr<Algorithm> k_brute_force = make_brute_force_algorithm();

/// Of a translation, in units of A's box diagonal: both methods stop where the distance is right to 1e-12. Where the
/// ray grazes, the translation may be off by a thousand times as much.
constexpr double k_same_translation = 1e-9;
/// |distance - target|, in units of the sum of the box diagonals: rounding of corners within a few diagonals of the
/// origin.
constexpr double k_rounding = 1e-14;

struct Ray {
  std::vector<double> translations, residual;
};

Ray cast_ray(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Eigen::Vector3d& direction,
             const Eigen::Vector4d& rotation, const std::vector<double>& targets) {
  const auto solver = generator.prepare(a, b);
  Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
  solver->set_rotation(rotation);
  solver->solve(direction, targets, ray.translations, ray.residual);
  return ray;
}

std::vector<double> some_targets(const Mesh& a) {
  return {0.3 * a.diagonal(), 0.11 * a.diagonal(), 0.01 * a.diagonal(), k_contact_target * a.diagonal()};
}

/// Compares with the sphere method on top of all pairs of triangles, in both orders.
void compare(const Mesh& first, const Mesh& second, int rays, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (const auto& [a, b] : {std::pair(&first, &second), std::pair(&second, &first)}) {
    const auto solver = make_ray_cast()->prepare(*a, *b);
    const auto expected_solver = make_sphere_method(*k_brute_force)->prepare(*a, *b);
    const std::vector<double> targets = some_targets(*a);
    Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
    Ray expected = ray;
    for (int i = 0; i < rays; ++i) {
      const Eigen::Vector3d u = random_direction(random);
      if (i % 3 == 0) {  // several directions per rotation: a search starts from the pairs of the ray before
        const Eigen::Vector4d q = random_rotation(random);
        solver->set_rotation(q);
        expected_solver->set_rotation(q);
      }
      solver->solve(u, targets, ray.translations, ray.residual);
      expected_solver->solve(u, targets, expected.translations, expected.residual);
      for (std::size_t k = 0; k < targets.size(); ++k) {
        ASSERT_EQ(std::isnan(ray.translations[k]), std::isnan(expected.translations[k]))
            << a->name() << ", " << b->name();
        if (std::isnan(ray.translations[k])) continue;
        EXPECT_NEAR(ray.translations[k], expected.translations[k], k_same_translation * a->diagonal())
            << a->name() << ", " << b->name();
        EXPECT_LE(ray.residual[k], k_rounding * (a->diagonal() + b->diagonal()));
      }
    }
  }
}

TEST(RayCast, AgreesWithTheSphereMethodOnLumps) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Mesh lump = lump_mesh(2 * seed, {0.3, -2.0, 1.1});
    compare(lump, lump_mesh(2 * seed + 1, {0.7, 0.4, -0.9}), 6, seed);
    compare(lump, lump, 3, seed + 100);
  }
}

TEST(RayCast, AgreesWithTheSphereMethodOnTubesAndLabyrinths) {
  compare(load_model("torus-knot-600"), test::tetrahedron_mesh({0.1, 0.2, 0.3}, 0.4), 4, 21);
  compare(load_model("gyroid-ball-1200"), test::tetrahedron_mesh({0.2, 0.1, 0.4}, 0.9), 4, 22);
}

TEST(RayCast, AgreesWithTheSphereMethodOnUnequalSizesAndThinPlates) {
  const Mesh plate = boxes_mesh({{{0.3, 0.1, -0.2}, {1.0, 0.7, 1e-4}}}, "plate");
  const Mesh speck = boxes_mesh({{{3.0, 1.0, 2.0}, {0.001, 0.0012, 0.0007}}}, "speck");
  compare(plate, speck, 12, 31);
  compare(plate, lump_mesh(4, {0.0, 0.0, 0.0}), 12, 32);
  compare(boxes_mesh({{{1.0, 2.0, 0.0}, {1.0, 0.3, 0.4}}}), speck, 12, 33);
}

/// Contact of a small A is nearer than the rounding that is allowed for ties, which is relative to both sizes.
TEST(RayCast, ContactOfASpeckIsOutsideOfALargeBody) {
  const Mesh large = boxes_mesh({{{0.0, 0.0, 0.0}, {1.0, 0.8, 0.6}}}, "large");
  std::mt19937_64 random(41);
  for (const double size : {1e-3, 1e-4, 1e-5}) {
    const Mesh speck = boxes_mesh({{{0.0, 0.0, 0.0}, {size, 0.8 * size, 0.6 * size}}}, "speck");
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d u = random_direction(random);
      const Eigen::Vector4d q = random_rotation(random);
      const Ray ray = cast_ray(*make_ray_cast(), speck, large, u, q, {k_contact_target * speck.diagonal()});
      const auto query = k_brute_force->prepare(speck, large, k_brute_force->settings());
      const auto distance_at = [&](double s) {
        return query->distance(ConfigurationRay(speck, large, q, u).pose(s)).value.distance;
      };
      EXPECT_LE(distance_at(ray.translations[0]), 2.0 * k_contact_target * speck.diagonal() + 1e-14);
      EXPECT_GT(distance_at(ray.translations[0] + 1e-3 * size), 0.0) << size;
    }
  }
}

TEST(RayCast, IsExactForBoxesFaceToFace) {
  // Rotations by right angles permute the half edges; along an axis the translation is the sum of both and the target.
  const Eigen::Vector3d half_a(1.1, 0.7, 0.4), half_b(0.3, 0.55, 0.8);
  const Mesh first = boxes_mesh({{{0.9, -2.0, 0.3}, half_a}});
  const Mesh second = boxes_mesh({{{-1.0, 0.1, 1.7}, half_b}});
  const auto rotations = make_grid("90").rotations;
  const auto generator = make_ray_cast();
  for (const auto& [a, b, ha, hb] :
       {std::tuple(&first, &second, half_a, half_b), std::tuple(&second, &first, half_b, half_a)}) {
    const std::vector<double> targets = some_targets(*a);
    for (const Eigen::Vector4d& q : rotations) {
      const Eigen::Vector3d half_in_a = (ConfigurationRay(*a, *b, q).R * hb).cwiseAbs();
      for (const Eigen::Vector3d& u : make_grid("90").directions) {
        const double reach = u.cwiseAbs().dot(ha + half_in_a);
        const Ray ray = cast_ray(*generator, *a, *b, u, q, targets);
        for (std::size_t k = 0; k < targets.size(); ++k) {
          EXPECT_NEAR(ray.translations[k], reach + targets[k], k_rounding * a->diagonal());
        }
      }
    }
  }
}

/// Radius of the largest ball about the origin inside a convex mesh.
double inner_radius(const Mesh& mesh) {
  double r = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d p = mesh.vertices()[t[0]];
    const Eigen::Vector3d n = (mesh.vertices()[t[1]] - p).cross(mesh.vertices()[t[2]] - p).normalized();
    r = std::min(r, n.dot(p));
  }
  return r;
}

TEST(RayCast, LiesBetweenInnerAndOuterSpheres) {
  const Mesh a = load_model("sphere-1000");
  const Mesh b = load_model("sphere-300");
  ASSERT_LT(a.center().norm() + b.center().norm(), k_rounding);
  const std::vector<double> targets = some_targets(a);
  const auto solver = make_ray_cast()->prepare(a, b);
  Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
  std::mt19937_64 random(4);
  const double inner = inner_radius(a) + inner_radius(b);
  ASSERT_GT(inner, 1.9);
  for (int i = 0; i < 50; ++i) {
    solver->set_rotation(random_rotation(random));
    solver->solve(random_direction(random), targets, ray.translations, ray.residual);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      EXPECT_GE(ray.translations[k], inner + targets[k] - k_rounding);
      EXPECT_LE(ray.translations[k], 2.0 + targets[k] + k_rounding);
    }
  }
}

TEST(RayCast, TakesTheOuterWallNotTheInnerOne) {
  const Mesh a = boxes_mesh({{{1.0, 0, 0}, {0.01, 0.8, 0.8}}, {{-1.0, 0, 0}, {0.01, 0.8, 0.8}}}, "walls");
  const Mesh b = boxes_mesh({{{5.0, 5.0, 5.0}, {0.1, 0.12, 0.14}}});
  const std::vector<double> targets{0.1, 0.03, 1e-6};
  const Eigen::Vector4d identity(1, 0, 0, 0);
  for (const double side : {1.0, -1.0}) {
    const Ray ray = cast_ray(*make_ray_cast(), a, b, {side, 0, 0}, identity, targets);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      EXPECT_NEAR(ray.translations[k], 1.0 + 0.01 + 0.1 + targets[k], k_rounding * a.diagonal());
    }
  }
  const Ray swapped = cast_ray(*make_ray_cast(), b, a, {1, 0, 0}, identity, targets);
  EXPECT_NEAR(swapped.translations[0], 1.11 + targets[0], k_rounding * a.diagonal());
}

TEST(RayCast, PassesThroughAHoleUnlessItIsTooTight) {
  // A square ring about the ray with an opening of half width 0.5; B of half width 0.2 passes with 0.3 to spare.
  const Mesh a = boxes_mesh({{{0.75, 0, 0}, {0.25, 1.0, 0.1}},
                             {{-0.75, 0, 0}, {0.25, 1.0, 0.1}},
                             {{0, 0.75, 0}, {0.5, 0.25, 0.1}},
                             {{0, -0.75, 0}, {0.5, 0.25, 0.1}}},
                            "ring");
  const Mesh b = boxes_mesh({{{1.0, 2.0, 3.0}, {0.2, 0.2, 0.3}}});
  const std::vector<double> targets{0.5, 0.31, 0.299, 0.1, 1e-6};
  const Ray ray = cast_ray(*make_ray_cast(), a, b, {0, 0, 1}, {1, 0, 0, 0}, targets);
  EXPECT_NEAR(ray.translations[0], 0.1 + 0.3 + 0.4, k_rounding * a.diagonal());
  EXPECT_NEAR(ray.translations[1], 0.4 + std::sqrt(0.31 * 0.31 - 0.09), k_rounding * a.diagonal());
  for (std::size_t k = 2; k < targets.size(); ++k) {
    EXPECT_TRUE(std::isnan(ray.translations[k]));
    EXPECT_EQ(ray.residual[k], 0.0);
  }
}

TEST(RayCast, MissesNoHitOfManySmallTriangles) {
  // On these rays the balls of some volumes are nearest farther in than their boxes.
  const Mesh a = load_model("torus-knot-100k");
  const Grid grid = make_grid("15/90");
  const auto exact = make_exact_algorithm();
  const auto solver = make_ray_cast()->prepare(a, a);
  const auto expected_solver = make_sphere_method(*exact)->prepare(a, a);
  const std::vector<double> targets = {0.05 * a.diagonal(), 0.01 * a.diagonal(), k_contact_target * a.diagonal()};
  Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
  Ray expected = ray;
  for (const auto& [rotation, direction] : {std::pair<std::size_t, std::size_t>(38, 182), {38, 90}, {21, 68}}) {
    solver->set_rotation(grid.rotations[rotation]);
    expected_solver->set_rotation(grid.rotations[rotation]);
    solver->solve(grid.directions[direction], targets, ray.translations, ray.residual);
    expected_solver->solve(grid.directions[direction], targets, expected.translations, expected.residual);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      EXPECT_NEAR(ray.translations[k], expected.translations[k], k_same_translation * a.diagonal())
          << rotation << ", " << direction;
    }
  }
}

TEST(RayCast, FindsTheShortestHit) {
  // Two gates across the path, each with a clearance a little less than the target on either side: the distance falls
  // below the target for an interval of 2e-2 to 2e-5 only.
  constexpr double k_target = 0.05, k_thin = 1e-8;
  const Mesh b = boxes_mesh({{{0.7, 0.3, 0.0}, {k_thin, 0.1, 0.1}}});
  for (const double dip : {1e-3, 1e-6, 1e-9}) {
    const double clearance = k_target - dip;
    std::vector<test::BoxShape> posts;
    for (const double x : {2.0, -2.0}) {
      for (const double side : {1.0, -1.0})
        posts.push_back({{x, side * (0.1 + clearance + 0.02), 0.0}, {k_thin, 0.02, 0.01}});
    }
    const Mesh a = boxes_mesh(posts, "gates");
    const Ray ray = cast_ray(*make_ray_cast(), a, b, {1, 0, 0}, {1, 0, 0, 0}, {k_target});
    const double gap = std::sqrt(k_target * k_target - clearance * clearance);
    EXPECT_NEAR(ray.translations[0], 2.0 + 2.0 * k_thin + gap, k_same_translation * a.diagonal());
  }
}

TEST(RayCast, AgreesWithTheSphereMethodWhereFacesTie) {
  const auto exact = make_exact_algorithm();
  const Mesh ring = load_model("circular-box-960");
  const Mesh box = load_model("box-500");
  const Mesh rough = test::rough_mesh(load_model("box-2000"));
  const Grid grid = make_grid("45/90");
  for (const auto& [a, b] : {std::pair(&ring, &ring),
                             {&ring, &box},
                             {&box, &ring},
                             {&box, &box},
                             {&rough, &rough},
                             {&rough, &ring},
                             {&ring, &rough}}) {
    const auto solver = make_ray_cast()->prepare(*a, *b);
    const auto expected_solver = make_sphere_method(*exact)->prepare(*a, *b);
    const std::vector<double> targets = some_targets(*a);
    Ray ray{std::vector<double>(targets.size()), std::vector<double>(targets.size())};
    Ray expected = ray;
    for (const std::uint32_t r : DistinctRotations(grid.rotations).first) {
      solver->set_rotation(grid.rotations[r]);
      expected_solver->set_rotation(grid.rotations[r]);
      for (const Eigen::Vector3d& u : grid.directions) {
        solver->solve(u, targets, ray.translations, ray.residual);
        expected_solver->solve(u, targets, expected.translations, expected.residual);
        for (std::size_t k = 0; k < targets.size(); ++k) {
          ASSERT_EQ(std::isnan(ray.translations[k]), std::isnan(expected.translations[k]))
              << r << ", " << u.transpose();
          if (std::isnan(ray.translations[k])) continue;
          EXPECT_NEAR(ray.translations[k], expected.translations[k], k_same_translation * a->diagonal())
              << r << ", " << u.transpose();
        }
      }
    }
  }
}

/// Buckets of 30, 29, .. 0 %.
std::vector<double> all_targets(const Mesh& a) {
  std::vector<double> targets;
  for (int percent = 30; percent >= 0; --percent) targets.push_back(distance_bucket(a, percent).target);
  return targets;
}

/// Exact distances per configuration, a count that is the same on every machine: 7.4, and 18 without axes across the
/// ray.
constexpr double k_most_distances = 12.0;

TEST(RayCast, TrianglesThatPassEachOtherTakeNoExactDistances) {
  const Mesh ring = load_model("torus-2000");
  const Mesh speck = boxes_mesh({{{0.3, 0.1, -0.2}, {0.01, 0.008, 0.006}}});
  const Grid grid = make_grid("60/60");
  const std::vector<double> targets = all_targets(ring);
  const auto solver = make_ray_cast()->prepare(ring, speck);
  std::vector<double> translations(targets.size()), residuals(targets.size());
  std::size_t configurations = 0;
  for (const std::uint32_t r : DistinctRotations(grid.rotations).first) {
    solver->set_rotation(grid.rotations[r]);
    for (const Eigen::Vector3d& u : grid.directions) {
      solver->solve(u, targets, translations, residuals);
      configurations += targets.size();
    }
  }
  EXPECT_LT(static_cast<double>(solver->measurements()) / static_cast<double>(configurations), k_most_distances);
}

TEST(RayCast, TargetsMayRepeat) {
  const Mesh a = load_model("torus-knot-600");
  const auto solver = make_ray_cast()->prepare(a, a);
  std::vector<double> targets = all_targets(a);
  const std::vector<double> once = targets;
  for (const double target : once) targets.insert(targets.end(), {target, target});
  std::ranges::sort(targets, std::greater{});
  std::vector<double> translations(targets.size()), residuals(targets.size());
  std::vector<double> translations_once(once.size()), residuals_once(once.size());
  std::mt19937_64 random(71);
  for (int i = 0; i < 20; ++i) {
    solver->set_rotation(random_rotation(random));
    for (int n = 0; n < 5; ++n) {
      const Eigen::Vector3d u = random_direction(random);
      solver->solve(u, once, translations_once, residuals_once);
      solver->solve(u, targets, translations, residuals);
      for (std::size_t k = 0; k < targets.size(); ++k) {
        EXPECT_NEAR(translations[k], translations_once[k / 3], k_same_translation * a.diagonal());
      }
    }
  }
}

bool same_bits(const Generated& left, const Generated& right) {
  bool same = left.buckets.size() == right.buckets.size();
  for (std::size_t k = 0; same && k < left.buckets.size(); ++k) {
    const std::vector<double>& x = left.buckets[k].translations;
    const std::vector<double>& y = right.buckets[k].translations;
    same = x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0 &&
           left.buckets[k].summary.largest_residual == right.buckets[k].summary.largest_residual;
  }
  return same;
}

const std::vector<double> k_percents{30, 12, 11, 1, 0};

/// Pairs of a smooth and a flat body, and of a body with itself on which faces tie.
class RayCastBits : public testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  const Mesh a = load_model(GetParam().first);
  const Mesh b = load_model(GetParam().second);
};
INSTANTIATE_TEST_SUITE_P(Pairs, RayCastBits,
                         testing::Values(std::pair("torus-knot-2000", "box-300"),
                                         std::pair("circular-box-1000", "circular-box-1000")));

TEST_P(RayCastBits, ThreadsAndShardsDoNotChangeABit) {
  const Grid grid = make_grid("90/60");
  const auto generator = make_ray_cast();
  const Generated whole = generate_distances(*generator, a, b, grid, k_percents, {.threads = 1});
  const Generated threaded = generate_distances(*generator, a, b, grid, k_percents, {.threads = 2});
  EXPECT_TRUE(same_bits(whole, threaded));
  EXPECT_EQ(whole.measurements, threaded.measurements);
  const std::size_t n = grid.directions.size();
  for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>(0, 50), {50, 101}, {101, 144}}) {
    const Generated shard = generate_distances(*generator, a, b, grid, k_percents, {}, test::indices(first, last));
    for (std::size_t k = 0; k < k_percents.size(); ++k) {
      ASSERT_EQ(shard.buckets[k].translations.size(), (last - first) * n);
      EXPECT_EQ(std::memcmp(shard.buckets[k].translations.data(), whole.buckets[k].translations.data() + first * n,
                            (last - first) * n * sizeof(double)),
                0);
    }
  }
}

TEST_P(RayCastBits, EveryInstructionSetGivesTheSameBits) {
  const Grid grid = make_grid("60/90");
  const auto run = [&] { return generate_distances(*make_ray_cast(), a, b, grid, k_percents, {.threads = 1}); };
  const Generated standard = run();
  int tried = 0;
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const Generated here = run();
    EXPECT_TRUE(same_bits(here, standard)) << hwy::TargetName(targets & -targets);
    EXPECT_EQ(here.measurements, standard.measurements);
    ++tried;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(tried, 2);  // at least a SIMD and a scalar path
}

}  // namespace
}  // namespace sixdof
