#include <cmath>

#include <sixdof/models/recipe.h>
#include <sixdof/scene/family_parts.h>

// Scenes around one large or fixed thing: a giant, dust, a robot's cell.

namespace sixdof::scene::detail {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::uint32_t add_mesh(Scene& scene, Mesh mesh, const char* name) {
  scene.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh).renamed(name)));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

}  // namespace

Scene make_giant(const SceneNumbers& numbers) {
  constexpr double k_radius = 1000.0;  // of the giant; the others have one of 1
  constexpr double k_slow = 1e-5;      // radians a frame: 0.01 at the surface
  Scene scene;
  Random random(numbers.seed);
  const Shapes shapes(scene, own(numbers.size_ratio, 1.0));
  const std::uint32_t giant = add_mesh(scene, make_sphere({.radius = k_radius}, 20'000), "giant");
  Mover mover(scene);
  mover.add(giant, Matrix3d::Identity(), Vector3d::Zero());
  // Their centres lie in a cap, in a layer from one radius inside the surface to four outside.
  const auto [meshes, volume] = shapes.draw(1, numbers.bodies, random);
  constexpr double k_layer = 5.0;
  const double half = std::min(0.5 * k_radius, 0.5 * std::sqrt(volume / own(numbers.density, 0.02) / k_layer));
  for (const std::uint32_t mesh : meshes) {
    const double x = random.uniform(-half, half), y = random.uniform(-half, half), r = random.uniform(-1.0, 4.0);
    const Vector3d outward = Vector3d(x, y, std::sqrt(k_radius * k_radius - x * x - y * y)) / k_radius;
    mover.add(mesh, random.rotation(), (k_radius + r) * outward);
  }
  scene.margin = own(numbers.margin, 0.1) * shapes.mean_size(scene);
  const double moving = own(numbers.moving, 0.5), step = own(numbers.step, 0.05);
  scene.frames.assign(1, {});
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    scene.frames.emplace_back();
    mover.move(0, AngleAxisd(k_slow * static_cast<double>(f), Vector3d::UnitZ()).toRotationMatrix(), Vector3d::Zero());
    for (std::uint32_t i = 1; i < mover.poses.size(); ++i) {
      if (random.unit() >= moving) continue;
      const Pose X = mover.poses[i];
      const double size = scene.meshes[scene.bodies[i].mesh]->diagonal();
      mover.move(i, random.small_rotation(k_turn) * X.R, X.t + random.in_cube(step * size));
    }
  }
  return scene;
}

Scene make_dust(const SceneNumbers& numbers) {
  constexpr double k_reach = 1.8;  // half of the cube in which specks drift: the knot's radius is 1.75
  Scene scene;
  Random random(numbers.seed);
  const double specks = static_cast<double>(numbers.bodies - 1);
  const double size = 2.0 * k_reach * std::cbrt(own(numbers.density, 1e-3) / specks);
  const double ratio = own(numbers.size_ratio, 1.0);
  const std::uint32_t large = add_mesh(scene, make_torus_knot({}, 20'000), "knot");
  for (const double each : {size, size / std::sqrt(ratio), size / ratio}) {
    add_mesh(scene, make_sphere({.radius = 0.5 * each}, 80), "speck");
  }
  Mover mover(scene);
  mover.add(large, Matrix3d::Identity(), Vector3d::Zero(), true);
  std::vector<Vector3d> velocity{Vector3d::Zero()};
  const double step = own(numbers.step, 0.2) * size;
  for (std::size_t i = 1; i < numbers.bodies; ++i) {
    const Matrix3d R = random.rotation();
    mover.add(large + 1 + static_cast<std::uint32_t>(random.pick(3)), R, random.in_cube(k_reach));
    velocity.push_back(random.unit() * step * random.direction());
  }
  scene.margin = own(numbers.margin, 0.2) * size;
  scene.frames.assign(1, {});
  const double moving = own(numbers.moving, 1.0);
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    scene.frames.emplace_back();
    for (std::uint32_t i = 1; i < mover.poses.size(); ++i) {
      if (random.unit() >= moving) continue;
      const Pose X = mover.poses[i];
      Vector3d t = X.t + velocity[i];
      for (int k = 0; k < 3; ++k) {
        if (std::abs(t[k]) > k_reach) velocity[i][k] = -std::copysign(velocity[i][k], t[k]);
      }
      mover.move(i, random.small_rotation(1.0 * k_degree) * X.R, t);
    }
  }
  return scene;
}

Scene make_robot(const SceneNumbers& numbers) {
  constexpr std::size_t k_arm = 21;   // 11 joints and 10 links in turn
  constexpr double k_link = 1.0;      // length
  constexpr double k_swing = 1.2;     // radians: amplitude of a joint
  constexpr std::size_t k_close = 2;  // bodies of the arm that are no further apart in it are no pair
  Scene scene;
  Random random(numbers.seed);
  const Shapes shapes(scene, own(numbers.size_ratio, 3.0));
  const std::uint32_t joint = add_mesh(scene, make_sphere({.radius = 0.2}, 320), "joint");
  const std::uint32_t link = add_mesh(scene, make_cylinder({.radius = 0.12, .height = k_link}, 400), "link");
  Mover mover(scene);
  const std::size_t arm = std::min(k_arm, numbers.bodies);
  std::vector<double> phase, speed;
  for (std::size_t i = 0; i < arm; ++i) {
    mover.add(i % 2 == 0 ? joint : link, Matrix3d::Identity(), Vector3d::Zero());
    phase.push_back(random.uniform(0.0, 2.0 * std::numbers::pi));
    speed.push_back(random.uniform(0.5, 1.0) * own(numbers.step, 0.02));
    for (std::size_t k = 1; k <= k_close && i + k < arm; ++k) {
      scene.ignored.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + k)});
    }
  }
  const auto bend = [&](std::size_t f, const auto& place) {
    Pose X;  // of the joint at hand, z along the next link
    for (std::uint32_t i = 0; i < arm; ++i) {
      if (i % 2 == 0) {
        const double angle = k_swing * std::sin(phase[i] + speed[i] * static_cast<double>(f));
        X.R = X.R * AngleAxisd(angle, i % 4 == 0 ? Vector3d::UnitX() : Vector3d::UnitY()).toRotationMatrix();
        place(i, X.R, X.t);
      } else {
        place(i, X.R, X * Vector3d(0.0, 0.0, 0.5 * k_link));
        X.t = X * Vector3d(0.0, 0.0, k_link);
      }
    }
  };
  bend(0, [&](std::uint32_t i, const Matrix3d& R, const Vector3d& t) {
    mover.poses[i] = {R, t};
    scene.bodies[i].pose = RecordedPose::of(R, t);
  });
  const auto [meshes, volume] = shapes.draw(arm, numbers.bodies, random);
  const double edge = std::cbrt(volume / own(numbers.density, 0.02));
  for (const std::uint32_t mesh : meshes) {
    const Matrix3d R = random.rotation();
    mover.add(mesh, R, random.in_cube(0.5 * edge), true);
  }
  scene.margin = own(numbers.margin, 0.1) * 2.0;
  scene.frames.assign(1, {});
  for (std::size_t f = 1; f < numbers.frames; ++f) {
    scene.frames.emplace_back();
    if (own(numbers.moving, 1.0) == 0.0) continue;
    bend(f, [&](std::uint32_t i, const Matrix3d& R, const Vector3d& t) { mover.move(i, R, t); });
  }
  return scene;
}

}  // namespace sixdof::scene::detail
