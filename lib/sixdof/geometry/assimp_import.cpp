#include <algorithm>
#include <cstdio>
#include <mutex>
#include <set>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

using Eigen::Matrix4d;
using nlohmann::json;

/// Assimp drops or changes a face with an index out of range, and says so only in its log.
struct DamageLog final : Assimp::Logger {
  static inline thread_local std::string first;  ///< The first such message of the import on this thread.

  bool attachStream(Assimp::LogStream*, unsigned) override { return false; }
  bool detachStream(Assimp::LogStream*, unsigned) override { return false; }
  void OnDebug(const char*) override {}
  void OnVerboseDebug(const char*) override {}
  void OnInfo(const char*) override {}
  void OnWarn(const char* message) override {
    for (const char* words : {"out of range", "out-of-range", "out of bounds", "overflow", "nvalid index", "dropped"}) {
      if (first.empty() && std::string_view(message).find(words) != std::string_view::npos) first = message;
    }
  }
  void OnError(const char* message) override { OnWarn(message); }
};

/// Gives assimp the bytes of the file, and the files that it names, whose names may hold %20 and the like.
struct Files final : Assimp::DefaultIOSystem {
  const Source& source;
  explicit Files(const Source& s) : source(s) {}

  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (name == source.path.string()) {
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(source.bytes.data()),
                                        source.bytes.size());
    }
    std::string decoded = name;
    for (std::size_t at = 0; !Exists(name) && (at = decoded.find('%', at)) != std::string::npos; ++at) {
      unsigned code = 0;
      if (std::sscanf(decoded.c_str() + at, "%%%2x", &code) == 1) decoded.replace(at, 3, 1, static_cast<char>(code));
    }
    return DefaultIOSystem::Open(decoded.c_str(), mode);
  }
};

/// An index in a glTF file. A conversion would wrap what is negative, and has no defined result for what is too large.
std::size_t index_of(const Source& source, const json& number, const std::string& place) {
  if (!number.is_number_unsigned()) source.fail(place, "an index is not a whole number");
  return number.get<std::size_t>();
}

/// Refuses data inside a glTF file with a character that base64 has not: assimp says so, but loses what it had
/// allocated.
void check_base64(const Source& source, const json& document) {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  constexpr std::string_view k_mark = ";base64,";
  for (const char* const list : {"buffers", "images"}) {
    const json objects = document.value(list, json::array());
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const auto uri = objects[i].value("uri", std::string());
      const std::size_t mark = uri.starts_with("data:") ? uri.find(k_mark) : std::string::npos;
      if (mark != std::string::npos && uri.find_first_not_of(k_digits, mark + k_mark.size()) != std::string::npos) {
        source.fail(fmt::format("{}[{}].uri", list, i), "is not base64");
      }
    }
  }
}

/// Refuses what assimp does not check in a glTF file: the size of sparse accessors, positions that are not floats, and
/// a graph of nodes that is very deep (assimp recurses) or no tree (copies of a node may double at every level).
void check_gltf(const Source& source) {
  std::string_view text = source.bytes;
  constexpr std::size_t k_header = 20;  // magic, version, size of the file, size and type of the JSON chunk
  constexpr int k_gltf_float = 5126;
  if (text.starts_with("glTF") && text.size() > k_header) {
    if (load_bytes<std::uint32_t>(text.data() + 8) != text.size()) source.fail("byte 8", "not the file's size");
    text = text.substr(k_header, load_bytes<std::uint32_t>(text.data() + 12));
  }
  const json document = json::parse(text);
  if (!document.at("asset").at("version").get<std::string>().starts_with("2.")) source.fail("version 2 is expected");
  const json accessors = document.value("accessors", json::array());
  for (const json& accessor : accessors) {
    if (accessor.contains("sparse")) source.fail("sparse accessors are not supported");
  }
  check_base64(source, document);
  for (const json& mesh : document.value("meshes", json::array())) {
    for (const json& primitive : mesh.at("primitives")) {
      const json& position = primitive.at("attributes").at("POSITION");
      const json& accessor = accessors.at(index_of(source, position, "meshes[].primitives[].attributes.POSITION"));
      if (accessor.at("componentType") != k_gltf_float || accessor.at("type") != "VEC3") {
        source.fail("positions other than vectors of three floats are not supported");
      }
    }
  }
  constexpr std::size_t k_deepest_node = 500;
  constexpr auto k_none = static_cast<std::size_t>(-1);
  const json nodes = document.value("nodes", json::array());
  std::vector<std::size_t> parent(nodes.size(), k_none);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const json& child : nodes[i].value("children", json::array())) {
      const std::size_t c = index_of(source, child, fmt::format("nodes[{}].children", i));
      if (c >= nodes.size() || parent[c] != k_none) source.fail(fmt::format("nodes[{}]", c), "is missing or shared");
      parent[c] = i;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t at = i, depth = 0; parent[at] != k_none; at = parent[at]) {
      if (++depth > k_deepest_node) source.fail(fmt::format("nodes[{}]", i), "lies deeper than 500 levels");
    }
  }
}

