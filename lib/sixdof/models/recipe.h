#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A model made by this library: closed, manifold, facing outwards, at any triangle count in its range, the same bits
/// on every machine.
struct Recipe {
  std::string_view name;     ///< a-z and '-'.
  std::string_view summary;  ///< Shape, size in the model's length unit, and frame.
  std::size_t minimum;       ///< Fewest triangles.
  unsigned genus;            ///< Number of handles.
  Mesh (*make)(std::size_t triangles);
};

/// All recipes.
std::span<const Recipe> recipes();

/// The recipe of that name, or null.
const Recipe* find_recipe(std::string_view name);

}  // namespace sixdof
