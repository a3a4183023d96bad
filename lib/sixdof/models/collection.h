#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <sixdof/models/manifest.h>

namespace sixdof {

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

/// The content of models/collection.json, which models/survey writes.
std::string_view collection_text();

/// The only collection.
std::string_view collection_name();

/// Its objects: closed ones, then open ones, each by number of triangles.
std::span<const CollectionObject> collection();

/// Those of them that models/fetch --collection gets and models.json does not list, as load_model() needs them.
std::span<const FetchedModel> collection_files();

std::span<const LeftOut> left_out_of_collection();

}  // namespace sixdof
