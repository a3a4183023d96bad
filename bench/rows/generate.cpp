#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/generation/volume_generator.h>
#include <sixdof/generation/work_sample.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

constexpr std::size_t k_runs = 4;  ///< Of RayRuns::k_length rays each, with all the paper's buckets.
constexpr const char* k_fcl = "fcl-rss";

/// Copies of one recipe, where cost is to be seen against size.
constexpr const char* k_recipes[] = {"torus-knot-10k",   "torus-knot-100k",   "torus-knot-1m",
                                     "bumpy-sphere-10k", "bumpy-sphere-100k", "bumpy-sphere-1m",
                                     "gyroid-ball-10k",  "gyroid-ball-100k",  "gyroid-ball-1m"};

struct Method {
  BucketKind kind;
  const char* name;  ///< In the row's name.
  const char* grid;
  std::optional<SphereMarch> march;  ///< With FCL's distances; none: a ray cast.
};
constexpr Method k_methods[] = {{BucketKind::distance, "raycast", "paper", {}},
                                {BucketKind::distance, "fcl", "paper", SphereMarch::conservative},
                                {BucketKind::distance, "fcl-sweep", "paper", SphereMarch::certified},
                                {BucketKind::volume, "overlap", "paper-volume", {}}};

/// A generator with one solver. Both are large for large meshes, so all rows share one object of this type.
struct Generator {
  std::string row;
  std::unique_ptr<DistanceGenerator> distances;
  std::unique_ptr<RaySolver> solver;  // declared last: it refers to the others
};

struct GenerateRow {
  const Resources& resources;
  const Method& method;
  std::string pair, a_name, b_name;
  std::shared_ptr<Generator> generator;
  std::string name = fmt::format("generate/{}/algorithm:{}/pair:{}", to_string(method.kind), method.name, pair);

  /// One iteration is one pass over the rays. The row's own time contains more than the counter: the rays that warm up,
  /// and the cost of setting a rotation for a few rays instead of all.
  void run(benchmark::State& state) const {
    const Mesh& a = resources.cache.mesh(a_name);
    const Mesh& b = resources.cache.mesh(b_name);
    if (generator->row != name) prepare(a, b);
    const Grid grid = make_grid(method.grid);
    const std::vector<double> targets = bucket_targets(a);
    double seconds = 0.0;
    std::size_t rays = 0;
    for ([[maybe_unused]] auto _ : state) {
      RayRuns runs(grid, resources.seed);
      for (std::size_t i = 0; i < k_runs; ++i) {
        const RunCost cost = time_run(*generator->solver, grid, runs.next(), targets);
        const double fraction = static_cast<double>(cost.ray_s.size()) / static_cast<double>(grid.directions.size());
        seconds += cost.rays_s + fraction * cost.set_rotation_s;
        rays += cost.ray_s.size();
      }
    }
    const auto configurations = static_cast<double>(rays * targets.size());
    state.counters["ns_per_configuration"] = 1e9 * seconds / configurations;
    state.counters["configurations"] = configurations / static_cast<double>(state.iterations());
    state.counters["triangles"] = static_cast<double>(a.triangles().size() + b.triangles().size());
  }

  /// The paper's buckets, in the order in which a ray meets them.
  std::vector<double> bucket_targets(const Mesh& a) const {
    std::vector<double> targets;
    if (method.kind == BucketKind::volume) {
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

  void prepare(const Mesh& a, const Mesh& b) const {
    if (method.kind == BucketKind::volume) require_solids(a, b);
    generator->row.clear();
    generator->solver.reset();
    generator->distances = method.march
                               ? make_sphere_method(in_this_process(resources.registry.find(k_fcl)), *method.march)
                               : make_ray_cast();
    generator->solver = method.kind == BucketKind::volume ? volume_solvers(*generator->distances, a, b)()
                                                          : generator->distances->prepare(a, b);
    generator->row = name;
  }
};

}  // namespace

std::vector<PlannedRow> generate_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  const auto generator = std::make_shared<Generator>();
  const bool has_fcl = std::ranges::any_of(resources.registry.all(),
                                           [](const auto& algorithm) { return algorithm->traits().name == k_fcl; });
  const auto add = [&](const std::string& pair, const std::string& a, const std::string& b) {
    for (const Method& method : k_methods) {
      if (method.march && !has_fcl) continue;
      const GenerateRow row{resources, method, pair, a, b, generator};
      rows.push_back(
          {.name = row.name,
           .run = [row](benchmark::State& state, const Share&) { row.run(state); },
           .fields = {.query = "generate", .algorithm = method.name, .pair = pair, .target = to_string(method.kind)},
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
