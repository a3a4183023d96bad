#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>

namespace sixdof {

/// One configuration set as the catalogue knows it, without opening it.
struct CatalogueEntry {
  std::string pair;            ///< Part of benchmark names: a-z 0-9 '-' '_'.
  std::string a, b;            ///< Model names (or files) that load_model() takes.
  std::filesystem::path file;  ///< Absolute, or relative to the working directory.
  std::vector<BucketKey> buckets;
};

/// Which sets there are. Reading it opens no set and loads no mesh, so that benchmarks can be listed and filtered for
/// nothing.
class SetCatalogue {
 public:
  SetCatalogue() = default;

  /// Reads a manifest (`manifest.json` of `fixtures/`); files in it are relative to it.
  /// @throws BadFile naming the entry and what is wrong with it
  static SetCatalogue read(const std::filesystem::path& manifest);

  /// Adds a set of the user's: its pair is named after the two meshes. Opens the file, but reads no bucket.
  /// @throws BadFile; BadArgument if that pair is there already
  void add_file(const std::filesystem::path& set);

  const std::vector<CatalogueEntry>& sets() const { return sets_; }

 private:
  void add(CatalogueEntry set);
  std::vector<CatalogueEntry> sets_;
};

}  // namespace sixdof
