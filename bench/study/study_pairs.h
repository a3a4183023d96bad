#pragma once

#include <memory>
#include <string>
#include <vector>

#include <sixdof/configuration/set_catalogue.h>
#include "bench/harness/coarse_set.h"
#include "bench/harness/options.h"
#include "bench/harness/pair_cache.h"

namespace sixdof::study {

/// The pairs of a study with their configurations.
class StudyPairs {
 public:
  /// @param options a and b: two meshes, on a coarse set; or sets: files of sets; else the catalogue `manifest`
  /// @param names of the catalogue's pairs; with sets or meshes of the user's empty, for all of them
  /// @throws BadFile, BadArgument (a pair that does not exist: the message lists those that do), Interrupted
  StudyPairs(bench::Options options, const std::vector<std::string>& names);

  bench::PairCache& cache() { return cache_; }
  const std::vector<const CatalogueEntry*>& pairs() const { return pairs_; }
  const bench::Options& options() const { return options_; }
  /// What stands for a mesh (CatalogueEntry::a) on a command line: a model's name or a file. Loads the mesh.
  std::string argument(const std::string& mesh) const;

 private:
  const bench::Options options_;
  SetCatalogue catalogue_;
  bench::PairCache cache_;
  std::unique_ptr<const bench::CoarseSet> coarse_;
  std::vector<const CatalogueEntry*> pairs_;
};

}  // namespace sixdof::study
