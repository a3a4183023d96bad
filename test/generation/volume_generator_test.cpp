#include <sixdof/generation/volume_generator.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <hwy/targets.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/configuration/verification.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>
#include <sixdof/oracle/overlap.h>

#include "../configuration/shapes.h"

namespace sixdof {
namespace {

constexpr double k_stops = 1e-8;         // of a translation, at which the search stops
constexpr double k_tessellation = 0.15;  // relative: a lens of balls of few triangles

using test::same_bits;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

const std::unique_ptr<Algorithm> k_brute_force = make_brute_force_algorithm();

const std::unique_ptr<DistanceGenerator> k_touching = make_sphere_method(*k_brute_force);
const std::vector<double> k_percents{0, 10, 1, 5};

/// A grid of one configuration.
Grid single(const Eigen::Vector3d& direction, const Eigen::Vector4d& rotation) {
  Grid grid;
  grid.spec = "single";
  grid.directions = {direction};
  grid.rotations = {rotation};
  return grid;
}

/// A sphere cut into `rings` parallels and twice as many meridians.
Mesh ball_mesh(double r, std::size_t rings, const Eigen::Vector3d& center, const std::string& name) {
  std::vector<Eigen::Vector3d> vertices{center + Eigen::Vector3d(0, 0, r)};
  std::vector<Triangle> triangles;
  const auto columns = static_cast<std::uint32_t>(2 * rings);
  for (std::size_t i = 1; i < rings; ++i) {
    const double polar = std::numbers::pi * static_cast<double>(i) / static_cast<double>(rings);
    for (std::uint32_t k = 0; k < columns; ++k) {
      const double azimuth = 2.0 * std::numbers::pi * k / columns;
      vertices.emplace_back(center + r * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                         std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  const auto last = static_cast<std::uint32_t>(vertices.size());
  vertices.emplace_back(center - Eigen::Vector3d(0, 0, r));
  for (std::uint32_t k = 0; k < columns; ++k) {
    const std::uint32_t next = (k + 1) % columns;
    triangles.push_back({0, 1 + k, 1 + next});
    triangles.push_back({last, last - columns + next, last - columns + k});
    for (std::uint32_t i = 0; i + 2 < rings; ++i) {
      const std::uint32_t up = 1 + i * columns, down = up + columns;
      triangles.push_back({up + k, down + k, down + next});
      triangles.push_back({up + k, down + next, up + next});
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), name);
}

const Bucket& bucket_of(const Generated& result, double percent) {
  for (const Bucket& bucket : result.buckets) {
    if (bucket.summary.key == BucketKey{BucketKind::volume, percent}) return bucket;
  }
  throw BadArgument("no such bucket");
}

TEST(VolumeGenerator, BoxesMeetTheirClosedForm) {
  const Mesh a = test::boxes_mesh({{{1.0, -2.0, 0.5}, {0.7, 0.6, 0.5}}}, "a");
  const Mesh b = test::boxes_mesh({{{0.3, 0.1, 4.0}, {0.4, 0.35, 0.45}}}, "b");
  // Rotated by 0 and 180 degrees about z: the boxes stay parallel to the axes.
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const Eigen::Vector4d& q : {Eigen::Vector4d(1, 0, 0, 0), Eigen::Vector4d(0, 0, 0, 1)}) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d half_a = 0.5 * first->box().sizes(), half_b = 0.5 * second->box().sizes();
        const Eigen::Vector3d common = 2.0 * half_a.cwiseMin(half_b);
        const double section = common.prod() / common[axis];
        const Generated result =
            generate_volumes(*k_touching, *first, *second, single(Eigen::Vector3d::Unit(axis), q), k_percents);
        const double contact = half_a[axis] + half_b[axis];
        // Bucket 0 is k_contact_target outside contact.
        EXPECT_NEAR(bucket_of(result, 0).translations[0], contact, 2 * k_contact_target * first->diagonal());
        for (const int percent : {1, 5, 10}) {
          const Bucket& bucket = bucket_of(result, percent);
          const double volume = 0.01 * percent * first->volume();
          EXPECT_DOUBLE_EQ(bucket.summary.nominal, volume);
          EXPECT_NEAR(bucket.translations[0], contact - volume / section,
                      k_volume_tolerance * first->volume() / section);
        }
      }
    }
  }
}

TEST(VolumeGenerator, BallsMeetTheirLens) {
  // Volume common to two balls at distance d: pi (R + r - d)^2 (d^2 + 2 d (R + r) - 3 (R - r)^2) / (12 d).
  const double big = 1.0, small = 0.8;
  const Mesh a = ball_mesh(big, 24, {0.2, 0.1, -3.0}, "big");
  const Mesh b = ball_mesh(small, 24, {1.0, 0.0, 0.3}, "small");
  std::mt19937_64 random(7);
  const auto exact = make_exact_algorithm();
  const auto touching = make_sphere_method(*exact);
  const auto lens = [&](double d) {
    const double depth = big + small - d;
    return std::numbers::pi * depth * depth * (d * d + 2 * d * (big + small) - 3 * (big - small) * (big - small)) /
           (12 * d);
  };
  for (int i = 0; i < 3; ++i) {
    const Generated result = generate_volumes(
        *touching, a, b, single(test::random_direction(random), test::random_rotation(random)), k_percents);
    for (const int percent : {5, 10}) {
      // The facets of 24 rings reduce a ball's volume by 0.9 %, that of the lens by up to a tenth.
      const double expected = 0.01 * percent * a.volume();
      EXPECT_NEAR(lens(bucket_of(result, percent).translations[0]) / expected, 1.0, k_tessellation) << percent;
    }
  }
}

/// Compares all translations of every bucket with brute force: the volume there by columns, and none as large before,
/// by small steps.
void expect_right(const Mesh& a, const Mesh& b, const Grid& grid, const Generated& result, double step) {
  std::size_t reachable = 0;
  for (const Bucket& bucket : result.buckets) {
    if (bucket.summary.key.percent == 0) continue;
    for (std::size_t r = 0; r < grid.rotations.size(); ++r) {
      ConfigurationRay ray(a, b, grid.rotations[r]);
      for (std::size_t u = 0; u < grid.directions.size(); ++u) {
        ray.direction = grid.directions[u];
        const double s = bucket.translations[r * grid.directions.size() + u];
        const double end = std::isnan(s) ? 0.0 : s;
        if (!std::isnan(s)) {
          ++reachable;
          EXPECT_NEAR(overlap_volume_by_columns(a, b, ray.pose(s)), bucket.summary.target, bucket.summary.tolerance);
        }
        for (double t = 0.5 * (a.diagonal() + b.diagonal()); t > end; t -= step) {
          EXPECT_LE(overlap_volume_by_columns(a, b, ray.pose(t)), bucket.summary.target + bucket.summary.tolerance)
              << bucket.summary.key.name() << " at " << s << " is passed before, at " << t;
        }
      }
    }
  }
  EXPECT_GT(reachable, 0u);
}

TEST(VolumeGenerator, NoEarlierHitByMarching) {
  const Mesh a = test::lump_mesh(3, {0.4, -0.2, 1.0});
  const Mesh b = test::tetrahedron_mesh({2.0, 0.2, 3.0}, 2.1);
  std::mt19937_64 random(11);
  Grid grid = single(test::random_direction(random), test::random_rotation(random));
  for (int i = 0; i < 3; ++i) grid.directions.push_back(test::random_direction(random));
  grid.rotations.push_back(test::random_rotation(random));
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    expect_right(*first, *second, grid, generate_volumes(*k_touching, *first, *second, grid, k_percents),
                 0.01 * a.diagonal());
  }
}

