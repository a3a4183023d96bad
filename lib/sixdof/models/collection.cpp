#include <sixdof/models/collection.h>

#include <vector>

#include <nlohmann/json.hpp>

namespace sixdof {
namespace {

struct Content {
  std::string name;
  std::vector<CollectionObject> objects;
  std::vector<FetchedModel> files;
  std::vector<LeftOut> left_out;
};

CollectionObject object_of(const nlohmann::json& entry, const nlohmann::json& packages) {
  CollectionObject object;
  object.name = entry.at("name");
  object.kind = entry.at("kind");
  object.source = entry.value("package", "recipe");
  object.licence =
      object.source == "recipe" ? "BSD-3-Clause" : packages.at(object.source).at("licence").get<std::string>();
  object.triangles = entry.at("triangles");
  object.shells = entry.at("shells");
  object.genus = entry.at("genus");
  object.closed = entry.at("closed");
  object.box_aspect = entry.at("box_aspect");
  object.box_fill = entry.at("box_fill");
  object.hash = entry.at("hash");
  return object;
}

FetchedModel file_of(const nlohmann::json& entry, const CollectionObject& object) {
  FetchedModel model;
  model.name = object.name;
  model.summary = entry.at("path");
  model.package = object.source;
  model.licence = object.licence;
  model.file = entry.at("file");
  model.triangles = object.triangles;
  for (int k = 0; k < 3; ++k) model.size[k] = entry.at("size").at(static_cast<std::size_t>(k));
  model.genus = static_cast<unsigned>(object.genus);
  model.closed = object.closed;
  model.manifold = entry.at("manifold");
  model.hash = object.hash;
  return model;
}

Content parse_collection() {
  const auto json = nlohmann::json::parse(collection_text());
  Content content;
  content.name = json.at("name");
  for (const auto& entry : json.at("objects")) {
    content.objects.push_back(object_of(entry, json.at("packages")));
    if (entry.contains("file")) content.files.push_back(file_of(entry, content.objects.back()));
  }
  for (const auto& entry : json.at("left_out")) {
    content.left_out.push_back({entry.at("package"), entry.at("path"), entry.at("reason")});
  }
  return content;
}

const Content& content() {
  static const Content content = parse_collection();
  return content;
}

}  // namespace

std::string_view collection_name() { return content().name; }
std::span<const CollectionObject> collection() { return content().objects; }
std::span<const FetchedModel> collection_files() { return content().files; }
std::span<const LeftOut> left_out_of_collection() { return content().left_out; }

}  // namespace sixdof
