#include "bench/study/study_pairs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include "bench/harness/own_sets.h"

namespace sixdof::study {
namespace {

SetCatalogue catalogue_of(const bench::Options& options) {
  const bool own = options.own_pair() || !options.sets.empty();
  return own ? SetCatalogue() : SetCatalogue::read(options.manifest);
}

}  // namespace

StudyPairs::StudyPairs(bench::Options options, const std::vector<std::string>& names)
    : options_(std::move(options)),
      catalogue_(catalogue_of(options_)),
      cache_(options_.sample, options_.seed,
             [this](const std::string& key) { return bench::load_mesh_of(key, options_, catalogue_); }),
      coarse_(bench::add_own_sets(options_, catalogue_, cache_)) {
  std::vector<std::string> known;
  for (const CatalogueEntry& entry : catalogue_.sets()) known.push_back(entry.pair);
  for (const std::string& name : names.empty() ? known : names) {
    const auto found = std::ranges::find(catalogue_.sets(), name, &CatalogueEntry::pair);
    if (found == catalogue_.sets().end()) {
      throw BadArgument(fmt::format("pair {}: no such pair; there are {} (--a and --b take two meshes of your own)",
                                    name, fmt::join(known, ", ")));
    }
    pairs_.push_back(&*found);
  }
}

std::string StudyPairs::argument(const std::string& mesh) const {
  return bench::load_mesh_of(mesh, options_, catalogue_).argument;
}

}  // namespace sixdof::study
