#include <algorithm>
#include <limits>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

const Eigen::Vector3d k_small{0.3, 0.25, 0.2};  // size of B

}  // namespace

Case contained(Draw& draw) {
  const double shift = draw.uniform(0.0, 0.3);
  const Eigen::Vector3d size_a{1.6, 1.4, 1.2};
  const Eigen::Vector3d offset = shift * draw.direction();
  Shot shot = aligned_boxes(size_a, k_small, offset);
  shot.truth.distance = (0.5 * (size_a - k_small) - offset.cwiseAbs()).minCoeff();
  return same_answers("box in a box", shift, in_other_frames(shot, draw), false);
}

Case thin_plate(Draw& draw) {
  const double thickness = draw.logarithmic(1e-6, 1.0);
  const Eigen::Vector3d size_a{1.0, 1.0, thickness};
  const double x = draw.uniform(-0.3, 0.3), y = draw.uniform(-0.3, 0.3);
  // Over the plate, partly in it, or through it.
  const double z = 0.5 * (thickness + k_small.z());
  const std::size_t kind = draw.pick(3);
  const double part = draw.uniform(0.1, 0.9);
  const double height = kind == 0 ? z + part * thickness : kind == 1 ? z - part * thickness : 0.0;
  const Shot shot = aligned_boxes(size_a, k_small, {x, y, height});
  return same_answers(kind == 0   ? "over the plate"
                      : kind == 1 ? "in the plate"
                                  : "through the plate",
                      thickness, in_other_frames(shot, draw));
}

Case tunnelling(Draw& draw) {
  const double steps = draw.logarithmic(0.1, 1e4);
  constexpr double k_thickness = 1e-3, k_time_step = 1.0;
  const double speed = steps * k_thickness / k_time_step;
  const double start = draw.uniform(0.2, 0.8) * std::max(speed, 10 * k_thickness);
  const Eigen::Quaterniond q = draw.rotation();
  const MeshPointer plate = box({40.0, 40.0, k_thickness});
  Shot shot =
      above_face(plate, 0.5 * k_thickness, box(k_small), q, draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3), start);
  const bool hits = draw.pick(4) != 0;
  return {.name = hits ? "towards the plate" : "away from the plate",
          .parameter = steps,
          .relation = Relation::sweep,
          .shots = {shot},
          .convex = true,
          .motion = {0.1 * speed, 0.0, hits ? -speed : speed},
          .contact_time = hits ? shot.truth.gap / speed : std::numeric_limits<double>::infinity()};
}

}  // namespace sixdof::stability::make
