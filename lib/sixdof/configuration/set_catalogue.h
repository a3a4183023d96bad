#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>

namespace sixdof {

/// A configuration set as the catalogue describes it. Its file has not been read.
struct CatalogueEntry {
  std::string pair;                ///< Name of the pair in benchmarks: a-z 0-9 '-' '_'.
  std::string a;                   ///< Key of mesh A (SetCatalogue::mesh()).
  std::string b;                   ///< Key of mesh B.
  std::filesystem::path file;      ///< Absolute, or relative to the working directory.
  std::vector<BucketKey> buckets;  ///< Those that the set has.
};

/// A mesh of a set, for find_mesh().
struct CatalogueMesh {
  MeshIdentity identity;      ///< Name and, where known, hash and paths.
  std::filesystem::path set;  ///< The file of a set that has the mesh.
};

/// A list of configuration sets. Reading it opens no set and loads no mesh, so that benchmarks are listed and filtered
/// at no cost.
class SetCatalogue {
 public:
  /// Reads a manifest (`manifest.json` of `fixtures/`), whose file names are relative to its folder.
  /// @throws BadFile naming the entry and the cause
  static SetCatalogue read(const std::filesystem::path& manifest);

  /// Adds a set of the user's. Its pair is named after the two meshes, with their hashes if another pair has that name.
  /// @return the entry; valid until the next call
  /// @throws BadArgument if that pair is there already
  const CatalogueEntry& add(const std::filesystem::path& set, const MeshIdentity& a, const MeshIdentity& b,
                            std::vector<BucketKey> buckets);

  /// All sets, in the order in which they were read and added.
  const std::vector<CatalogueEntry>& sets() const { return sets_; }

  /// The mesh of a key; null if no set has it. The key of a model is its name. Keys of other meshes have a part of
  /// their hash, "part@1f0c62e9", so that two files of one name have two keys and none is a model's.
  const CatalogueMesh* mesh(const std::string& key) const;

 private:
  std::string add_mesh(const MeshIdentity& mesh, const std::filesystem::path& set);
  void add(CatalogueEntry set);
  /// Whether the entry is of these meshes, as far as hashes are known.
  bool has_meshes(const CatalogueEntry& entry, const MeshIdentity& a, const MeshIdentity& b) const;

  std::vector<CatalogueEntry> sets_;
  std::map<std::string, CatalogueMesh> meshes_;
};

}  // namespace sixdof
