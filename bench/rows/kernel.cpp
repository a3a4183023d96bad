#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/harness/timing.h"
#include "bench/harness/work.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Both bodies: smooth, closed, of a volume that needs many voxels and spheres.
constexpr const char* k_model = "bumpy-sphere-10k";

/// One row: responses of an algorithm with some settings at poses of one kind.
struct Kernel {
  const char* name;       ///< "kernel/NAME/algorithm:vps".
  const char* algorithm;  ///< In the registry.
  std::vector<std::string> settings;
  double centers_apart;  ///< Distance of the two centres, in box diagonals.
};

constexpr double k_overlap = 0.15, k_apart = 1.2;

/// Sizes are those of caches: the small map and its points take 300 kilobytes, the large ones 50 megabytes.
const std::vector<Kernel> k_kernels{
    {"map-in-cache", "vps", {"culling=off", "voxel_size=0.02", "point_spacing=0.01"}, k_overlap},
    {"map-in-memory", "vps", {"culling=off", "voxel_size=0.0017", "point_spacing=0.0017"}, k_overlap},
    {"apart", "vps", {}, k_apart},
    {"map-in-cache", "vps-field", {"culling=off", "voxel_size=0.04", "point_spacing=0.01"}, k_overlap},
    {"apart", "vps-field", {}, k_apart},
    {"spheres-10k", "ist", {"spheres=10000"}, k_overlap},
    {"apart", "ist", {"spheres=10000"}, k_apart},
};

/// Random rotations in random directions, the same ones in every run.
std::vector<Pose> kernel_poses(const Mesh& mesh, double centers_apart) {
  constexpr std::size_t k_poses = 64;
  std::mt19937_64 random(k_poses);
  std::normal_distribution<double> normal;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < k_poses; ++i) {
    Eigen::Vector3d direction;
    Eigen::Vector4d q;
    for (double& x : direction) x = normal(random);
    for (double& x : q) x = normal(random);
    q.normalize();
    Pose pose = Pose::from_quaternion(q[0], q[1], q[2], q[3], Eigen::Vector3d::Zero());
    pose.t = mesh.center() + centers_apart * mesh.diagonal() * direction.normalized() - pose.R * mesh.center();
    poses.push_back(pose);
  }
  return poses;
}

Settings settings_of(const Algorithm& algorithm, const Kernel& kernel) {
  Settings settings = algorithm.settings();
  settings.set_all(kernel.settings);
  return settings;
}

void run(const Resources& resources, const Kernel& kernel, benchmark::State& state) {
  const Algorithm& algorithm = resources.registry.find(kernel.algorithm);
  const Settings settings = settings_of(algorithm, kernel);
  Query& query = resources.cache.query(algorithm, settings, k_model, k_model);
  const std::vector<Pose> poses = kernel_poses(resources.cache.mesh(k_model), kernel.centers_apart);
  Failures failures;
  GuardedQuery guarded(
      query, [&query](const Pose& pose) { return query.respond(pose); }, failures);
  MeanWork work;
  for (const Pose& pose : poses) {
    if (guarded.ask(pose).ok()) work.add(query.work());
  }
  time_mean(state, poses, guarded);
  if (failures.count() > 0) throw Error(fmt::format("no response: {}", failures.first()));
  state.counters["bytes"] = static_cast<double>(query.footprint().bytes);
  work.report(state.counters);
  state.SetLabel(settings.to_string());
}

}  // namespace

std::vector<Row> kernel_rows(const Resources& resources) {
  std::vector<Row> rows;
  for (const Kernel& kernel : k_kernels) {
    const Algorithm& algorithm = resources.registry.find(kernel.algorithm);
    const Settings settings = settings_of(algorithm, kernel);
    rows.push_back(
        {.name = fmt::format("kernel/{}/algorithm:{}", kernel.name, kernel.algorithm),
         .run = [&resources, &kernel](benchmark::State& state, const Share&) { run(resources, kernel, state); },
         .fields = {.query = "kernel",
                    .algorithm = kernel.algorithm,
                    .settings = settings.to_string(),
                    .kernel = kernel.name,
                    .isolated = is_isolated(algorithm)},
         .manual_time = is_isolated(algorithm)});
  }
  return rows;
}

}  // namespace sixdof::bench
