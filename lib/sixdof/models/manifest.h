#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A real object that models/fetch gets from a Debian package: one entry of models/models.json.
struct FetchedModel {
  std::string name;
  std::string summary;  ///< What it is and, if known, who made it.
  std::string package;  ///< Debian package.
  std::string licence;  ///< Of the package: the meshes do not state theirs.
  std::string file;     ///< Name in the cache.
  std::size_t triangles = 0;
  Eigen::Vector3d size;  ///< Edges of the bounding box in the mesh's own unit, to four digits.
  unsigned genus = 0;    ///< Number of handles, over all components.
  bool closed = false;
  bool manifold = false;
  std::string hash;  ///< Mesh::hash() of the file.
};

/// The content of models/models.json: a part of the library, so that an installed program needs no data file.
std::string_view manifest_text();

/// All entries, in the manifest's order.
std::span<const FetchedModel> fetched_models();

/// The folder of fetched models: that of environment variable SIXDOF_MODELS, else models/cache in
/// data_folder() if that has a list of models, else models/cache of the source tree that contains the running program
/// or the current directory, else models/cache in the current directory.
std::filesystem::path model_cache();

/// Reads a fetched model and compares its hash with the manifest. @throws BadFile if the file does not exist, is
/// damaged or another mesh; the message says how to get it.
Mesh load_fetched_model(const FetchedModel& model);

}  // namespace sixdof
