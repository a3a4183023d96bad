#include <limits>

#include <sixdof/stability/field_case.h>
#include <sixdof/stability/makers.h>

namespace sixdof::stability::field {
namespace {

/// A point as a tetrahedron whose lowest corner is the point: other corners lie away from `from`.
MeshPointer corner_at(const Eigen::Vector3d& p, const Eigen::Vector3d& away, double size) {
  const Eigen::Vector3d n = away.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  return tetrahedron(
      {p, p + size * (n + 0.1 * u), p + size * (n - 0.1 * u + 0.1 * v), p + size * (n - 0.1 * u - 0.1 * v)});
}

}  // namespace

std::vector<Case> triangle_offsets() {
  // Coordinates far from the origin, with an edge of 1.8e-5 in y.
  const MeshPointer a =
      triangles({{-24642.0, 13.0, -13768.0}, {-24641.0, 13.000018, -13768.0}, {-24642.0, 13.0, -13767.0}});
  const MeshPointer b = triangles({{-24641.7, 13.5, -13767.7}, {-24641.7, 14.0, -13767.7}, {-24641.0, 14.0, -13767.7}});
  return {member("triangles far away", "bulletphysics/bullet3#185", 24642.0, in_place(a, b))};
}

std::vector<Case> triangle_slivers() {
  const Eigen::Vector3d b0(-0.252283931, 173.43692, 0.093847394);
  const MeshPointer near_collinear =
      triangles({{-0.228017807, -28.1085911, 0.140446782}, b0, b0 - Eigen::Vector3d::UnitY()});
  const MeshPointer point = corner_at({0.0, 0.0, 0.0}, {1.0, 0.0, 0.3}, 0.5);
  const MeshPointer long_triangle = triangles({{0.06999979436939574029, -1.708219171670e-8, 1.02781464659664711903},
                                               {0.06999979436939574029, -1.708219171670e-8, -0.81718535340335285433},
                                               {-0.40000020563060423306, -2.075754440556e-8, 1.02781464312938330963}});
  // Above the triangle by 1.76e-8: the corner looks up, out of the plane y = 0.
  const MeshPointer above = corner_at({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.5);
  const MeshPointer huge = triangles({{99.9999847, 0.946687222, 99.9999847},
                                      {-100.010002, 0.977360725, -100.010002},
                                      {-100.000137, 0.977310658, -100.000137}});
  const MeshPointer below = corner_at({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, 0.5);
  const MeshPointer no_area = triangles({{40.0, 0.0, 0.0}, {0.0, 80.0, 0.0}, {0.0, 79.99999999999999, 0.0}});
  // A ray .52 degrees off the plane of a triangle, as a needle.
  const MeshPointer plane = triangles({{0.0, 0.0, 0.0}, {11.2, 0.0, 0.0}, {1.5, 1.4, 0.0}});
  const MeshPointer ray = tetrahedron({Eigen::Vector3d{3.0, 0.4, 0.01}, Eigen::Vector3d{12294.0, 0.5, 111.6},
                                       Eigen::Vector3d{12294.0, 0.6, 111.6}, Eigen::Vector3d{12294.0, 0.5, 111.7}});
  return {
      member("cancelling barycentric coordinates", "jrouwe/JoltPhysics#2065", 200.0, in_place(near_collinear, point)),
      member("squared distance 3.1e-16", "danfis/libccd#55", 1.8e-8, in_place(long_triangle, above)),
      member("closest point of a thin triangle", "jrouwe/JoltPhysics closest point", 2e4, in_place(huge, below)),
      member("triangle without area", "dimforge/parry#313", 1e16, in_place(no_area, point)),
      member("ray nearly in the plane", "RenderKit/embree#387", 12291.0, in_place(plane, ray)),
  };
}

std::vector<Case> triangle_parallel() {
  const MeshPointer p = triangles({{-13.174434, 1.0, 8.736801}, {3.5251038, 1.0, 12.1}, {3.2048466, 1.0, 12.218325}});
  const MeshPointer q = triangles({{-1.63, 0.0, 11.19}, {-2.349647, 0.0, 11.037681}, {-2.349647, 1.0, 11.037681}});
  const MeshPointer capsule_a = transformed(*capsule(0.37, 0.5), z_to(Eigen::Vector3d::UnitY()));
  const MeshPointer wall_a = triangles({{-0.479988575, -1.36185002, 0.26996696},
                                        {-0.104996204, 0.38815248, 0.269967079},
                                        {-0.104996204, -1.36185002, 0.26996696}});
  const MeshPointer capsule_b = transformed(*capsule(0.42, 0.675), z_to(Eigen::Vector3d::UnitY()));
  const MeshPointer wall_b = triangles({{-0.0904417038, -4.72410202, 0.307858467},
                                        {-0.0904417038, 5.27589798, 0.307857513},
                                        {9.9095583, 5.27589798, 0.307864189}});
  return {
      member("edge on a triangle", "dimforge/parry#253", 2.0373e-7, in_place(p, q)),
      member("capsule parallel to a triangle", "jrouwe/JoltPhysics parallel capsule, 1", 0.080334,
             crossing(capsule_a, wall_a)),
      member("capsule parallel to a triangle of 10 m", "jrouwe/JoltPhysics parallel capsule, 2", 0.11214,
             crossing(capsule_b, wall_b)),
  };
}

std::vector<Case> triangle_kissing() {
  const auto flat = [](const Points& a, const Points& b) { return crossing(triangles(a), triangles(b)); };
  return {
      member("coplanar triangles that overlap", "LokiResearch/fast-triangle-triangle-intersection#3", 0.0,
             flat({{-1.0, 0.0, 0.0}, {2.0, 0.0, -2.0}, {2.0, 0.0, 2.0}},
                  {{0.551, 0.0, -0.796}, {1.224, 0.0, 0.326}, {3.469, 0.0, 1.0}})),
      member("coplanar triangles with a common edge line", "LokiResearch/fast-triangle-triangle-intersection#4", 0.0,
             flat({{0.0, 0.0, 0.0}, {0.0, 0.0, 8.0}, {8.0, 0.0, 0.0}},
                  {{2.0, 0.0, 2.0}, {1.0, 0.0, 4.0}, {9.0, 0.0, 0.0}})),
  };
}

std::vector<Case> triangle_sizes() {
  const MeshPointer small = triangles({{-81.5637589, -126.987244, -146.771729},
                                       {-81.8749924, -127.270691, -146.544403},
                                       {-81.6972275, -127.383545, -146.773254}});
  const MeshPointer hull = hexahedron(
      {Eigen::Vector3d{125.932892, -374.71225, 364.192169}, Eigen::Vector3d{319.492218, -73.2614441, 475.009613},
       Eigen::Vector3d{-122.27755, -152.200287, 192.441437}, Eigen::Vector3d{71.2817841, 149.250519, 303.258881},
       Eigen::Vector3d{-77.8921967, -359.410797, 678.579712}, Eigen::Vector3d{115.667137, -57.9600067, 789.397095},
       Eigen::Vector3d{-326.102631, -136.898834, 506.828949}, Eigen::Vector3d{-132.543304, 164.551971, 617.646362}});
  const Eigen::Vector3d center(14.8314590, 8.19055080, -4.30825043);
  const MeshPointer wall = triangles({{14.5536213, 10.5973721, -0.0060005188},
                                      {14.5536213, 10.5969315, -3.18638134},
                                      {14.5536213, 10.5969315, -5.18637228}});
  const MeshPointer ball = transformed(*sphere(0.2), z_to(-Eigen::Vector3d::UnitY(), center));
  return {
      member("small triangle, large hull", "jrouwe/JoltPhysics small triangle against a large hull", 1000.0,
             in_place(small, hull)),
      member("sphere beside a needle", "jrouwe/JoltPhysics#886", 12.0, in_place(wall, ball)),
  };
}

std::vector<Case> triangle_deep() {
  const MeshPointer wedge = triangles({{0.0, 0.0, 0.0}, {100.0, 320.0, 0.0}, {0.0, 320.0, 0.0}});
  const Placement rod{{28.87991333, 260.53430176, 0.00036135055},
                      Eigen::Quaterniond(0.77515626, -0.16498479, 0.36682746, -0.48718625).normalized()};
  const MeshPointer wall = triangles({{-42.7954292, -0.64731878, 12.4227943},
                                      {-29.911129, -0.64731878, 12.4227943},
                                      {-42.7954292, -4.86970234, 12.4227943}});
  const MeshPointer upright = transformed(*cylinder(0.25, 0.85, 48), z_to(Eigen::Vector3d::UnitY()));
  return {
      member("thin cylinder through a large triangle", "newton-physics/newton#3773", 0.0617191,
             crossing(wedge, cylinder(0.02, 0.07), rod)),
      member("cylinder before a wall", "jrouwe/JoltPhysics#1008", 1.7638e-4,
             apart(wall, upright, at(-42.8155518, -4.32299995, 12.1734285))),
  };
}

}  // namespace sixdof::stability::field
