#include <cmath>
#include <numbers>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

const Eigen::Vector3d k_size_a{2.0, 1.6, 1.2};
const Eigen::Vector3d k_size_b{0.7, 0.5, 0.4};

Eigen::Quaterniond about(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

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
  const Shot shot = aligned_boxes(k_size_a, k_size_b, {x, y, 0.5 * (k_size_a.z() + k_size_b.z()) + gap});
  return {.name = "kissing boxes",
          .thread = {},
          .parameter = gap,
          .relation = Relation::same,
          .shots = {shot, swapped(shot), moved(shot, frame(draw), frame(draw))},
          .convex = true};
}

Case near_aligned(Draw& draw) {
  const double angle = draw.logarithmic(1e-15, 0.8);
  const double gap = draw.logarithmic(1e-8, 0.1) * (draw.pick(2) == 0 ? 1.0 : -0.1);
  const double x = draw.uniform(-0.2, 0.2), y = draw.uniform(-0.2, 0.2);
  Eigen::Vector3d axis = draw.direction();
  if (draw.pick(3) == 0) axis = Eigen::Vector3d::UnitX();
  const Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), box(k_size_b), about(angle, axis), x, y, gap);
  return {.name = "nearly aligned boxes",
          .thread = {},
          .parameter = angle,
          .relation = Relation::same,
          .shots = {shot, swapped(shot), moved(shot, frame(draw), frame(draw))},
          .convex = true};
}

Case parallel_edges(Draw& draw) {
  const double angle = draw.logarithmic(1e-15, 0.1);
  const double gap = draw.logarithmic(1e-9, 0.1);
  // B's ridge looks down on A's. Turned about z it crosses A's over the origin, so the gap stays.
  const Eigen::Quaterniond down = about(angle, Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  Shot shot{.a = ridge(1.0), .b = ridge(0.8), .X_AB = {{0.0, 0.0, gap}, down}, .truth = {}};
  shot.truth.gap = shot.truth.distance = gap;
  return {.name = "ridges",
          .thread = {},
          .parameter = angle,
          .relation = Relation::same,
          .shots = {shot, swapped(shot), moved(shot, frame(draw), frame(draw))},
          .convex = true};
}

Case identical(Draw& draw) {
  const double shift = std::abs(draw.signed_logarithmic(1e-15, 1e-3));
  const Eigen::Vector3d direction = draw.direction();
  Shot shot = aligned_boxes(k_size_b, k_size_b, shift * direction);
  shot.b = shot.a;
  Shot turned = shot;
  const Placement same = frame(draw);
  turned = moved(shot, same, same);
  turned.b = turned.a;
  return {.name = "a box and itself",
          .thread = {},
          .parameter = shift,
          .relation = Relation::none,
          .shots = {shot, turned},
          .convex = true};
}

Case grazing(Draw& draw) {
  const double gap = draw.signed_logarithmic(1e-16, 1e-2);
  const double x = draw.uniform(-0.3, 0.3), y = draw.uniform(-0.3, 0.3);
  const Eigen::Quaterniond q = draw.rotation();
  const MeshPointer b = draw.pick(2) == 0 ? box(k_size_b) : capsule(0.2, 0.1, 12);
  const Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), b, q, x, y, gap);
  return {.name = "corner over a face",
          .thread = {},
          .parameter = gap,
          .relation = Relation::same,
          .shots = {shot, swapped(shot)},
          .convex = true};
}

}  // namespace sixdof::stability::make
