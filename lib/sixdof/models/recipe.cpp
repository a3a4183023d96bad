#include <sixdof/models/recipe.h>

#include <array>

namespace sixdof {
namespace {

/// The shape in its standard size.
template <class Shape, Mesh (*make)(const Shape&, std::size_t)>
Mesh standard(std::size_t triangles) {
  return make({}, triangles);
}

constexpr std::array k_recipes{
    Recipe{"sphere", "ball of radius 1 about the origin", k_minimum_sphere, 0, standard<SphereShape, make_sphere>},
    Recipe{"bumpy-sphere", "ball of radius 1 about the origin with smooth bumps of 12 %", k_minimum_sphere, 0,
           standard<BumpySphereShape, make_bumpy_sphere>},
    Recipe{"box", "block of 2 x 1.6 x 1.2 along x, y, z, centred at the origin", k_minimum_box, 0,
           standard<BoxShape, make_box>},
    Recipe{"cylinder", "radius 1, height 2, axis z, centred at the origin", k_minimum_cylinder, 0,
           standard<CylinderShape, make_cylinder>},
    Recipe{"cone", "base disc of radius 1 in the plane z = 0 about the origin, apex at (0, 0, 2)", k_minimum_cone, 0,
           standard<ConeShape, make_cone>},
    Recipe{"torus", "radii 1 and 0.4, axis z, centred at the origin", k_minimum_torus, 1,
           standard<TorusShape, make_torus>},
    Recipe{"torus-knot",
           "trefoil about the z axis, centred at the origin: core on a torus of radii 1 and 0.5, tube of "
           "radius 0.25",
           k_minimum_torus_knot, 1, standard<TorusKnotShape, make_torus_knot>},
    Recipe{"circular-box",
           "ring of 12 hollow box cells about the z axis, centred at the origin: outer radius 1, inner "
           "radius 0.5, height 0.5, beams 0.1; flat walls, sharp edges, open windows",
           minimum_triangles(CircularBoxShape{}), 4 * CircularBoxShape{}.sectors + 1,
           standard<CircularBoxShape, make_circular_box>},
    Recipe{"gyroid-ball",
           "one labyrinth of a gyroid of period 1 in the ball of radius 1 about the origin, edges rounded",
           k_minimum_gyroid_ball, 13, standard<GyroidBallShape, make_gyroid_ball>},
};

}  // namespace

std::span<const Recipe> recipes() { return k_recipes; }

}  // namespace sixdof
