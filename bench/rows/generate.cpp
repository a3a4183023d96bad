#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/generation/ray_cast.h>
#include <sixdof/generation/sphere_method.h>
#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_sample.h>
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

constexpr std::size_t k_runs = 4;  ///< Of RayRuns::k_length rays each, with all the paper's buckets.
constexpr const char* k_fcl = "fcl-rss";

/// Copies of one recipe, where cost is to be seen against size.
constexpr const char* k_recipes[] = {"torus-knot-10k",   "torus-knot-100k",   "torus-knot-1m",
                                     "bumpy-sphere-10k", "bumpy-sphere-100k", "bumpy-sphere-1m",
                                     "gyroid-ball-10k",  "gyroid-ball-100k",  "gyroid-ball-1m"};

enum class Method {
  raycast,
  fcl,        ///< Plain conservative advancement.
  fcl_sweep,  ///< Certified steps that go on from bucket to bucket.
  overlap
};
constexpr Method k_methods[] = {Method::raycast, Method::fcl, Method::fcl_sweep, Method::overlap};

bool is_fcl(Method method) { return method == Method::fcl || method == Method::fcl_sweep; }

struct MethodWords {
  BucketKind kind;
  const char* name;  ///< In the row's name.
  const char* grid;
};

MethodWords words(Method method) {
  switch (method) {
    case Method::raycast:
      return {BucketKind::distance, "raycast", "paper"};
    case Method::fcl:
      return {BucketKind::distance, "fcl", "paper"};
    case Method::fcl_sweep:
      return {BucketKind::distance, "fcl-sweep", "paper"};
    case Method::overlap:
      break;
  }
  return {BucketKind::volume, "overlap", "paper-volume"};
}

/// A generator with one solver. Both are large for large meshes, so all rows share one object of this type.
struct Generator {
  std::string row;
  std::unique_ptr<DistanceGenerator> distances;
  std::unique_ptr<VolumeGenerator> volumes;
  std::unique_ptr<RaySolver> solver;  // declared last: it refers to the others
};

class GenerateRow {
 public:
  GenerateRow(const Resources& resources, Method method, std::string pair, std::string a, std::string b,
              std::shared_ptr<Generator> generator)
      : resources_(resources),
        method_(method),
        pair_(std::move(pair)),
        a_(std::move(a)),
        b_(std::move(b)),
        generator_(std::move(generator)) {}

  std::string name() const {
    return fmt::format("generate/{}/algorithm:{}/pair:{}", to_string(words(method_).kind), words(method_).name, pair_);
  }

  /// One iteration is one pass over the rays. The row's own time contains more than the counter: the rays that warm up,
  /// and the cost of setting a rotation for a few rays instead of all.
  void run(benchmark::State& state) {
    RaySolver& solver = prepare();
    const Grid grid = make_grid(words(method_).grid);
    const std::vector<double> targets = bucket_targets();
    double seconds = 0.0;
    std::size_t rays = 0;
    for ([[maybe_unused]] auto _ : state) {
      RayRuns runs(grid, resources_.seed);
      for (std::size_t i = 0; i < k_runs; ++i) {
        const RunCost cost = time_run(solver, grid, runs.next(), targets);
        const double fraction = static_cast<double>(cost.ray_s.size()) / static_cast<double>(grid.directions.size());
        seconds += cost.rays_s + fraction * cost.set_rotation_s;
        rays += cost.ray_s.size();
      }
    }
    const auto configurations = static_cast<double>(rays * targets.size());
    state.counters["ns_per_configuration"] = 1e9 * seconds / configurations;
    state.counters["configurations"] = configurations / static_cast<double>(state.iterations());
    const Mesh& a = resources_.cache.mesh(a_);
    const Mesh& b = resources_.cache.mesh(b_);
    state.counters["triangles"] = static_cast<double>(a.triangles().size() + b.triangles().size());
  }

 private:
  std::vector<double> bucket_targets() const {
    const Mesh& a = resources_.cache.mesh(a_);
    std::vector<double> targets;
    if (words(method_).kind == BucketKind::volume) {
      for (int percent = 0; percent < static_cast<int>(k_paper_volume_buckets); ++percent) {
        targets.push_back(volume_bucket(a, percent).target);
      }
    } else {
      for (int percent = static_cast<int>(k_paper_distance_buckets) - 1; percent >= 0; --percent) {
        targets.push_back(distance_bucket(a, percent).target);
      }
    }
    return targets;
  }

  std::unique_ptr<DistanceGenerator> make_distances() const {
    if (!is_fcl(method_)) return make_ray_cast();
    return make_sphere_method(resources_.registry.find(k_fcl),
                              method_ == Method::fcl ? SphereMarch::conservative : SphereMarch::certified);
  }

  RaySolver& prepare() {
    Generator& generator = *generator_;
    if (generator.row == name()) return *generator.solver;
    const Mesh& a = resources_.cache.mesh(a_);
    const Mesh& b = resources_.cache.mesh(b_);
    if (method_ == Method::overlap) require_solids(a, b);
    generator.row.clear();
    generator.solver.reset();
    generator.volumes.reset();
    generator.distances = make_distances();
    if (method_ == Method::overlap) generator.volumes = std::make_unique<VolumeGenerator>(*generator.distances, a, b);
    generator.solver = generator.volumes ? generator.volumes->prepare() : generator.distances->prepare(a, b);
    generator.row = name();
    return *generator.solver;
  }

  const Resources& resources_;
  const Method method_;
  const std::string pair_, a_, b_;
  std::shared_ptr<Generator> generator_;
};

bool has_fcl(const Registry& registry) {
  return std::ranges::any_of(registry.all(), [](const auto& algorithm) { return algorithm->traits().name == k_fcl; });
}

}  // namespace

std::vector<Row> generate_rows(const Resources& resources) {
  std::vector<Row> rows;
  const auto generator = std::make_shared<Generator>();
  const auto add = [&](const std::string& pair, const std::string& a, const std::string& b) {
    for (const Method method : k_methods) {
      if (is_fcl(method) && !has_fcl(resources.registry)) continue;
      const auto row = std::make_shared<GenerateRow>(resources, method, pair, a, b, generator);
      rows.push_back({.name = row->name(),
                      .run = [row](benchmark::State& state, double) { row->run(state); },
                      .unit = benchmark::kMillisecond});
    }
  };
  std::set<std::string> pairs;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    if (pairs.insert(pair.pair).second) add(pair.pair, pair.a, pair.b);
  }
  for (const char* const recipe : k_recipes) {
    if (pairs.insert(recipe).second) add(recipe, recipe, recipe);
  }
  return rows;
}

}  // namespace sixdof::bench
