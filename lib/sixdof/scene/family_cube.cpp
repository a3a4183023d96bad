#include <cmath>

#include <sixdof/models/recipe.h>
#include <sixdof/scene/family_parts.h>

namespace sixdof::scene::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t k_sphere_triangles = 480;  // 16 rings of 16 quads, as FCL's tests make them
constexpr std::size_t k_cylinder_triangles = 240;

Scene make_wandering_cube(const SceneNumbers& numbers, double density, double moving, double step, double turn) {
  Scene scene;
  Random random(numbers.seed);
  const Shapes shapes(scene, own(numbers.size_ratio, 1.0));
  Mover mover(scene);
  fill_cube(mover, shapes, numbers.bodies, own(numbers.density, density), random);
  scene.margin = own(numbers.margin, 0.1) * shapes.mean_size(scene);
  wander(mover, numbers, own(numbers.moving, moving), own(numbers.step, step), turn, random);
  return scene;
}

}  // namespace

Shapes::Shapes(Scene& scene, double size_ratio) {
  for (std::size_t k = 0; k < k_sizes; ++k) {
    const double size = std::pow(size_ratio, -static_cast<double>(k) / (k_sizes - 1));
    const Vector3d box = size * Vector3d(1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0);
    for (Mesh& mesh : std::array<Mesh, k_kinds>{
             make_box({.size = box}, k_minimum_box).renamed("box"),
             make_sphere({.radius = size}, k_sphere_triangles).renamed("sphere"),
             make_cylinder({.radius = size / 3.0, .height = size * 4.0 / 3.0}, k_cylinder_triangles)
                 .renamed("cylinder")}) {
      volumes_.push_back(mesh.box().volume());
      radii_.push_back(0.5 * mesh.diagonal());
      scene.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    }
    if (size_ratio == 1.0) break;
  }
}

Shapes::Draw Shapes::draw(std::size_t first, std::size_t end, Random& random) const {
  Draw drawn;
  for (std::size_t body = first; body < end; ++body) {
    const std::size_t mesh = k_kinds * random.pick(volumes_.size() / k_kinds) + body % k_kinds;
    drawn.meshes.push_back(static_cast<std::uint32_t>(mesh));
    drawn.volume += volumes_[mesh];
  }
  return drawn;
}

double Shapes::mean_size(const Scene& scene) const {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Body& body : scene.bodies) {
    if (body.mesh >= radii_.size()) continue;
    sum += 2.0 * radii_[body.mesh];
    ++count;
  }
  return sum / static_cast<double>(count);
}

double fill_cube(Mover& mover, const Shapes& shapes, std::size_t bodies, double density, Random& random) {
  const auto [meshes, volume] = shapes.draw(0, bodies, random);
  const double edge = std::cbrt(volume / density);
  for (const std::uint32_t mesh : meshes) {
    const Matrix3d R = random.rotation();
    mover.add(mesh, R, random.in_cube(0.5 * edge));
  }
  return edge;
}

void wander(Mover& mover, const SceneNumbers& numbers, double moving, double step, double turn, Random& random) {
  mover.scene.frames.assign(1, {});
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    mover.scene.frames.emplace_back();
    for (std::uint32_t i = 0; i < mover.poses.size(); ++i) {
      const Body& body = mover.scene.bodies[i];
      if (body.fixed || random.unit() >= moving) continue;
      const Pose X = mover.poses[i];
      const double size = mover.scene.meshes[body.mesh]->diagonal();
      const Vector3d t = X.t + random.in_cube(step * size / std::sqrt(3.0));
      mover.move(i, random.small_rotation(turn) * X.R, t);
    }
  }
}

Scene make_cube(const SceneNumbers& numbers) { return make_wandering_cube(numbers, 0.01, 1.0, 0.1, k_turn); }

Scene make_shuffled(const SceneNumbers& numbers) { return shuffled(make_cube(numbers), numbers.seed); }

Scene make_still(const SceneNumbers& numbers) { return make_wandering_cube(numbers, 0.01, 0.0, 0.0, 0.0); }

Scene make_all_move(const SceneNumbers& numbers) {
  return make_wandering_cube(numbers, 0.01, 1.0, 2.0, 60.0 * k_degree);
}

Scene make_clusters(const SceneNumbers& numbers) {
  constexpr std::size_t k_members = 50;
  constexpr double k_density_inside = 0.2;
  Scene scene;
  Random random(numbers.seed);
  const Shapes shapes(scene, own(numbers.size_ratio, 3.0));
  Mover mover(scene);
  std::vector<std::uint32_t> cluster;  // of every body
  const std::size_t clusters = (numbers.bodies + k_members - 1) / k_members;
  double edge = 0.0;
  for (std::size_t c = 0; c < clusters; ++c) {
    const std::size_t members = std::min(k_members, numbers.bodies - c * k_members);
    Scene part = scene;
    part.bodies.clear();
    Mover inside(part);
    const double inner = fill_cube(inside, shapes, members, own(numbers.density, k_density_inside), random);
    if (c == 0) edge = 5.0 * inner * std::cbrt(static_cast<double>(clusters));
    const Vector3d center = random.in_cube(0.5 * edge);
    for (std::size_t i = 0; i < members; ++i) {
      mover.add(part.bodies[i].mesh, inside.poses[i].R, inside.poses[i].t + center);
      cluster.push_back(static_cast<std::uint32_t>(c));
    }
  }
  scene.margin = own(numbers.margin, 0.1) * shapes.mean_size(scene);
  scene.frames.assign(1, {});
  const double step = own(numbers.step, 0.1) * shapes.mean_size(scene);
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    scene.frames.emplace_back();
    std::vector<bool> moves(clusters);
    std::vector<Vector3d> shift(clusters);
    for (std::size_t c = 0; c < clusters; ++c) {
      moves[c] = random.unit() < own(numbers.moving, 0.2);
      shift[c] = random.in_cube(step);
    }
    for (std::uint32_t i = 0; i < mover.poses.size(); ++i) {
      if (!moves[cluster[i]]) continue;
      const Pose X = mover.poses[i];
      mover.move(i, random.small_rotation(1.0 * k_degree) * X.R, X.t + shift[cluster[i]]);
    }
  }
  return scene;
}

}  // namespace sixdof::scene::detail
