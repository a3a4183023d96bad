#include "bench/harness/own_sets.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <sixdof/base/visible_text.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_meshes.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/common/pair_warnings.h"

namespace sixdof::bench {
namespace {

/// The file under --mesh that stands for a mesh of this name; empty if there is none.
std::string mesh_option(const std::string& name, const Options& options) {
  const auto name_of = [](const auto& path) { return visible_text(path.stem().string(), k_any_length); };
  const auto file = std::ranges::find(options.meshes, name, name_of);
  return file == options.meshes.end() ? std::string() : file->string();
}

std::vector<BucketKey> reached_buckets(const ConfigurationSet& set) {
  std::vector<BucketKey> keys;
  for (const BucketSummary& bucket : set.buckets()) {
    if (bucket.reachable > 0) keys.push_back(bucket.key);
  }
  return keys;
}

/// @param option where the mesh is, after the command line; empty if it says nothing
LoadedMesh find(const MeshIdentity& mesh, const std::filesystem::path& set, const std::string& option) {
  std::string argument = !option.empty() ? option : mesh.path.empty() ? mesh.name : mesh.path;
  return {.mesh = find_mesh(mesh, set, option), .argument = std::move(argument)};
}

void add_set(const std::filesystem::path& file, const Options& options, SetCatalogue& catalogue, PairCache& cache) {
  const ConfigurationSet set(file);
  const MeshIdentity& a = set.description().a;
  const MeshIdentity& b = set.description().b;
  const CatalogueEntry& entry = catalogue.add(file, a, b, reached_buckets(set));
  if (options.list_only) return;
  cache.keep(entry.a, find(a, file, options.a.empty() ? mesh_option(a.name, options) : options.a));
  if (b.hash != a.hash || !options.b.empty()) {
    cache.keep(entry.b, find(b, file, options.b.empty() ? mesh_option(b.name, options) : options.b));
  }
  warn_of_sizes(options.program, a, b);
  warn_of_unreached(options.program, set);
}

std::unique_ptr<const CoarseSet> add_pair(const Options& options, SetCatalogue& catalogue, PairCache& cache) {
  const std::string& b_name = options.b.empty() ? options.a : options.b;
  Mesh a = load_model(options.a);
  Mesh b = b_name == options.a ? a : load_model(b_name);
  const MeshIdentity a_identity = identify(a, options.a), b_identity = identify(b, b_name);
  if (options.list_only) {
    catalogue.add({}, a_identity, b_identity, CoarseSet::buckets(a, b));
    return nullptr;
  }
  warn_of_sizes(options.program, a_identity, b_identity);
  auto coarse = std::make_unique<const CoarseSet>(a, a_identity, b, b_identity, options.program);
  const ConfigurationSet set(coarse->file());
  const CatalogueEntry& entry = catalogue.add(coarse->file(), a_identity, b_identity, reached_buckets(set));
  cache.keep(entry.a, {.mesh = std::move(a), .argument = options.a});
  cache.keep(entry.b, {.mesh = std::move(b), .argument = b_name});
  warn_of_unreached(options.program, set);
  return coarse;
}

}  // namespace

std::unique_ptr<const CoarseSet> add_own_sets(const Options& options, SetCatalogue& catalogue, PairCache& cache) {
  if (options.own_pair()) return add_pair(options, catalogue, cache);
  for (const auto& set : options.sets) add_set(set, options, catalogue, cache);
  return nullptr;
}

LoadedMesh load_mesh_of(const std::string& key, const Options& options, const SetCatalogue& catalogue) {
  const CatalogueMesh* const mesh = catalogue.mesh(key);
  if (mesh == nullptr) return {.mesh = load_model(key), .argument = key};
  return find(mesh->identity, mesh->set, mesh_option(mesh->identity.name, options));
}

}  // namespace sixdof::bench
