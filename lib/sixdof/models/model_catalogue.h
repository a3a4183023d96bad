#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/geometry/load.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// The parts of a model's name: "torus-knot-100k" is "torus-knot" with 100,000 triangles.
struct ModelName {
  std::string base;                      ///< The name without the count.
  std::optional<std::size_t> triangles;  ///< A count is digits, or digits with k (thousand) or m (million).
};

/// The last part of the name is a count if it has the form of one. @throws BadArgument unless the name consists of a-z,
/// 0-9 and '-'.
ModelName parse_model_name(std::string_view name);

/// Whether load_model() takes the word for a file: it has a '.' or a '/'.
bool names_file(std::string_view name_or_file);

/// A mesh by its name or from a file:
/// - RECIPE-COUNT is made by a recipe or a variant: "torus-100k", "plate-12500" (recipe.h);
/// - NAME is a fetched model: "elephant", "camel" (manifest.h); NAME-COUNT is its subdivision:
/// "elephant-1m" (refine.h);
/// - a word with a '.' or a '/' is a file for load_mesh(): "hull.stl", "./parts/hull", "hull.dae#as-stored".
/// The mesh has the given name, or the file's. @param options for files
/// @throws BadArgument for a name that does not exist (the message lists similar ones) or a count out of range; BadFile
/// for a file that cannot be read or a model that is not fetched.
Mesh load_model(const std::string& name_or_file, const LoadOptions& options = {});

/// Those of `names` that are similar to `word`, nearest first: within three edits (swapped neighbours are one) and
/// about a third of the word's length, or one contains the other, which has three letters at least.
std::vector<std::string> suggestions(std::string_view word, const std::vector<std::string>& names);

}  // namespace sixdof
