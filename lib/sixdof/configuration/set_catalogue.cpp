#include <sixdof/configuration/set_catalogue.h>

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>

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

}  // namespace

SetCatalogue SetCatalogue::read(const std::filesystem::path& manifest) {
  std::ifstream file(manifest);
  if (!file) throw BadFile(manifest.string(), "cannot be opened");
  SetCatalogue catalogue;
  try {
    const auto json = nlohmann::json::parse(file);
    for (const auto& entry : json.at("sets")) {
      CatalogueEntry set{.pair = entry.at("pair").get<std::string>(),
                         .a = entry.at("a").at("name").get<std::string>(),
                         .b = entry.at("b").at("name").get<std::string>(),
                         .file = manifest.parent_path() / entry.at("file").get<std::string>()};
      for (const auto& bucket : entry.at("buckets")) set.buckets.push_back(BucketKey::parse(bucket.get<std::string>()));
      catalogue.add(std::move(set));
    }
  } catch (const std::exception& e) {  // of JSON, or BadArgument
    throw BadFile(manifest.string(), fmt::format("set {}", catalogue.sets_.size()), e.what());
  }
  return catalogue;
}

void SetCatalogue::add_file(const std::filesystem::path& path) {
  const ConfigurationSet opened(path);
  const MeshIdentity& a = opened.description().a;
  const MeshIdentity& b = opened.description().b;
  CatalogueEntry set{
      .pair = as_name(a.hash == b.hash ? a.name : a.name + "-" + b.name), .a = a.name, .b = b.name, .file = path};
  for (const BucketSummary& bucket : opened.buckets()) set.buckets.push_back(bucket.key);
  add(std::move(set));
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
