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

/// True if load_model takes the word for a file: it holds a '.' or a '/', which no model's name does.
bool is_file_name(std::string_view name_or_file);

/// One mesh by its name or out of a file:
/// - RECIPE-COUNT makes a recipe's model: "torus-100k", "sphere-12500" (recipe.h);
/// - NAME reads a fetched model: "elephant" (manifest.h), and NAME-COUNT cuts it finer without changing its shape:
///   "elephant-1m" (refine.h);
/// - a path is read by load_mesh: "hull.stl", "./parts/hull.off".
/// The mesh's own name is the name asked for, or the file's.
/// @throws BadArgument for a name that does not exist (the message lists similar ones) or a count out of range; BadFile
/// for a file that cannot be read or a fetched model that is not there.
Mesh load_model(const std::string& name_or_file);

/// Every base name that load_model knows.
std::vector<std::string> model_names();

}  // namespace sixdof