/// Renames the chunks of a 3DS file that make assimp move vertices (the key framer) or reorder triangles (materials).
/// A chunk is a number (2 bytes), a length (4 bytes, these 6 included), then data or chunks.
void hide_3ds_scene(Source& source, std::size_t begin, std::size_t end) {
  constexpr std::size_t k_header = 6;
  constexpr std::uint16_t k_file = 0x4D4D, k_editor = 0x3D3D, k_materials = 0xAFFF, k_key_framer = 0xB000;
  for (std::size_t at = begin; at < end;) {
    char* const chunk = source.bytes.data() + at;
    const std::size_t length = end - at < k_header ? 0 : load_bytes<std::uint32_t>(chunk + 2);
    if (length < k_header || length > end - at) {
      source.fail(fmt::format("byte {}", at), fmt::format("a chunk of {} bytes where {} are left", length, end - at));
    }
    const auto id = load_bytes<std::uint16_t>(chunk);
    if (id == k_file || id == k_editor) hide_3ds_scene(source, at + k_header, at + length);
    if (id == k_materials || id == k_key_framer) chunk[0] = chunk[1] = '\xFF';
    at += length;
  }
}

void add_mesh(const Source& source, const aiScene& scene, unsigned number, const Matrix4d& transform,
              Surface& surface) {
  const aiMesh& mesh = *scene.mMeshes[number];
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const Eigen::Vector4d stored(mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z, 1.0);
    surface.vertices.push_back((transform * stored).head<3>());
    if (!surface.vertices.back().allFinite()) source.fail(fmt::format("mesh {}: vertex {}", number, i), "not finite");
  }
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0.0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    const auto place = [&] { return fmt::format("mesh {}: face {}", number, i); };
    if (face.mNumIndices < 3) continue;  // a point or a line
    std::vector<std::uint32_t> corners(face.mIndices, face.mIndices + face.mNumIndices);
    for (std::uint32_t& v : corners) {
      if (v >= mesh.mNumVertices) source.fail(place(), fmt::format("vertex index {} of {}", v, mesh.mNumVertices));
      v += first;
    }
    if (mirrored) std::reverse(corners.begin(), corners.end());
    add_polygon(source, corners, place, surface);
  }
}

void add_node(const Source& source, const aiScene& scene, const aiNode& node, const Matrix4d& parent,
              Surface& surface) {
  const Eigen::Map<const Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>> local(&node.mTransformation.a1);
  const Matrix4d transform = parent * local.cast<double>();
  for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(source, scene, node.mMeshes[i], transform, surface);
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(source, scene, *node.mChildren[i], transform, surface);
}

/// Leaves the importers of one extension registered: others would read the file by its content.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const one = importer.GetImporter(i);
    std::set<std::string> extensions;
    one->GetExtensionList(extensions);
    if (extensions.contains(extension)) continue;
    importer.UnregisterLoader(one);
    delete one;  // owned by who unregisters it
  }
}

}  // namespace

Surface read_by_assimp(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension.empty()) {
    throw BadFile(file.string(),
                  "has no extension, which would say its mesh format (.ply, .obj, .stl, .off, .glb and others)");
  }
  Assimp::Importer importer;
  keep_only(importer, extension.substr(1));
  if (importer.GetImporterCount() == 0) throw BadFile(file.string(), "'" + extension + "' is no mesh format");
  Source source = read_source(file);
  try {
    if (extension == ".3ds") hide_3ds_scene(source, 0, source.bytes.size());
    if (extension == ".gltf" || extension == ".glb") check_gltf(source);
  } catch (const json::exception& e) {
    source.fail(fmt::format("the JSON is malformed: {}", e.what()));
  }
  static std::once_flag once;
  std::call_once(once, [] {
    if (Assimp::DefaultLogger::isNullLogger()) Assimp::DefaultLogger::set(new DamageLog);
  });
  DamageLog::first.clear();
  importer.SetIOHandler(new Files(source));  // deleted by the importer
  const aiScene* const scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
  if (scene == nullptr) source.fail(fmt::format("assimp cannot read it: {}", importer.GetErrorString()));
  if (!DamageLog::first.empty()) source.fail("assimp finds it damaged: " + DamageLog::first);
  Surface surface;
  if (extension == ".3ds") {
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_mesh(source, *scene, i, Matrix4d::Identity(), surface);
  } else {
    add_node(source, *scene, *scene->mRootNode, Matrix4d::Identity(), surface);
  }
  return surface;
}

}  // namespace sixdof::loading
