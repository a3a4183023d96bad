#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/configuration/bucket.h>

namespace sixdof {

/// A configuration set as the catalogue describes it. Its file has not been read.
struct CatalogueEntry {
  std::string pair;            ///< Name of the pair in benchmarks: a-z 0-9 '-' '_'.
  std::string a, b;            ///< Model names (or files) that load_model() takes.
  std::filesystem::path file;  ///< Absolute, or relative to the working directory.
  std::vector<BucketKey> buckets;
};

/// A list of configuration sets. Reading it opens no set and loads no mesh, so that benchmarks are listed and filtered
/// at no cost.
class SetCatalogue {
 public:
  /// Reads a manifest (`manifest.json` of `fixtures/`), whose file names are relative to its folder.
  /// @throws BadFile naming the entry and the cause
  static SetCatalogue read(const std::filesystem::path& manifest);

  /// Adds a set of the user's. Its pair is named after the two meshes. Opens the file, but reads no bucket.
  /// @throws BadFile; BadArgument if that pair is there already
  void add_file(const std::filesystem::path& set);

  const std::vector<CatalogueEntry>& sets() const { return sets_; }

 private:
  void add(CatalogueEntry set);
  std::vector<CatalogueEntry> sets_;
};

}  // namespace sixdof