TEST(VolumeGenerator, FirstCrossingWhereTheVolumeFallsAgain) {
  // B, a slab, passes through A's thin outer wall before it reaches the block: V rises to the wall's volume, falls to
  // zero, and rises again up to the slab's volume.
  const Mesh a = test::boxes_mesh({{{3.0, 0, 0}, {0.1, 0.5, 0.5}}, {{-0.5, 0, 0}, {1.7, 0.5, 0.5}}}, "wall and block");
  const Mesh b = test::boxes_mesh({{{0.2, 0.1, 0}, {0.15, 0.7, 0.6}}}, "slab");
  const double wall = 0.2 * 1.0 * 1.0;
  ASSERT_GT(wall, 0.05 * a.volume());
  ASSERT_LT(wall, 0.06 * a.volume());
  const Generated result = generate_volumes(*k_touching, a, b, single(Eigen::Vector3d::UnitX(), {1, 0, 0, 0}),
                                            std::vector<double>{0, 5, 6, 7, 8, 10});
  // Translations are from the centre of A's box.
  const double outer = 3.1 + 0.15 - a.center().x(), block = 1.2 + 0.15 - a.center().x();
  for (const int percent : {5, 6, 7, 8}) {
    const double volume = 0.01 * percent * a.volume();
    EXPECT_NEAR(bucket_of(result, percent).translations[0], (volume < wall ? outer : block) - volume, k_stops)
        << percent;
  }
  // More than the slab's volume inside the block.
  EXPECT_TRUE(std::isnan(bucket_of(result, 10).translations[0]));
}

