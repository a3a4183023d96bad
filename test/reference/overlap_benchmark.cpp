#include <map>
#include <memory>
#include <random>
#include <stdexcept>

#include <benchmark/benchmark.h>
#include <cgal_overlap.h>

#include <sixdof/oracle/candidates.h>

#include "../oracle/bodies.h"

/// The time of the exact overlap and of CGAL's corefinement at the same poses of the same meshes. Their volumes are
/// compared first. Structures are prepared outside the timed region; corefinement's copies of its arguments, which it
/// changes, are inside.
namespace sixdof {
namespace {

constexpr std::size_t k_poses = 8;
/// Largest difference of the volumes that counts as agreement, relative to A's volume.
constexpr double k_agreement = 1e-12;

struct Pair {
  bodies::Body body;
  std::vector<Pose> poses;
  reference::CgalOverlap cgal;
  std::vector<std::vector<std::array<double, 3>>> vertices_b;  // in A's frame, per pose

  /// Random rotations and directions; B is translated until the overlap is `fraction` of A's volume.
  Pair(Mesh mesh, double fraction)
      : body(std::move(mesh)), cgal(reference::to_cgal(body.mesh), reference::to_cgal(body.mesh)) {
    std::mt19937_64 random(20261121);
    OverlapQuery query(body.solid, body.solid);
    while (poses.size() < k_poses) {
      Pose X_AB = bodies::random_pose(random, 0.0);
      const Eigen::Vector3d u = bodies::random_pose(random, 0.0).R.col(0);
      double inner = 0.0, outer = body.mesh.diagonal();
      constexpr int k_bisections = 30;
      for (int i = 0; i < k_bisections; ++i) {
        const double middle = 0.5 * (inner + outer);
        X_AB.t = body.mesh.center() + middle * u - X_AB.R * body.mesh.center();
        (query.evaluate(X_AB).volume > fraction * body.mesh.volume() ? inner : outer) = middle;
      }
      if (query.evaluate(X_AB).crossings > 0) poses.push_back(X_AB);
    }
    for (const Pose& X_AB : poses) {
      auto& points = vertices_b.emplace_back();
      for (const Eigen::Vector3d& p : body.mesh.vertices()) {
        const Eigen::Vector3d q = transform_point(X_AB, p);
        points.push_back({q.x(), q.y(), q.z()});
      }
    }
    if (std::abs(query.evaluate(poses[0]).volume - cgal.volume(vertices_b[0])) > k_agreement * body.mesh.volume()) {
      throw std::runtime_error("the exact overlap and corefinement disagree");
    }
  }
};

const Pair& pair_of(std::int64_t triangles, std::int64_t percent) {
  static std::map<std::pair<std::int64_t, std::int64_t>, std::unique_ptr<Pair>> pairs;
  auto& pair = pairs[{triangles, percent}];
  if (!pair) {
    const auto n = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 4.0)));
    pair = std::make_unique<Pair>(bodies::bumpy_torus(2 * n, n), 0.01 * static_cast<double>(percent));
  }
  return *pair;
}

void exact(benchmark::State& state) {
  const Pair& pair = pair_of(state.range(0), state.range(1));
  OverlapQuery query(pair.body.solid, pair.body.solid);
  std::size_t crossings = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    const Overlap o = query.evaluate(pair.poses[i++ % k_poses]);
    crossings += o.crossings;
    benchmark::DoNotOptimize(o.volume);
  }
  state.counters["crossings"] = static_cast<double>(crossings) / static_cast<double>(state.iterations());
}

void corefinement(benchmark::State& state) {
  const Pair& pair = pair_of(state.range(0), state.range(1));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(pair.cgal.volume(pair.vertices_b[i++ % k_poses]));
}

/// Generic, because the type's namespace depends on the version.
constexpr auto sizes = [](auto* b) {
  b->ArgNames({"triangles", "volume"})->Unit(benchmark::kMillisecond);
  for (const std::int64_t triangles : {1000, 10000, 100000}) {
    for (const std::int64_t percent : {1, 3, 10}) b->Args({triangles, percent});
  }
};

BENCHMARK(exact)->Name("oracle/overlap/by:exact")->Apply(sizes)->Args({1000000, 10});
BENCHMARK(corefinement)->Name("oracle/overlap/by:corefinement")->Apply(sizes);

}  // namespace
}  // namespace sixdof

BENCHMARK_MAIN();
