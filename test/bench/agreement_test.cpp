// The mean time that sixdof-bench reports against FCL called in a plain loop over the same poses; and the time of
// `null`, which is the harness's own. Bounds are wide, because other work may run on the machine.

#include <algorithm>
#include <ctime>
#include <fstream>

#include <benchmark/benchmark.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/models/model_catalogue.h>

#include "../cli/run_program.h"
#include "../configuration/small_suite.h"

namespace sixdof {
namespace {

/// Noise between runs of one program is some 30 %.
constexpr double k_widest_ratio = 2.0;
/// Interleaved measurements of each kind; the smallest are compared, since noise only adds time.
constexpr int k_repetitions = 5;
/// A call through the interface and an answer of 60 bytes, as a part of a query of FCL's: a few hundredths, with room
/// for sanitizers and unoptimised builds.
constexpr double k_most_overhead = 0.5;

/// Few poses, so that an interleaved round is short.
constexpr std::size_t k_sample = 64;

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> fcl_model(const Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const Triangle& t : mesh.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(mesh.vertices(), triangles);
  model->endModel();
  return model;
}

struct Agreement : ::testing::TestWithParam<std::string> {
  double harness_ns(const std::string& row) const {
    const auto run = test::run_program(
        fmt::format("{} --manifest {} --seed 1 --sample {} --benchmark_format=json --benchmark_filter=^{}$",
                    SIXDOF_BENCH_PROGRAM, SIXDOF_SMALL_SUITE "/manifest.json", k_sample, row));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(run.out).at("benchmarks").at(0).at("cpu_time");
  }
};

double plain_ns(const std::string& question, const Model& model, const std::vector<fcl::Transform3d>& poses) {
  const fcl::Transform3d identity = fcl::Transform3d::Identity();
  const fcl::CollisionRequestd first_contact(1);
  const fcl::DistanceRequestd nearest_points(true);
  // Processor time, as Google Benchmark's cpu_time.
  const std::clock_t start = std::clock();
  std::size_t asked = 0;
  while (std::clock() - start < CLOCKS_PER_SEC / 10) {
    for (const auto& pose : poses) {
      if (question == "collide") {
        fcl::CollisionResultd result;
        fcl::collide<double>(&model, identity, &model, pose, first_contact, result);
        benchmark::DoNotOptimize(result);
      } else {
        fcl::DistanceResultd result;
        fcl::distance<double>(&model, identity, &model, pose, nearest_points, result);
        benchmark::DoNotOptimize(result);
      }
      ++asked;
    }
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC * 1e9 / static_cast<double>(asked);
}

TEST_P(Agreement, OfHarnessAndPlainLoop) {
  const Mesh mesh = load_model("torus-1k");
  const ConfigurationSet set(SIXDOF_SMALL_SUITE "/torus-1k.h5");
  const BucketSample bucket = sample_bucket(set, {BucketKind::distance, 5}, mesh, mesh, k_sample, 1);
  std::vector<fcl::Transform3d> poses;
  for (const std::size_t i : random_order(bucket.poses.size(), 1)) {
    const Pose& pose = bucket.poses[i];
    poses.push_back(fcl::Transform3d::Identity());
    poses.back().linear() = pose.R;
    poses.back().translation() = pose.t;
  }
  const auto model = fcl_model(mesh);
  double plain = 1e300, harness = 1e300;
  for (int i = 0; i < k_repetitions; ++i) {
    plain = std::min(plain, plain_ns(GetParam(), *model, poses));
    harness = std::min(harness, harness_ns(GetParam() + "/algorithm:fcl-obbrss/pair:torus-1k/distance:05"));
  }
  const double ratio = harness / plain;
  fmt::print("{}: plain loop {:.0f} ns, harness {:.0f} ns, ratio {:.3f}\n", GetParam(), plain, harness, ratio);
  EXPECT_GT(ratio, 1 / k_widest_ratio);
  EXPECT_LT(ratio, k_widest_ratio);
}

TEST_P(Agreement, OfNullAndNothing) {
  double null = 1e300, fcl = 1e300;
  for (int i = 0; i < k_repetitions; ++i) {
    null = std::min(null, harness_ns(GetParam() + "/algorithm:null/pair:torus-1k/distance:05"));
    fcl = std::min(fcl, harness_ns(GetParam() + "/algorithm:fcl-obbrss/pair:torus-1k/distance:05"));
  }
  fmt::print("{}: the harness costs {:.1f} ns per query\n", GetParam(), null);
  EXPECT_LT(null, k_most_overhead * fcl);
}

INSTANTIATE_TEST_SUITE_P(Both, Agreement, ::testing::Values("collide", "distance"),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace sixdof