TEST(VolumeGenerator, UnreachableTargetsAreNaN) {
  // B has less than 2 % of A's volume.
  const Mesh a = test::boxes_mesh({{{1.0, 0.5, 0}, {1.0, 0.9, 1.1}}}, "a");
  const Mesh thin = test::boxes_mesh({{{0, 0, 2.0}, {0.02, 0.8, 1.0}}}, "thin");
  std::mt19937_64 random(5);
  const Grid grid = single(test::random_direction(random), test::random_rotation(random));
  const Generated result = generate_volumes(*k_touching, a, thin, grid, k_percents);
  EXPECT_FALSE(std::isnan(bucket_of(result, 0).translations[0]));
  EXPECT_FALSE(std::isnan(bucket_of(result, 1).translations[0]));
  EXPECT_TRUE(std::isnan(bucket_of(result, 5).translations[0]));
  EXPECT_TRUE(std::isnan(bucket_of(result, 10).translations[0]));

  // At s = 0 B's centre is between A's two blocks, which it hardly overlaps.
  const Mesh blocks = test::boxes_mesh({{{2.0, 0, 0}, {0.5, 0.5, 0.5}}, {{-2.0, 0, 0}, {0.5, 0.5, 0.5}}}, "blocks");
  const Mesh bar = test::boxes_mesh({{{0, 0, 0}, {1.51, 0.3, 0.3}}}, "bar");
  const Generated gap =
      generate_volumes(*k_touching, blocks, bar, single(Eigen::Vector3d::UnitY(), {1, 0, 0, 0}), k_percents);
  EXPECT_FALSE(std::isnan(bucket_of(gap, 0).translations[0]));
  for (const int percent : {1, 5, 10}) EXPECT_TRUE(std::isnan(bucket_of(gap, percent).translations[0]));
}

void expect_same_bits_from_threads_and_shards(const Mesh& a) {
  const Grid grid = make_grid("90");
  const auto generate = [&](const RunOptions& run, const std::vector<std::uint32_t>& rotations = {}) {
    return generate_volumes(*k_touching, a, a, grid, k_percents, run, rotations);
  };
  const Generated whole = generate({.threads = 1});
  const Generated threaded = generate({.threads = 2});
  EXPECT_EQ(whole.measurements, threaded.measurements);
  const std::size_t n = grid.directions.size();
  for (std::size_t k = 0; k < k_percents.size(); ++k) {
    EXPECT_EQ(whole.buckets[k].summary.key.percent, k_percents[k]);
    EXPECT_TRUE(same_bits(whole.buckets[k].translations, threaded.buckets[k].translations));
  }
  for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>(0, 13), {13, 48}}) {
    const Generated shard = generate({}, test::indices(first, last));
    for (std::size_t k = 0; k < k_percents.size(); ++k) {
      const std::vector<double>& all = whole.buckets[k].translations;
      EXPECT_TRUE(same_bits(shard.buckets[k].translations, std::span(all).subspan(first * n, (last - first) * n)));
    }
  }
}

TEST(VolumeGenerator, ThreadsAndShardsDoNotChangeABit) {
  expect_same_bits_from_threads_and_shards(test::lump_mesh(3, {0.4, -0.2, 1.0}));
  // Faces coincide at rotations by right angles.
  expect_same_bits_from_threads_and_shards(load_model("box-48"));
}

TEST(VolumeGenerator, EveryInstructionSetGivesTheSameBits) {
  const Mesh a = load_model("torus-knot-2000");
  const Mesh b = load_model("box-300");
  const Grid grid = make_grid("60/90");
  const auto touching = make_ray_cast();
  const auto run = [&] { return generate_volumes(*touching, a, b, grid, k_percents, {.threads = 1}); };
  const Generated standard = run();
  int tried = 0;
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const Generated here = run();
    for (std::size_t k = 0; k < k_percents.size(); ++k) {
      EXPECT_TRUE(same_bits(here.buckets[k].translations, standard.buckets[k].translations))
          << hwy::TargetName(targets & -targets);
    }
    EXPECT_EQ(here.measurements, standard.measurements);
    ++tried;
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  EXPECT_GE(tried, 2);  // At least a SIMD and a scalar target.
}

