#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <sixdof/models/recipe.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

MeshPointer ball(std::size_t triangles, double radius) {
  return std::make_shared<const Mesh>(make_sphere({radius}, triangles));
}

/// Nothing is known of where the bodies are.
Shot without_truth(Shot shot) {
  shot.truth = {};
  return shot;
}

}  // namespace

Case bad_poses(Draw& draw) {
  const double norm = draw.unit() < 0.1 ? 0.0 : draw.logarithmic(1e-3, 1e3);
  const Shot first = base(draw);
  Case result{.name = "bad poses", .parameter = norm, .relation = Relation::bad};
  const auto add = [&](const auto& spoil) {
    Shot shot = without_truth(first);
    shot.raw = first.X_AB.pose();
    spoil(*shot.raw);
    result.shots.push_back(shot);
  };
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN(),
                   k_infinity = std::numeric_limits<double>::infinity();
  const auto axis = static_cast<Eigen::Index>(draw.pick(3));
  add([&](Pose& X) { X.R *= norm; });
  add([&](Pose& X) { X.R(axis, 1) = k_nan; });
  add([&](Pose& X) { X.t[axis] = k_nan; });
  add([&](Pose& X) { X.t[axis] = k_infinity; });
  add([&](Pose& X) { X.R.col(axis) *= -1.0; });
  // Poses all the same: these are answered.
  Shot denormal = without_truth(first), far = denormal;
  denormal.X_AB.t[axis] = std::numeric_limits<double>::denorm_min();
  far.X_AB.t[axis] = 1e150;
  far.truth.gap = far.truth.distance = far.X_AB.t[axis];
  result.shots.push_back(denormal);
  result.shots.push_back(far);
  return result;
}

Case lipschitz(Draw& draw) {
  const double step = draw.logarithmic(1e-12, 1e-3);
  Case result{.name = "small steps", .parameter = step, .relation = Relation::path};
  Shot shot = moved(base(draw), frame(draw), frame(draw));
  shot.truth = {.error = shot.truth.error};
  const Eigen::Vector3d direction = draw.direction();
  for (int i = 0; i < 16; ++i) {
    result.shots.push_back(shot);
    shot.X_AB.t += step * direction;
  }
  return result;
}

Case closed_loop(Draw& draw) {
  const auto steps = static_cast<std::size_t>(draw.logarithmic(64.0, 512.0));
  const double radius = draw.logarithmic(0.01, 0.1), depth = draw.uniform(1.2, 2.0) * radius;
  const Eigen::Quaterniond q = draw.rotation();
  Case result{.name = "small circle", .parameter = static_cast<double>(steps), .relation = Relation::loop};
  Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), box(k_size_b), q, draw.uniform(-0.3, 0.3),
                         draw.uniform(-0.3, 0.3), -depth);
  const Eigen::Vector3d u = draw.direction(), v = u.unitOrthogonal();
  const Eigen::Vector3d center = shot.X_AB.t;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i % steps) / static_cast<double>(steps);
    shot.X_AB.t = center + radius * (std::cos(angle) * u + std::sin(angle) * v);
    result.shots.push_back(without_truth(shot));
  }
  return result;
}

Case repeated(Draw& draw) {
  const auto poses = static_cast<std::size_t>(draw.uniform(4.0, 17.0));
  Case result{.name = "repeated poses", .parameter = static_cast<double>(poses), .relation = Relation::repeat};
  const Shot first = moved(base(draw), frame(draw), frame(draw));
  for (std::size_t i = 0; i < poses; ++i) {
    Shot shot = without_truth(first);
    shot.X_AB.t += 0.3 * draw.unit() * draw.direction();
    result.shots.push_back(shot);
  }
  return result;
}

Case worst_time(Draw& draw) {
  const double count = draw.logarithmic(200.0, 5000.0);
  const auto triangles = static_cast<std::size_t>(count);
  const double small = draw.logarithmic(1e-3, 1.0);
  const double gap = draw.logarithmic(1e-9, 1e-2);
  const MeshPointer a = ball(triangles, 1.0), b = small > 0.9 ? a : ball(triangles, small);
  Case result{.name = "balls near contact", .parameter = count, .relation = Relation::time};
  for (int i = 0; i < 12; ++i) {
    const Eigen::Quaterniond q = draw.rotation();
    const Eigen::Vector3d direction = draw.direction();
    // Close outside, close inside, far away.
    const double s = i % 3 == 0 ? 1.0 + small + gap : i % 3 == 1 ? 1.0 - small - gap : 100.0;
    result.shots.push_back({.a = a, .b = b, .X_AB = {s * direction, q}});
  }
  return result;
}

}  // namespace sixdof::stability::make
