#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A model's name taken apart: "torus-knot-100k" is "torus-knot" with 100,000 triangles.
struct ModelName {
  std::string base;                      ///< What comes before the count.
  std::optional<std::size_t> triangles;  ///< A count is digits, or digits with k (thousand) or m (million).
};

/// Splits off the last part of the name if it is a count. @throws BadArgument unless the name consists of a to z, 0 to
/// 9 and '-' alone.
ModelName parse_model_name(std::string_view name);

/// One mesh by its name. RECIPE-COUNT makes a recipe's model ("torus-100k", "sphere-12500", see recipe.h). The mesh's
/// own name is the name asked for. @throws BadArgument for a name that does not exist (the message lists similar ones)
/// or a count out of range.
Mesh load_model(const std::string& name);

/// Every base name that load_model knows.
std::vector<std::string> model_names();

}  // namespace sixdof