TEST(VolumeGenerator, BodiesWithPartsThatFloatsBlurMeetTheirTargets) {
  // A block, and away from it a ball of a hundred-thousandth of its size: floats do not tell the ball's triangles
  // apart, so that candidates are searched in doubles where two balls meet on the way.
  const Mesh block = make_box({.size = {1000.0, 1000.0, 1000.0}}, 12);
  const Mesh ball = ball_mesh(0.01, 30, {1500.0, 0.0, 0.0}, "ball");
  std::vector<Eigen::Vector3d> vertices = block.vertices();
  std::vector<Triangle> triangles = block.triangles();
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), ball.vertices().begin(), ball.vertices().end());
  for (const Triangle& t : ball.triangles()) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Mesh body = Mesh::build(vertices, triangles);

  const auto touching = make_ray_cast();
  const std::vector<double> percents{0.001};
  const Grid grid = make_grid("90");
  const Generated result = generate_volumes(*touching, body, body, grid, percents);
  const Tree tree(body);
  const Solid solid(body, tree);
  OverlapQuery query(solid, solid);
  const double target = 1e-5 * body.volume();
  std::size_t reachable = 0;
  for (std::size_t i = 0; i < result.buckets[0].translations.size(); ++i) {
    const double s = result.buckets[0].translations[i];
    if (std::isnan(s)) continue;
    ++reachable;
    ConfigurationRay ray(body, body, grid.rotations[i / grid.directions.size()]);
    ray.direction = grid.directions[i % grid.directions.size()];
    EXPECT_NEAR(query.evaluate(ray.pose(s)).volume, target, k_volume_tolerance * body.volume()) << i;
  }
  EXPECT_GT(reachable, 100u);
}

