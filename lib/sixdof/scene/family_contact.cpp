#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/models/recipe.h>
#include <sixdof/scene/family_parts.h>

// Scenes of bodies at rest against each other: a heap, and pairs at stored distances.

namespace sixdof::scene::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Spheres that were dropped one by one: each rests on the highest of those that it meets, or on the plane z = 0, and
/// never rolls.
class Heap {
 public:
  explicit Heap(double largest_radius) : cell_(2.0 * largest_radius) {}

  /// Height of the centre of a sphere dropped at (x, y).
  double drop(double x, double y, double radius) {
    const int cx = cell_of(x), cy = cell_of(y);
    double z = radius;
    for (int i = cx - 1; i <= cx + 1; ++i) {
      for (int j = cy - 1; j <= cy + 1; ++j) {
        for (const Eigen::Vector4d& other : cells_[{i, j}]) {
          const double reach = radius + other[3];
          const double rest = reach * reach - std::pow(x - other[0], 2) - std::pow(y - other[1], 2);
          if (rest > 0.0) z = std::max(z, other[2] + std::sqrt(rest));
        }
      }
    }
    cells_[{cx, cy}].emplace_back(x, y, z, radius);
    return z;
  }

 private:
  int cell_of(double x) const { return static_cast<int>(std::floor(x / cell_)); }
  double cell_;
  std::map<std::pair<int, int>, std::vector<Eigen::Vector4d>> cells_;
};

constexpr const char* k_set = "torus-knot-10k.h5";

}  // namespace

Scene make_pile(const SceneNumbers& numbers) {
  constexpr double k_core = 0.5;  // of a body's radius: its sphere in the heap, so that neighbours touch
  Scene scene;
  Random random(numbers.seed);
  const Shapes shapes(scene, own(numbers.size_ratio, 2.0));
  const auto [meshes, volume] = shapes.draw(1, numbers.bodies, random);
  const double half = 0.5 * std::cbrt(volume / own(numbers.density, 0.5));
  constexpr double k_thickness = 1.0;
  scene.meshes.push_back(std::make_shared<const Mesh>(
      make_box({.size = {4.0 * half, 4.0 * half, k_thickness}}, k_minimum_box).renamed("floor")));
  Mover mover(scene);
  mover.add(static_cast<std::uint32_t>(scene.meshes.size() - 1), Matrix3d::Identity(), {0, 0, -0.5 * k_thickness},
            true);
  Heap heap(k_core * shapes.radius(0) * 4.0);
  for (const std::uint32_t mesh : meshes) {
    const Matrix3d R = random.rotation();
    const double x = random.uniform(-half, half), y = random.uniform(-half, half);
    mover.add(mesh, R, {x, y, heap.drop(x, y, k_core * shapes.radius(mesh))});
  }
  scene.margin = own(numbers.margin, 0.05) * shapes.mean_size(scene);
  wander(mover, numbers, own(numbers.moving, 0.3), own(numbers.step, 0.002), 0.1 * k_degree, random);
  return scene;
}

Scene make_pairs(const SceneNumbers& numbers) {
  constexpr double k_room = 4.0;           // sizes of the pair between neighbours of the grid
  constexpr double k_above_target = 1e-6;  // relative: the margin is above what is stored by as much
  constexpr std::size_t k_stored = 64;     // configurations of each bucket that are used
  const std::filesystem::path file = data_folder() / "fixtures" / k_set;
  const ConfigurationSet set(file);
  const auto a = std::make_shared<const Mesh>(find_mesh(set.description().a, file));
  const auto b =
      set.description().b.hash == a->hash() ? a : std::make_shared<const Mesh>(find_mesh(set.description().b, file));
  std::vector<BucketSample> buckets;
  for (const BucketSummary& bucket : set.buckets()) {
    if (bucket.key.kind != BucketKind::distance || bucket.key.percent > 10.0) continue;
    buckets.push_back(sample_bucket(set, bucket.key, *a, *b, k_stored, numbers.seed));
  }
  if (buckets.empty()) throw BadFile(file.string(), "has no distances of at most 10 %");

  Scene scene;
  Random random(numbers.seed);
  scene.meshes = a == b ? std::vector{a} : std::vector{a, b};
  Mover mover(scene);
  const std::size_t pairs = numbers.bodies / 2;
  const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(pairs))));
  const double room = k_room * (a->diagonal() + b->diagonal());
  std::vector<Pose> place;
  std::vector<std::size_t> next;
  const auto b_of = [&](std::size_t k) {
    const BucketSample& bucket = buckets[k % buckets.size()];
    return place[k] * bucket.poses[next[k]++ % bucket.poses.size()];
  };
  for (std::size_t k = 0; k < pairs; ++k) {
    const Vector3d cell(static_cast<double>(k % side), static_cast<double>(k / side % side),
                        static_cast<double>(k / side / side));
    // As it is recorded, so that B stands to A as it is stored.
    place.push_back(RecordedPose::of(random.rotation(), room * cell).pose());
    next.push_back(random.pick(k_stored));
    const Pose X_WB = b_of(k);
    mover.add(0, place[k].R, place[k].t);
    mover.add(a == b ? 0 : 1, X_WB.R, X_WB.t);
  }
  const BucketSample& middle = buckets[buckets.size() / 2];
  scene.margin = std::isnan(numbers.margin) ? middle.target + 2.0 * middle.tolerance + k_above_target * middle.target
                                            : numbers.margin * a->diagonal();
  scene.frames.assign(1, {});
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    scene.frames.emplace_back();
    for (std::size_t k = 0; k < pairs; ++k) {
      if (random.unit() >= own(numbers.moving, 0.2)) continue;
      const Pose X_WB = b_of(k);
      mover.move(static_cast<std::uint32_t>(2 * k + 1), X_WB.R, X_WB.t);
    }
  }
  return scene;
}

}  // namespace sixdof::scene::detail
