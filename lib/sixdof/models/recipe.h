#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A model that is made, not read: closed, manifold, facing outwards, at any triangle count in
/// its range, and the same bits on every machine.
struct Recipe {
  std::string_view name;     ///< Letters a to z and '-'.
  std::string_view summary;  ///< What it is, its size in its own length unit and where its frame lies.
  std::size_t minimum;       ///< Fewest triangles.
  unsigned genus;            ///< Number of handles.
  Mesh (*make)(std::size_t triangles);
};

/// All recipes, in the order in which they are listed.
std::span<const Recipe> recipes();

/// The recipe of that name, or null.
const Recipe* find_recipe(std::string_view name);

}  // namespace sixdof
