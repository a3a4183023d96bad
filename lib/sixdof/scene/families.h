#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <sixdof/scene/scene.h>

/// Families of scenes, each of which stresses something else. The same numbers give the same bits on every machine with
/// the same C++ library.
namespace sixdof::scene {

/// Parameters of a family, which ignores those that it does not use. NaN stands for the family's own value.
struct SceneNumbers {
  std::size_t bodies = 1000;  ///< How many.
  std::size_t frames = 50;    ///< Including the first, in which nothing moves.
  double density = k_own;     ///< Volume of the bodies' boxes over the volume of the space that they are in.
  double size_ratio = k_own;  ///< Of the largest to the smallest body of a shape; sizes are spread by their logarithm.
  double moving = k_own;      ///< Share of the bodies that moves in a frame, 0 to 1.
  double step = k_own;        ///< Largest translation in a frame, in sizes of a body; coherence is its inverse.
  double margin = k_own;      ///< In mean sizes of a body.
  /// Of the families in which a mesh deforms: largest displacement of a vertex, in diagonals of the mesh's box.
  double amplitude = k_own;
  std::size_t triangles = 0;  ///< Of the mesh that deforms, about so many; 0: the family's own.
  std::uint64_t seed = 1;     ///< Of everything that is drawn.
  static constexpr double k_own = std::numeric_limits<double>::quiet_NaN();  ///< The family's own value.
};

/// One family.
struct SceneFamily {
  std::string_view name;                       ///< a-z and '-'.
  std::string_view stresses;                   ///< One sentence.
  Scene (*make)(const SceneNumbers& numbers);  ///< For make_scene(), which checks the numbers.
};

/// All families of rigid bodies.
std::span<const SceneFamily> scene_families();

/// Families in which the mesh of the first body deforms, beside a few rigid ones; their number of bodies is their own.
std::span<const SceneFamily> deforming_families();

/// A scene of a family; name and recipe say which.
/// @throws BadArgument if there is no family of this name or a number is out of range; BadFile if a set is missing
Scene make_scene(std::string_view family, const SceneNumbers& numbers);

}  // namespace sixdof::scene
