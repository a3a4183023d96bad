#include <cmath>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

/// A prism along x with a ridge at z = 0, y = 0 and its body below.
MeshPointer ridge(double half_length) {
  const double h = half_length;
  return hexahedron({Eigen::Vector3d{-h, -0.5, -0.5}, Eigen::Vector3d{h, -0.5, -0.5}, Eigen::Vector3d{-h, 0.0, -1.0},
                     Eigen::Vector3d{h, 0.0, -1.0}, Eigen::Vector3d{-h, 0.0, 0.0}, Eigen::Vector3d{h, 0.0, 0.0},
                     Eigen::Vector3d{-h, 0.5, -0.5}, Eigen::Vector3d{h, 0.5, -0.5}});
}

/// B's ridge looks down on A's and crosses it. While the ridges are long against the depth, the way out is up.
Shot edge_on_edge(double angle, double depth) {
  const Eigen::Quaterniond down = about(angle, Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  Shot shot{.a = ridge(1.0), .b = ridge(0.8), .X_AB = {{0.0, 0.0, -depth}, down}};
  shot.truth.gap = -depth;
  shot.truth.push = Eigen::Vector3d::UnitZ();
  return shot;
}

/// The block B stands on A, `depth` deep.
Shot standing(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, double x, double y, double depth) {
  return aligned_boxes(size_a, size_b, {x, y, 0.5 * (size_a.z() + size_b.z()) - depth});
}

Shot shot_of(std::size_t kind, double depth, Draw& draw) {
  const double x = draw.uniform(-0.3, 0.3), y = draw.uniform(-0.2, 0.2);
  switch (kind) {
    case 0:
      return standing(k_size_a, k_size_b, x, y, depth);
    case 1:
      return edge_on_edge(draw.uniform(0.4, 1.5), depth);
    case 2:
      return above_face(box(k_size_a), 0.5 * k_size_a.z(), box(k_size_b), draw.rotation(), x, y, -depth);
    case 3: {
      Shot shot = standing(k_size_a, {k_size_a.x(), k_size_a.y(), 0.5}, 0.0, 0.0, depth);
      shot.truth.push = {};  // where sides lie in one plane, the volume has no gradient
      return shot;
    }
    case 4:
      return standing(k_size_a, k_size_b, x, y, draw.uniform(0.3, 0.9) * k_size_b.z());
    default: {
      const double thickness = draw.logarithmic(1e-3, 0.1);
      return standing({2.0, 1.6, thickness}, k_size_b, x, y, draw.uniform(0.1, 0.4) * thickness);
    }
  }
}

}  // namespace

Case contacts(Draw& draw) {
  constexpr const char* k_names[] = {"face on face", "edge on edge", "corner on face", "flush sides", "deep", "thin"};
  const double depth = draw.logarithmic(1e-6, 0.05);
  const std::size_t kind = draw.pick(std::size(k_names));
  const Shot shot = shot_of(kind, depth, draw);
  return {.name = k_names[kind],
          .parameter = depth,
          .relation = Relation::contacts,
          .shots = in_other_frames(shot, draw),
          .convex = true};
}

}  // namespace sixdof::stability::make
