
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

/// Where B's lowest vertex meets the face: far from its border.
constexpr double k_inner = 0.3;

}  // namespace

Shot base(Draw& draw) {
  const std::size_t kind = draw.pick(4);
  const double x = draw.uniform(-k_inner, k_inner), y = draw.uniform(-k_inner, k_inner);
  const Eigen::Quaterniond q = draw.rotation();
  const double gap = draw.logarithmic(1e-3, 0.2);
  const double height = 0.5 * k_size_a.z();
  switch (kind) {
    case 0:
      return above_face(box(k_size_a), height, box(k_size_b), q, x, y, gap);
    case 1:
      return above_face(box(k_size_a), height, box(k_size_b), q, x, y, -gap);
    case 2:
      return above_face(box(k_size_a), height, capsule(0.2, 0.1, 12), q, x, y, gap);
    default:
      return aligned_boxes(k_size_a, k_size_b, {x, y, height + 0.5 * k_size_b.z() - gap});
  }
}

Placement frame(Draw& draw, double largest_shift) {
  const Eigen::Quaterniond q = draw.rotation();
  const Eigen::Vector3d direction = draw.direction();
  return {largest_shift * draw.unit() * direction, q};
}

std::vector<Shot> in_other_frames(const Shot& shot, Draw& draw) {
  return {shot, swapped(shot), moved(shot, frame(draw), frame(draw))};
}

Case uniform_scale(Draw& draw) {
  const double factor = draw.logarithmic(1e-6, 1e6);
  const Shot first = base(draw);
  const Shot turned = moved(first, frame(draw), frame(draw));
  return same_answers("scaled bodies", factor,
                      {first, scaled(first, factor), scaled(turned, factor), scaled(swapped(turned), factor)});
}

Case size_ratio(Draw& draw) {
  const double ratio = draw.logarithmic(1.0, 1e6);
  const double size = 0.5 / ratio;
  const double gap = draw.uniform(-0.2, 3.0) * size;
  const double x = draw.uniform(-k_inner, k_inner), y = draw.uniform(-k_inner, k_inner);
  const Eigen::Quaterniond q = draw.rotation();
  const Shot shot =
      above_face(box(k_size_a), 0.5 * k_size_a.z(), box(size * Eigen::Vector3d(1.0, 0.8, 0.6)), q, x, y, gap);
  return same_answers("small body over a face", ratio,
                      {shot, swapped(shot), moved(shot, frame(draw), frame(draw, size))});
}

Case common_offset(Draw& draw) {
  const double offset = draw.logarithmic(1.0, 1e8);
  const Shot first = base(draw);
  const Placement far{offset * draw.direction(), Eigen::Quaterniond::Identity()};
  const Shot away = moved(first, far, far);
  return same_answers("both bodies offset", offset, {first, away, swapped(away)});
}

Case rigid_motion(Draw& draw) {
  const double shift = draw.logarithmic(1e-3, 1e3);
  const Shot first = base(draw);
  const Shot turned = moved(first, frame(draw, shift), frame(draw, shift));
  return same_answers("other frames", shift, {first, turned, swapped(first), swapped(turned)});
}

}  // namespace sixdof::stability::make
