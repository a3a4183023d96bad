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

/// A box of these edges.
Mesh box(double x, double y, double z, std::size_t triangles) { return make_box({.size = {x, y, z}}, triangles); }

constexpr std::array k_variants{
    // Thin shapes: a sheet, rods, wires.
    Recipe{"plate", "box of 2 x 1.6 x 0.04", k_minimum_box, 0, [](std::size_t n) { return box(2.0, 1.6, 0.04, n); }},
    Recipe{"rod", "cylinder of radius 0.04, height 2", k_minimum_cylinder, 0,
           [](std::size_t n) { return make_cylinder({.radius = 0.04, .height = 2.0}, n); }},
    Recipe{"disc", "cylinder of radius 1, height 0.05", k_minimum_cylinder, 0,
           [](std::size_t n) { return make_cylinder({.radius = 1.0, .height = 0.05}, n); }},
    Recipe{"needle", "cone of radius 0.05, height 2", k_minimum_cone, 0,
           [](std::size_t n) { return make_cone({.radius = 0.05, .height = 2.0}, n); }},
    Recipe{"hoop", "torus of radii 1 and 0.04", 1000, 1,
           [](std::size_t n) { return make_torus({.major_radius = 1.0, .minor_radius = 0.04}, n); }},
    Recipe{"wire-knot", "trefoil with a tube of radius 0.05", 3000, 1,
           [](std::size_t n) { return make_torus_knot({.tube_radius = 0.05}, n); }},

    // Boxes, cylinders, cones.
    Recipe{"cube", "box of 1 x 1 x 1", k_minimum_box, 0, [](std::size_t n) { return box(1.0, 1.0, 1.0, n); }},
    Recipe{"brick", "box of 2 x 1 x 0.5", k_minimum_box, 0, [](std::size_t n) { return box(2.0, 1.0, 0.5, n); }},
    Recipe{"beam", "box of 3 x 0.3 x 0.3", k_minimum_box, 0, [](std::size_t n) { return box(3.0, 0.3, 0.3, n); }},
    Recipe{"puck", "cylinder of radius 1, height 0.4", k_minimum_cylinder, 0,
           [](std::size_t n) { return make_cylinder({.radius = 1.0, .height = 0.4}, n); }},
    Recipe{"shaft", "cylinder of radius 0.2, height 2", k_minimum_cylinder, 0,
           [](std::size_t n) { return make_cylinder({.radius = 0.2, .height = 2.0}, n); }},
    Recipe{"flat-cone", "cone of radius 1, height 0.5", k_minimum_cone, 0,
           [](std::size_t n) { return make_cone({.radius = 1.0, .height = 0.5}, n); }},
    Recipe{"fat-torus", "torus of radii 1 and 0.8", k_minimum_torus, 1,
           [](std::size_t n) { return make_torus({.major_radius = 1.0, .minor_radius = 0.8}, n); }},
    Recipe{"slim-torus", "torus of radii 1 and 0.15", 200, 1,
           [](std::size_t n) { return make_torus({.major_radius = 1.0, .minor_radius = 0.15}, n); }},

    // Curved everywhere.
    Recipe{"dented-sphere", "bumpy sphere, bumps of 35 %, 1 wave", k_minimum_sphere, 0,
           [](std::size_t n) { return make_bumpy_sphere({.amplitude = 0.35, .waves = 1.0}, n); }},
    Recipe{"lumpy-sphere", "bumpy sphere, bumps of 20 %, 3 waves", 500, 0,
           [](std::size_t n) { return make_bumpy_sphere({.amplitude = 0.2, .waves = 3.0}, n); }},
    Recipe{"rough-sphere", "bumpy sphere, bumps of 4 %, 8 waves", 2000, 0,
           [](std::size_t n) { return make_bumpy_sphere({.amplitude = 0.04, .waves = 8.0}, n); }},
    Recipe{"cinquefoil", "torus knot (2, 5), tube of radius 0.15", 1500, 1,
           [](std::size_t n) { return make_torus_knot({.tube_radius = 0.15, .revolutions = 2, .windings = 5}, n); }},
    Recipe{"septafoil", "torus knot (3, 7), tube of radius 0.1", 3000, 1,
           [](std::size_t n) { return make_torus_knot({.tube_radius = 0.1, .revolutions = 3, .windings = 7}, n); }},

    // Many handles. The counts of the gyroid balls are those from which their topology can be coarsened.
    Recipe{"circular-box-small", "ring of 6 hollow box cells", minimum_triangles(CircularBoxShape{.sectors = 6}), 25,
           [](std::size_t n) { return make_circular_box({.sectors = 6}, n); }},
    Recipe{"circular-box-large", "ring of 40 hollow box cells, beams 0.05",
           minimum_triangles(CircularBoxShape{.sectors = 40}), 161,
           [](std::size_t n) { return make_circular_box({.beam = 0.05, .sectors = 40}, n); }},
    Recipe{"gyroid-ball-fine", "gyroid of period 0.6, edges rounded by 0.05", 8000, 63,
           [](std::size_t n) { return make_gyroid_ball({.period = 0.6, .rounding = 0.05}, n); }},
};

}  // namespace

std::span<const Recipe> recipes() { return k_recipes; }
std::span<const Recipe> recipe_variants() { return k_variants; }

}  // namespace sixdof
