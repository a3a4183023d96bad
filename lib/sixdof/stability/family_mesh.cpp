#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <sixdof/models/recipe.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability::make {
namespace {

/// Cuts `count` sides in the middle on one of their two triangles and closes each slit by a triangle without area; then
/// adds as many pairs of equal triangles that look in opposite directions.
MeshPointer with_zero_area(const Mesh& mesh, std::size_t count) {
  Points points = mesh.vertices();
  std::vector<Triangle> triangles = mesh.triangles();
  const std::size_t originals = triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b, c] = triangles[i % originals];
    const auto middle = static_cast<std::uint32_t>(points.size());
    points.push_back(0.5 * (points[a] + points[b]));
    triangles[i % originals] = {a, middle, c};
    triangles.push_back({middle, b, c});
    triangles.push_back({a, b, middle});
    const auto [p, q, r] = mesh.triangles()[(i + 1) % originals];
    triangles.push_back({p, q, r});
    triangles.push_back({p, r, q});
  }
  return built(std::move(points), std::move(triangles));
}

/// Triangles that look down are far from a body above: some left out, some turned over.
MeshPointer damaged_below(const Mesh& mesh, double part, Draw& draw) {
  std::vector<Triangle> kept;
  for (Triangle t : mesh.triangles()) {
    const auto& p = mesh.vertices();
    const bool up = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).z() > 0.0;
    if (!up && draw.unit() < part) {
      if (draw.pick(2) == 0) continue;
      std::swap(t[1], t[2]);
    }
    kept.push_back(t);
  }
  return built(mesh.vertices(), std::move(kept));
}

}  // namespace

Case slivers(Draw& draw) {
  const double aspect = draw.logarithmic(1.0, 1e8);
  const bool needle = draw.pick(2) == 0;
  const Eigen::Vector3d size =
      needle ? Eigen::Vector3d(0.5, 0.5 / aspect, 0.5 / aspect) : Eigen::Vector3d(0.5, 0.4, 0.5 / aspect);
  const Eigen::Quaterniond q = draw.rotation();
  const double x = draw.uniform(-0.3, 0.3), y = draw.uniform(-0.3, 0.3);
  const double gap = draw.logarithmic(1e-6, 0.1);
  const Shot shot = above_face(box(k_size_a), 0.5 * k_size_a.z(), box(size), q, x, y, gap);
  return same_answers(needle ? "needle" : "flake", aspect, in_other_frames(shot, draw));
}

Case zero_area(Draw& draw) {
  const double part = draw.uniform(0.0, 0.5);
  const Shot clean = base(draw);
  const auto added = [&](const Mesh& mesh) {
    return static_cast<std::size_t>(std::ceil(part * static_cast<double>(mesh.triangles().size())));
  };
  Shot dirty = clean;
  dirty.a = with_zero_area(*clean.a, added(*clean.a));
  dirty.b = with_zero_area(*clean.b, added(*clean.b));
  return same_answers("triangles without area", part, {clean, dirty, swapped(dirty)}, false);
}

Case retriangulated(Draw& draw) {
  const double count = draw.logarithmic(12.0, 1200.0);
  const double gap = draw.logarithmic(1e-6, 0.1) * (draw.pick(2) == 0 ? 1.0 : -1.0);
  const Eigen::Vector3d offset{draw.uniform(-0.6, 0.6), draw.uniform(-0.5, 0.5),
                               0.5 * (k_size_a.z() + k_size_b.z()) + gap};
  const Shot coarse = aligned_boxes(k_size_a, k_size_b, offset);
  Shot fine = coarse;
  const auto triangles = static_cast<std::size_t>(count);
  fine.a = std::make_shared<const Mesh>(make_box({k_size_a}, triangles));
  fine.b = std::make_shared<const Mesh>(make_box({k_size_b}, triangles));
  return same_answers("gridded boxes", count, {coarse, fine, moved(fine, frame(draw), frame(draw))});
}

Case holes(Draw& draw) {
  const double part = draw.unit();
  const double gap = draw.logarithmic(1e-4, 0.1) * (draw.pick(2) == 0 ? 1.0 : -1.0);
  const Eigen::Quaterniond q = draw.rotation();
  Shot shot = above_face(std::make_shared<const Mesh>(make_box({k_size_a}, 108)), 0.5 * k_size_a.z(), box(k_size_b), q,
                         draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3), gap);
  shot.a = damaged_below(*shot.a, part, draw);
  return {.name = "damage below", .parameter = part, .relation = Relation::none, .shots = {shot}};
}

}  // namespace sixdof::stability::make
