#include <cmath>
#include <limits>
#include <numbers>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability::make {
namespace {

constexpr double k_never = std::numeric_limits<double>::infinity();

/// Edges of a floor whose upper face is at z = 0, and of what moves over it.
const Eigen::Vector3d k_floor{4.0, 4.0, 1.0}, k_block{0.5, 0.4, 0.3};

Shot over_floor(const MeshPointer& floor, double thickness, const MeshPointer& b, double height_of_center, double x,
                double y) {
  return {.a = floor, .b = b, .X_AB = {{x, y, 0.5 * thickness + height_of_center}}};
}

/// @param contact_time of the motion; k_never
Case moving(std::string name, double parameter, const Shot& start, const Eigen::Vector3d& translation,
            const Eigen::Vector3d& rotation, double contact_time) {
  Case result{.name = std::move(name), .parameter = parameter, .relation = Relation::cast, .shots = {start}};
  result.cast = Motion::of(*start.b, start.pose(), translation, rotation);
  result.contact_time = contact_time;
  return result;
}

/// A rod turns about its end, which is above the floor, by up to several turns: down at once, or over the top first.
Case swinging(Draw& draw, double parameter) {
  const double length = 1.5, half = draw.logarithmic(1e-4, 0.1), height = draw.uniform(0.3, 1.2);
  const bool over_the_top = draw.pick(2) == 1;
  const double angle = draw.uniform(4.5, 20.0);
  const MeshPointer floor = box(k_floor), rod = box({length, 2.0 * half, 2.0 * half});
  const Shot start = over_floor(floor, k_floor.z(), rod, height, 0.5 * length, 0.0);
  // The corner of the end is at height h - L sin x - w cos x after a turn by x downwards.
  const double down = std::asin(height / std::hypot(length, half)) - std::atan2(half, length);
  const double touches = over_the_top ? std::numbers::pi + down : down;
  Case result = moving("swinging rod", parameter, start, Eigen::Vector3d::Zero(),
                       {0.0, over_the_top ? -angle : angle, 0.0}, touches / angle);
  result.cast->reference = {-0.5 * length, 0.0, 0.0};
  return result;
}

}  // namespace

Case moving_bodies(Draw& draw) {
  const double lengths = draw.logarithmic(1e-9, 1e6);  // of A's diagonal, per motion
  const std::size_t kind = draw.pick(8);
  const double at = draw.uniform(0.1, 0.9), x = draw.uniform(-1.0, 1.0), y = draw.uniform(-1.0, 1.0);
  const Eigen::Vector3d turn{0.0, 0.0, draw.uniform(-9.0, 9.0)};  // about the vertical: heights do not change
  if (kind == 0) return swinging(draw, lengths);
  const double thickness = kind == 1 ? draw.logarithmic(1e-6, 1e-2) : k_floor.z();
  const MeshPointer floor = box({k_floor.x(), k_floor.y(), thickness});
  const double length = lengths * floor->diagonal();
  const double size = kind == 2 ? draw.logarithmic(1e-6, 1.0) : 1.0;
  const MeshPointer block = box(size * k_block);
  const double half = 0.5 * size * k_block.z();
  const Eigen::Vector3d down{0.0, 0.0, -length};
  switch (kind) {
    case 1:
      return moving("onto a thin plate", lengths, over_floor(floor, thickness, block, half + at * length, x, y), down,
                    turn, at);
    case 2:
      return moving("a small body", lengths, over_floor(floor, thickness, block, half + at * length, x, y), down, turn,
                    at);
    case 3: {
      // The face is passed at a gap that does not change.
      const double gap = draw.logarithmic(1e-8, 1e-2);
      return moving("past a face", lengths, over_floor(floor, thickness, block, half + gap, x, y), {length, 0.0, 0.0},
                    turn, k_never);
    }
    case 4: {
      const double reach = 0.5 * k_block.norm() + 0.01;
      return moving("spinning", lengths, over_floor(floor, thickness, block, reach, x, y), Eigen::Vector3d::Zero(),
                    draw.uniform(0.0, 30.0) * draw.direction(), k_never);
    }
    case 5:
      return moving("in contact at the start", lengths, over_floor(floor, thickness, block, 0.9 * half, x, y),
                    length * draw.direction(), turn, 0.0);
    case 6:
      return moving("no motion", lengths, over_floor(floor, thickness, block, half + 0.1, x, y),
                    Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), k_never);
    default:
      return moving("away", lengths, over_floor(floor, thickness, block, half + at * 1e-3, x, y), -down, turn, k_never);
  }
}

}  // namespace sixdof::stability::make
