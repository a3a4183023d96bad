#pragma once

#include <cstddef>
#include <cstdint>
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

/// All entries of models/models.json, in its order. The file is a part of the library, so that an installed program
/// needs no data file.
std::span<const FetchedModel> fetched_models();

/// The folder of fetched models: $SIXDOF_MODELS; else models/cache in data_folder() if that has a list of models, or in
/// the source tree that contains the running program or the current directory; else models/cache.
std::filesystem::path model_cache();

/// Reads a fetched model and compares its hash with the manifest. @throws BadFile if the file does not exist, is
/// damaged or another mesh; the message says how to get it.
Mesh load_fetched_model(const FetchedModel& model);

/// One object of a collection: many objects of different kinds, over which a benchmark takes its mean.
struct CollectionObject {
  std::string name;     ///< For load_model().
  std::string kind;     ///< Of ShapeKind's names, or "scan" where the source says that the object was scanned.
  std::string source;   ///< "recipe", or the Debian package.
  std::string licence;  ///< Of the package; of a recipe that of this project.
  std::size_t triangles = 0;
  std::size_t shells = 0;  ///< Parts of the surface that edges connect.
  std::int64_t genus = 0;
  bool closed = false;      ///< A closed solid. If not, the object is for distances only.
  double box_aspect = 0.0;  ///< Shortest edge of the box / longest one.
  double box_fill = 0.0;    ///< Volume / volume of the box; 0 if it is not closed.
  std::string hash;         ///< Mesh::hash().
};

/// A mesh file that was looked at and is in no collection.
struct LeftOut {
  std::string package, path;
  std::string reason;
};

/// The only collection. Like the manifest, it is a part of the library (models/collection.json, by models/survey).
std::string_view collection_name();

/// Its objects: closed ones, then open ones, each by number of triangles.
std::span<const CollectionObject> collection();

/// Those of them that models/fetch --collection gets and models.json does not list, as load_model() needs them.
std::span<const FetchedModel> collection_files();

std::span<const LeftOut> left_out_of_collection();

}  // namespace sixdof
