#include <cmath>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

const Eigen::Vector3d k_size{0.7, 0.5, 0.4};  // of B

/// A prism along x with a ridge at z = 0, y = 0 and its body below.
MeshPointer ridge(double half_length) {
  const double h = half_length;
  return hexahedron({Eigen::Vector3d{-h, -0.5, -0.5}, Eigen::Vector3d{h, -0.5, -0.5}, Eigen::Vector3d{-h, 0.0, -1.0},
                     Eigen::Vector3d{h, 0.0, -1.0}, Eigen::Vector3d{-h, 0.0, 0.0}, Eigen::Vector3d{h, 0.0, 0.0},
                     Eigen::Vector3d{-h, 0.5, -0.5}, Eigen::Vector3d{h, 0.5, -0.5}});
}

}  // namespace

Case kissing_boxes(Draw& draw) {
  const double gap = draw.signed_logarithmic(1e-16, 1e-3);
  const double x = draw.uniform(-0.6, 0.6), y = draw.uniform(-0.5, 0.5);
  const Shot shot = aligned_boxes(k_size_a, k_size, {x, y, 0.5 * (k_size_a.z() + k_size.z()) + gap});
  return same_answers("kissing boxes", gap, in_other_frames(shot, draw));
}

Case near_aligned(Draw& draw) {
  const double angle = draw.logarithmic(1e-15, 0.8);
  const double gap = draw.logarithmic(1e-8, 0.1) * (draw.pick(2) == 0 ? 1.0 : -0.1);
  const double x = draw.uniform(-0.2, 0.2), y = draw.uniform(-0.2, 0.2);
  Eigen::Vector3d axis = draw.direction();
  if (draw.pick(3) == 0) axis = Eigen::Vector3d::UnitX();
  const Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), box(k_size), about(angle, axis), x, y, gap);
  return same_answers("nearly aligned boxes", angle, in_other_frames(shot, draw));
}

Case parallel_edges(Draw& draw) {
  const double angle = draw.logarithmic(1e-15, 0.1);
  const double gap = draw.logarithmic(1e-9, 0.1);
  // B's ridge looks down on A's. Turned about z it crosses A's over the origin, so the gap stays.
  const Eigen::Quaterniond down = about(angle, Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  Shot shot{.a = ridge(1.0), .b = ridge(0.8), .X_AB = {{0.0, 0.0, gap}, down}};
  shot.truth.gap = shot.truth.distance = gap;
  return same_answers("ridges", angle, in_other_frames(shot, draw));
}

Case identical(Draw& draw) {
  const double shift = std::abs(draw.signed_logarithmic(1e-15, 1e-3));
  const Eigen::Vector3d direction = draw.direction();
  Shot shot = aligned_boxes(k_size, k_size, shift * direction);
  shot.b = shot.a;
  const Placement same = frame(draw);
  Shot turned = moved(shot, same, same);
  turned.b = turned.a;
  return {.name = "a box and itself",
          .parameter = shift,
          .relation = Relation::none,
          .shots = {shot, turned},
          .convex = true};
}

Case grazing(Draw& draw) {
  const double gap = draw.signed_logarithmic(1e-16, 1e-2);
  const double x = draw.uniform(-0.3, 0.3), y = draw.uniform(-0.3, 0.3);
  const Eigen::Quaterniond q = draw.rotation();
  const MeshPointer b = draw.pick(2) == 0 ? box(k_size) : capsule(0.2, 0.1, 12);
  const Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), b, q, x, y, gap);
  return same_answers("corner over a face", gap, {shot, swapped(shot)});
}

}  // namespace sixdof::stability::make
