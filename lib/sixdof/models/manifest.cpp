#include <sixdof/models/manifest.h>

#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>

namespace sixdof {
namespace {

std::vector<FetchedModel> parse_manifest() {
  const auto json = nlohmann::json::parse(manifest_text());
  std::vector<FetchedModel> models;
  for (const auto& entry : json.at("models")) {
    FetchedModel model;
    model.name = entry.at("name");
    model.summary = entry.at("summary");
    model.package = entry.at("package");
    model.licence = json.at("packages").at(model.package).at("licence");
    model.file = entry.at("file");
    model.triangles = entry.at("triangles");
    for (int k = 0; k < 3; ++k) model.size[k] = entry.at("size").at(static_cast<std::size_t>(k));
    model.genus = entry.at("genus");
    model.closed = entry.at("closed");
    model.manifold = entry.at("manifold");
    model.hash = entry.at("hash");
    models.push_back(std::move(model));
  }
  return models;
}

/// The folder models/ of the source tree around `start`, empty if there is none.
std::filesystem::path models_folder_above(std::filesystem::path start) {
  std::error_code ignored;
  for (; !start.empty(); start = start.parent_path()) {
    if (std::filesystem::exists(start / "models" / "models.json", ignored)) return start / "models";
    if (start == start.parent_path()) break;
  }
  return {};
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
    const std::filesystem::path folder = models_folder_above(start);
    if (!folder.empty()) return folder / "cache";
  }
  return std::filesystem::path("models") / "cache";
}

Mesh load_fetched_model(const FetchedModel& model) {
  const std::filesystem::path file = model_cache() / model.file;
  const std::string remedy = fmt::format("run models/fetch {}", model.name);
  if (!std::filesystem::exists(file)) {
    throw BadFile(file.string(), fmt::format("the model {} is not here yet: {}", model.name, remedy));
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

}  // namespace sixdof