TEST(VolumeGenerator, FewMeasurementsMeetABucket) {
  // A bucket takes one measurement where it is predicted and one or two where the cubics meet it. The others divide
  // intervals in which the bounds do not exclude an earlier hit, most of them in coarse meshes of many parts.
  const std::vector<double> percents{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const auto touching = make_ray_cast();
  for (const char* name : {"bumpy-sphere-8k", "torus-knot-8k"}) {
    const Mesh a = load_model(name);
    const Generated result = generate_volumes(*touching, a, a, make_grid("so3:2:12"), percents);
    std::size_t reachable = 0;
    for (const Bucket& bucket : result.buckets) {
      reachable +=
          static_cast<std::size_t>(std::ranges::count_if(bucket.translations, [](double s) { return !std::isnan(s); }));
    }
    ASSERT_GT(reachable, 200u);
    constexpr double k_most_per_bucket = 5.0;
    EXPECT_LT(static_cast<double>(result.measurements) / static_cast<double>(reachable), k_most_per_bucket) << name;
  }
}

/// Crossing plates overlap by less than a percent of their volume, which follows from their boxes: nothing is measured.
TEST(VolumeGenerator, CrossingPlatesTakeNoMeasurements) {
  const Mesh plate = make_box({.size = {2.0, 1.6, 0.002}}, 12);
  const Grid grid = make_grid("90");
  const std::vector<double> percents{1, 2, 5};
  const auto touching = make_ray_cast();
  const Generated result = generate_volumes(*touching, plate, plate, grid, percents);
  const auto solver = volume_solvers(*touching, plate, plate)();
  std::size_t crossing = 0;
  std::uint64_t before = 0;
  for (const Eigen::Vector4d& rotation : grid.rotations) {
    const double across = std::abs(ConfigurationRay(plate, plate, rotation).R(2, 2));
    solver->set_rotation(rotation);
    for (const Eigen::Vector3d& direction : grid.directions) {
      const std::array<double, 3> targets{0.01 * plate.volume(), 0.02 * plate.volume(), 0.05 * plate.volume()};
      std::array<double, 3> translations{}, residuals{};
      solver->solve(direction, targets, translations, residuals);
      const std::uint64_t measured = solver->measurements() - std::exchange(before, solver->measurements());
      if (across > 0.5) continue;
      ++crossing;
      EXPECT_TRUE(std::isnan(translations[0]));
      EXPECT_EQ(measured, 0u);
    }
  }
  EXPECT_GT(crossing, 50u);
  EXPECT_GT(result.measurements, 0u);  // Parallel plates are measured.
}

TEST(VolumeGenerator, RefusesMeshesThatAreNotSolids) {
  const Mesh a = test::lump_mesh(3, {0.4, -0.2, 1.0});
  std::vector<Triangle> triangles = a.triangles();
  triangles.pop_back();
  const Mesh open = Mesh::build(a.vertices(), triangles, "open-lump");
  const Grid grid = make_grid("90");
  for (const auto& [first, second] : {std::pair(&a, &open), std::pair(&open, &a)}) {
    const Mesh &left = *first, &right = *second;
    EXPECT_THAT([&] { generate_volumes(*k_touching, left, right, grid, k_percents); },
                ThrowsMessage<BadMesh>(testing::AllOf(HasSubstr("open-lump"), HasSubstr("border"))));
  }
  EXPECT_THAT(
      [&] {
        generate_volumes(*k_touching, a, a, grid, std::vector{5.0, 5.0});
      },
      ThrowsMessage<BadArgument>(HasSubstr("volume 5 %")));
  EXPECT_THAT([&] { generate_volumes(*k_touching, a, a, grid, std::vector{101.0}); },
              ThrowsMessage<BadArgument>(HasSubstr("volume 101 %")));
}

using Edit = std::function<void(std::vector<Bucket>&)>;

Verdict verify_after(const Edit& edit) {
  static const Mesh a =
      test::boxes_mesh({{{1.1, 0.3, 0}, {0.1, 0.4, 0.3}}, {{-0.9, 0.3, 0}, {0.4, 0.4, 0.3}}}, "walls");
  static const Mesh b = test::lump_mesh(5, {0, 3.0, 0});
  static const Grid grid = make_grid("90");
  static const Generated honest = generate_volumes(*k_touching, a, b, grid, std::vector<double>{0, 2, 10});
  std::vector<Bucket> buckets = honest.buckets;
  edit(buckets);
  const auto path = std::filesystem::path(testing::TempDir()) /
                    (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
                     std::to_string(::getpid()) + "_volumes.h5");
  ConfigurationSetWriter writer(
      path, {.generator_version = "0", .a = MeshIdentity::of(a), .b = MeshIdentity::of(b), .grid = grid});
  for (const Bucket& bucket : buckets) writer.write(bucket.summary, bucket.translations);
  writer.commit();
  const ConfigurationSet set(path);
  for (const Bucket& bucket : buckets) {
    EXPECT_TRUE(same_bits(set.read(bucket.summary.key), bucket.translations));
    EXPECT_EQ(set.summary(bucket.summary.key).target, bucket.summary.target);
  }
  const Verdict verdict = verify_set(set, a, b, *k_brute_force, {.size = 40, .seed = 5});
  std::filesystem::remove(path);
  return verdict;
}

TEST(VolumeVerification, FindsNothingWrongWithAnHonestSet) {
  const Verdict verdict = verify_after([](auto&) {});
  EXPECT_THAT(verdict.problems, IsEmpty());
  ASSERT_EQ(verdict.buckets.size(), 3u);
  EXPECT_EQ(verdict.buckets[0].oracle, "brute-force");
  EXPECT_EQ(verdict.buckets[1].oracle, "columns");
  for (const BucketVerdict& bucket : verdict.buckets) EXPECT_GT(bucket.reachable, 0u);
}

TEST(VolumeVerification, FindsWhatIsWrong) {
  const auto shifted = [](std::size_t k, double by) {
    return [k, by](std::vector<Bucket>& buckets) {
      for (double& s : buckets[k].translations) s += by;
    };
  };
  const Verdict outside = verify_after(shifted(1, 1e-6));
  EXPECT_GT(outside.buckets[1].wrong_value, 0u);
  EXPECT_EQ(outside.buckets[2].wrong_value + outside.buckets[2].earlier_hit + outside.buckets[2].false_nan, 0u);
  // Half a wall farther inwards, past the hit.
  const Verdict deeper = verify_after(shifted(1, -0.05));
  EXPECT_GT(deeper.buckets[1].earlier_hit, 0u);
  const Verdict nan = verify_after([](auto& buckets) {
    for (double& s : buckets[1].translations) s = std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_GT(nan.buckets[1].false_nan, 0u);
  EXPECT_THAT(nan.problems, testing::Contains(HasSubstr("is met at")));
  const Verdict target = verify_after([](auto& buckets) { buckets[2].summary.target *= 1.01; });
  EXPECT_THAT(target.problems, testing::Contains(HasSubstr("of the volume")));
}

}  // namespace
}  // namespace sixdof
