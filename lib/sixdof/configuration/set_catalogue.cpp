#include <sixdof/configuration/set_catalogue.h>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Lower case, with '-' for every character that may have a meaning in a regular expression: benchmarks are selected by
/// regular expressions on their names.
std::string as_name(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    if (!plain) c = '-';
  }
  return text;
}

/// Enough digits of a content hash to tell meshes apart in names.
std::string short_hash(const MeshIdentity& mesh) { return mesh.hash.substr(0, 8); }

bool may_be_same(const MeshIdentity& a, const MeshIdentity& b) {
  return a.hash.empty() || b.hash.empty() || a.hash == b.hash;
}

MeshIdentity read_mesh(const nlohmann::json& json) {
  MeshIdentity mesh{.name = json.at("name").get<std::string>()};
  mesh.hash = json.value("content_hash", "");
  mesh.path = json.value("path", "");
  mesh.absolute_path = json.value("absolute_path", "");
  return mesh;
}

}  // namespace

SetCatalogue SetCatalogue::read(const std::filesystem::path& manifest) {
  std::ifstream file(manifest);
  if (!file) throw BadFile(manifest.string(), "cannot be opened");
  SetCatalogue catalogue;
  try {
    const auto json = nlohmann::json::parse(file);
    for (const auto& entry : json.at("sets")) {
      CatalogueEntry set{.pair = entry.at("pair").get<std::string>(),
                         .file = manifest.parent_path() / entry.at("file").get<std::string>()};
      set.a = catalogue.add_mesh(read_mesh(entry.at("a")), set.file);
      set.b = catalogue.add_mesh(read_mesh(entry.at("b")), set.file);
      for (const auto& bucket : entry.at("buckets")) set.buckets.push_back(BucketKey::parse(bucket.get<std::string>()));
      catalogue.add(std::move(set));
    }
  } catch (const std::exception& e) {  // of JSON, or BadArgument
    throw BadFile(manifest.string(), fmt::format("set {}", catalogue.sets_.size()), e.what());
  }
  return catalogue;
}

const CatalogueEntry& SetCatalogue::add(const std::filesystem::path& set, const MeshIdentity& a, const MeshIdentity& b,
                                        std::vector<BucketKey> buckets) {
  std::string pair = as_name(a.hash == b.hash ? a.name : a.name + "-" + b.name);
  const auto known = std::ranges::find(sets_, pair, &CatalogueEntry::pair);
  if (known != sets_.end() && !has_meshes(*known, a, b)) {
    pair += fmt::format("-{}-{}", short_hash(a), short_hash(b));
  }
  add({.pair = std::move(pair),
       .a = add_mesh(a, set),
       .b = add_mesh(b, set),
       .file = set,
       .buckets = std::move(buckets)});
  return sets_.back();
}

const CatalogueMesh* SetCatalogue::mesh(const std::string& key) const {
  const auto found = meshes_.find(key);
  return found == meshes_.end() ? nullptr : &found->second;
}

std::string SetCatalogue::add_mesh(const MeshIdentity& mesh, const std::filesystem::path& set) {
  std::string key = as_name(mesh.name);
  const auto known = meshes_.find(key);
  const bool taken = known != meshes_.end() && !may_be_same(known->second.identity, mesh);
  if (!mesh.path.empty() || taken) key += "@" + short_hash(mesh);
  meshes_.try_emplace(key, CatalogueMesh{.identity = mesh, .set = set});
  return key;
}

bool SetCatalogue::has_meshes(const CatalogueEntry& entry, const MeshIdentity& a, const MeshIdentity& b) const {
  return may_be_same(meshes_.at(entry.a).identity, a) && may_be_same(meshes_.at(entry.b).identity, b);
}

void SetCatalogue::add(CatalogueEntry set) {
  if (set.pair.empty() || set.pair != as_name(set.pair)) {
    throw BadArgument(fmt::format("pair name '{}': only a-z, 0-9, '-' and '_'", set.pair));
  }
  for (const CatalogueEntry& other : sets_) {
    if (other.pair == set.pair) {
      throw BadArgument(fmt::format("pair {}: is in {} already", set.pair, other.file.string()));
    }
  }
  sets_.push_back(std::move(set));
}

}  // namespace sixdof
