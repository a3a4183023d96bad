#pragma once

#include <memory>
#include <string>

#include <sixdof/configuration/set_catalogue.h>
#include "bench/harness/coarse_set.h"
#include "bench/harness/options.h"
#include "bench/harness/pair_cache.h"

namespace sixdof::bench {

/// Adds what the command line names to the catalogue, and its meshes to the cache: the sets of --set, or the coarse set
/// of --a and --b. Checks that every mesh is there and is the set's, so that a run ends before anything is measured. If
/// rows are only listed, no mesh of a --set is loaded and no coarse set is made.
///
/// Buckets that no configuration reaches are left out. One line on stderr for each of them, for meshes of very
/// different sizes, and for volumes that a coarse set cannot have.
/// @return the coarse set, to be kept as long as rows run; null if there is none
/// @throws BadFile, BadArgument, Interrupted
std::unique_ptr<const CoarseSet> add_own_sets(const Options& options, SetCatalogue& catalogue, PairCache& cache);

/// The mesh of a key of the catalogue (CatalogueEntry::a), from the file of its name under --mesh if there is one.
/// Other keys are names of models. @throws what find_mesh() and load_model() throw
LoadedMesh load_mesh_of(const std::string& key, const Options& options, const SetCatalogue& catalogue);

}  // namespace sixdof::bench
