#include <sixdof/models/manifest.h>

#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>

namespace sixdof {

std::string_view manifest_text();    // models/models.json
std::string_view collection_text();  // models/collection.json

namespace {

/// An entry with a file, of either list. @param summary key of its description
FetchedModel fetched_model(const nlohmann::json& entry, const char* summary, const std::string& licence) {
  FetchedModel model{.name = entry.at("name"),
                     .summary = entry.at(summary),
                     .package = entry.at("package"),
                     .licence = licence,
                     .file = entry.at("file"),
                     .triangles = entry.at("triangles"),
                     .size = {},
                     .genus = entry.at("genus"),
                     .closed = entry.at("closed"),
                     .manifold = entry.at("manifold"),
                     .hash = entry.at("hash")};
  for (int k = 0; k < 3; ++k) model.size[k] = entry.at("size").at(static_cast<std::size_t>(k));
  return model;
}

std::vector<FetchedModel> parse_manifest() {
  const auto json = nlohmann::json::parse(manifest_text());
  std::vector<FetchedModel> models;
  for (const auto& entry : json.at("models")) {
    const auto& package = json.at("packages").at(entry.at("package").get<std::string>());
    models.push_back(fetched_model(entry, "summary", package.at("licence")));
  }
  return models;
}

struct Collection {
  std::string name;
  std::vector<CollectionObject> objects;
  std::vector<FetchedModel> files;
  std::vector<LeftOut> left_out;
};

Collection parse_collection() {
  const auto json = nlohmann::json::parse(collection_text());
  Collection result;
  result.name = json.at("name");
  for (const auto& entry : json.at("objects")) {
    const std::string source = entry.value("package", "recipe");
    const std::string licence =
        source == "recipe" ? "BSD-3-Clause" : json.at("packages").at(source).at("licence").get<std::string>();
    result.objects.push_back({.name = entry.at("name"),
                              .kind = entry.at("kind"),
                              .source = source,
                              .licence = licence,
                              .triangles = entry.at("triangles"),
                              .shells = entry.at("shells"),
                              .genus = entry.at("genus"),
                              .closed = entry.at("closed"),
                              .box_aspect = entry.at("box_aspect"),
                              .box_fill = entry.at("box_fill"),
                              .hash = entry.at("hash")});
    if (entry.contains("file")) result.files.push_back(fetched_model(entry, "path", licence));
  }
  for (const auto& entry : json.at("left_out")) {
    result.left_out.push_back({entry.at("package"), entry.at("path"), entry.at("reason")});
  }
  return result;
}

const Collection& the_collection() {
  static const Collection parsed = parse_collection();
  return parsed;
}

}  // namespace

std::span<const FetchedModel> fetched_models() {
  static const std::vector<FetchedModel> models = parse_manifest();
  return models;
}

std::filesystem::path model_cache() {
  const char* const chosen = std::getenv("SIXDOF_MODELS");
  if (chosen != nullptr && *chosen != '\0') return chosen;
  std::error_code ignored;
  const std::filesystem::path packaged = data_folder() / "models";
  if (std::filesystem::exists(packaged / "models.json", ignored)) return packaged / "cache";
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path here = std::filesystem::current_path(ignored);
  for (const std::filesystem::path& start : {program.parent_path(), here}) {
    const std::filesystem::path list = find_above(start, std::filesystem::path("models") / "models.json");
    if (!list.empty()) return list.parent_path() / "cache";
  }
  return std::filesystem::path("models") / "cache";
}

Mesh load_fetched_model(const FetchedModel& model) {
  const std::filesystem::path file = model_cache() / model.file;
  const std::string remedy = fmt::format("run models/fetch {}", model.name);
  if (!std::filesystem::exists(file)) {
    throw BadFile(file.string(), fmt::format("the model {} has not been fetched: {}", model.name, remedy));
  }
  Mesh mesh = [&] {
    try {
      return load_mesh(file);
    } catch (const Error& e) {
      throw BadFile(e.what(), remedy);
    }
  }();
  if (mesh.hash() != model.hash) {
    throw BadFile(file.string(), fmt::format("is not the model {}: its content hash is {}, not {}; {}", model.name,
                                             mesh.hash(), model.hash, remedy));
  }
  return mesh;
}

std::string_view collection_name() { return the_collection().name; }
std::span<const CollectionObject> collection() { return the_collection().objects; }
std::span<const FetchedModel> collection_files() { return the_collection().files; }
std::span<const LeftOut> left_out_of_collection() { return the_collection().left_out; }

}  // namespace sixdof
