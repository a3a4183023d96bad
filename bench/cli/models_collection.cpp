#include "bench/cli/models_collection.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/models/manifest.h>
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

const FetchedModel* file_of(const CollectionObject& object) {
  for (const std::span<const FetchedModel> models : {fetched_models(), collection_files()}) {
    const auto found = std::ranges::find(models, object.name, &FetchedModel::name);
    if (found != models.end()) return &*found;
  }
  return nullptr;
}

/// A recipe needs no file.
bool is_here(const CollectionObject& object) {
  const FetchedModel* const file = file_of(object);
  return file == nullptr || std::filesystem::exists(model_cache() / file->file);
}

void print_json() {
  nlohmann::ordered_json json{{"name", collection_name()}, {"cache", model_cache().string()}};
  json["objects"] = nlohmann::ordered_json::array();
  for (const CollectionObject& object : collection()) {
    const FetchedModel* const file = file_of(object);
    json["objects"].push_back({{"name", object.name},
                               {"kind", object.kind},
                               {"triangles", object.triangles},
                               {"closed", object.closed},
                               {"shells", object.shells},
                               {"genus", object.genus},
                               {"box_aspect", object.box_aspect},
                               {"box_fill", object.box_fill},
                               {"source", object.source},
                               {"licence", object.licence},
                               {"here", is_here(object)},
                               {"hash", object.hash}});
    if (file != nullptr) json["objects"].back()["file"] = file->file;
  }
  json["left_out"] = nlohmann::ordered_json::array();
  for (const LeftOut& file : left_out_of_collection()) {
    json["left_out"].push_back({{"source", file.package}, {"path", file.path}, {"reason", file.reason}});
  }
  fmt::print("{}\n", json_text(json));
}

void print_counts(bool closed) {
  std::map<std::string, std::size_t> kinds;
  std::size_t all = 0;
  for (const CollectionObject& object : collection()) {
    if (object.closed != closed) continue;
    ++kinds[object.kind];
    ++all;
  }
  fmt::print("{} {} objects:", all, closed ? "closed" : "open");
  for (const auto& [kind, count] : kinds) fmt::print(" {} {}", count, kind);
  fmt::print("{}\n", closed ? "" : " (for distances only)");
}

void print_text() {
  fmt::print("Collection {}; models/fetch --collection puts its files into {}\n", collection_name(),
             model_cache().string());
  print_counts(true);
  print_counts(false);
  fmt::print("\n{:<22} {:<8} {:>8} {:<6} {:>6} {:>6} {:>6} {:>6}  {:<8} {}\n", "name", "kind", "count", "closed",
             "shells", "genus", "aspect", "fill", "state", "source");
  for (const CollectionObject& object : collection()) {
    fmt::print("{:<22} {:<8} {:>8} {:<6} {:>6} {:>6} {:>6.3f} {:>6.3f}  {:<8} {}\n", object.name, object.kind,
               object.triangles, object.closed ? "yes" : "no", object.shells, object.genus, object.box_aspect,
               object.box_fill, is_here(object) ? "here" : "missing", object.source);
  }
  fmt::print("\nLeft out: {} meshes\n", left_out_of_collection().size());
  for (const LeftOut& file : left_out_of_collection()) {
    fmt::print("{}: {}: {}\n", file.package, file.path, file.reason);
  }
}

}  // namespace

void list_collection(const std::string& name, bool json) {
  if (name != collection_name()) {
    throw BadArgument(fmt::format("no collection is called {}; there is {}", name, collection_name()));
  }
  json ? print_json() : print_text();
}

}  // namespace sixdof::cli
