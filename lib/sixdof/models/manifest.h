#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A real object that models/fetch gets out of a Debian package; one entry of models/models.json.
struct FetchedModel {
  std::string name;
  std::string summary;  ///< What it is and who made it, as far as known.
  std::string package;  ///< Debian package.
  std::string licence;  ///< Of the package: meshes have no statement of their own.
  std::string file;     ///< Name in the cache.
  std::size_t triangles = 0;
  Eigen::Vector3d size;  ///< Edges of the bounding box in the mesh's own unit, to four digits.
  unsigned genus = 0;    ///< Number of handles, over all components.
  bool closed = false;
  bool manifold = false;
  std::string hash;  ///< Mesh::hash() of the right file.
};

/// All entries, in the manifest's order. The manifest is part of the library.
std::span<const FetchedModel> fetched_models();

/// The entry of that name, or null.
const FetchedModel* find_fetched_model(std::string_view name);

/// Where fetched models are kept: the environment's SIXDOF_MODELS, else models/cache of the source tree that holds the
/// running program or the current directory, else models/cache of the current directory.
std::filesystem::path model_cache();

/// Reads a fetched model and checks that it is the one of the manifest. @throws BadFile naming the file if it is not
/// there, damaged or another one; the message says how to get it.
Mesh load_fetched_model(const FetchedModel& model);

}  // namespace sixdof
