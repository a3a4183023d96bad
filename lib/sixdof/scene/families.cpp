#include <sixdof/scene/families.h>

#include <array>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/scene/family_parts.h>

namespace sixdof::scene {
namespace {

constexpr std::array k_families{
    SceneFamily{"cube",
                "Boxes, spheres and cylinders in a cube, turned by up to 10 degrees a frame, as in FCL's own "
                "broad-phase tests: the broad phase alone.",
                detail::make_cube},
    SceneFamily{"pairs", "Detailed objects in pairs at known distances: the narrow phase.", detail::make_pairs},
    SceneFamily{"pile", "Bodies heaped on a floor, no dynamics: most touch and hardly move.", detail::make_pile},
    SceneFamily{"robot", "An arm of 21 bodies in a fixed world: few move, many pairs are ignored.", detail::make_robot},
    SceneFamily{"dust", "Small bodies that drift through a large fixed mesh, whose box covers all.", detail::make_dust},
    SceneFamily{"still", "The cube, and nothing moves after the start: the cost of asking again.", detail::make_still},
    SceneFamily{"all-move", "The cube, every body moving by up to twice its size: nothing can be kept.",
                detail::make_all_move},
    SceneFamily{"giant",
                "One slowly moving body a thousand times as large as the others, which lie about its surface: "
                "grids and sweeps that assume similar sizes.",
                detail::make_giant},
    SceneFamily{"clusters", "Dense clusters far apart, a few of which move as a whole: uneven density.",
                detail::make_clusters},
    SceneFamily{"shuffled", "The cube in another order of insertion: the same answers.", detail::make_shuffled},
};

constexpr std::array k_deforming{
    SceneFamily{"wave", "Waves over a closed shell: all of it deforms, neighbours stay neighbours.", detail::make_wave},
    SceneFamily{"twist", "A bar that is twisted and bent: its ends travel, its middle stays.", detail::make_twist},
    SceneFamily{"cloth", "A sheet that falls over a ball and comes to rest a hair above it.", detail::make_cloth},
    SceneFamily{"bump", "A bump that grows on a ball: a small part deforms, the rest does not.", detail::make_bump},
    SceneFamily{"crumple", "A shell that is folded eight times: neighbours get far apart.", detail::make_crumple},
};

/// Throws unless low <= value <= high or the value is the family's own.
void check(const char* what, double value, double low, double high) {
  if (std::isnan(value) || (value >= low && value <= high)) return;
  throw BadArgument(fmt::format("{} {}: it must be in {} .. {}", what, value, low, high));
}

std::string recipe_of(std::string_view family, const SceneNumbers& n, bool deforms) {
  const std::string bodies = deforms ? "" : fmt::format(" bodies={}", n.bodies);
  std::string text = fmt::format("family={}{} frames={} seed={}", family, bodies, n.frames, n.seed);
  const auto add = [&text](const char* name, double value) {
    if (!std::isnan(value)) text += fmt::format(" {}={}", name, value);
  };
  add("density", n.density);
  add("size_ratio", n.size_ratio);
  add("moving", n.moving);
  add("step", n.step);
  add("margin", n.margin);
  add("amplitude", n.amplitude);
  if (n.triangles > 0) text += fmt::format(" triangles={}", n.triangles);
  return text;
}

}  // namespace

std::span<const SceneFamily> scene_families() { return k_families; }
std::span<const SceneFamily> deforming_families() { return k_deforming; }

Scene make_scene(std::string_view name, const SceneNumbers& numbers) {
  constexpr std::size_t k_most_bodies = 1'000'000, k_most_frames = 100'000;
  constexpr std::size_t k_fewest_triangles = 100, k_most_triangles = 5'000'000;
  if (numbers.bodies < 2 || numbers.bodies > k_most_bodies) {
    throw BadArgument(fmt::format("{} bodies: it must be in 2 .. {}", numbers.bodies, k_most_bodies));
  }
  if (numbers.frames < 1 || numbers.frames > k_most_frames) {
    throw BadArgument(fmt::format("{} frames: it must be in 1 .. {}", numbers.frames, k_most_frames));
  }
  check("density", numbers.density, 1e-9, 10.0);
  check("size ratio", numbers.size_ratio, 1.0, 1e6);
  check("share that moves", numbers.moving, 0.0, 1.0);
  check("step", numbers.step, 0.0, 1e3);
  check("margin", numbers.margin, 0.0, 1e3);
  check("amplitude", numbers.amplitude, 1e-6, 1.0);
  if (numbers.triangles != 0 && (numbers.triangles < k_fewest_triangles || numbers.triangles > k_most_triangles)) {
    throw BadArgument(
        fmt::format("{} triangles: it must be in {} .. {}", numbers.triangles, k_fewest_triangles, k_most_triangles));
  }
  std::string names;
  for (const std::span<const SceneFamily> families : {scene_families(), deforming_families()}) {
    for (const SceneFamily& family : families) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", family.name);
      if (family.name != name) continue;
      Scene scene = family.make(numbers);
      scene.name = name;
      scene.recipe = recipe_of(name, numbers, families.data() == k_deforming.data());
      scene.check();
      return scene;
    }
  }
  throw BadArgument(fmt::format("no family of scenes {}; there are {}", name, names));
}

}  // namespace sixdof::scene
