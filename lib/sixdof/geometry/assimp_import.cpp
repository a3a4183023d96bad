#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

using Eigen::Matrix4d;

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
    return DefaultIOSystem::Open(Exists(name) ? name : decode_percent(name).c_str(), mode);
  }
};

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
              FileMesh& surface) {
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

Matrix4d transform_of(const aiNode& node) {
  return Eigen::Map<const Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>>(&node.mTransformation.a1).cast<double>();
}

/// @param transform of the node, with those above it
void add_node(const Source& source, const aiScene& scene, const aiNode& node, const Matrix4d& transform,
              FileMesh& surface) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(source, scene, node.mMeshes[i], transform, surface);
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    const aiNode& child = *node.mChildren[i];
    add_node(source, scene, child, transform * transform_of(child), surface);
  }
}

/// A transform of COLLADA's root, as assimp makes it of the file's unit and axes: which axis points up, scaled.
struct ColladaFrame {
  char up = 'y';
  double unit_m = 1.0;
};

ColladaFrame collada_frame(const Source& source, const Matrix4d& root) {
  const auto turned = [](std::initializer_list<double> rows) {
    return Matrix4d(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.begin()));
  };
  const double unit = root.topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  if (!(unit > 0.0)) source.fail("the file's unit is 0 m");
  const Matrix4d scale = Eigen::Vector4d(unit, unit, unit, 1.0).asDiagonal();
  for (const auto& [up, rotation] : {std::pair('y', Matrix4d(Matrix4d::Identity())),
                                     {'z', turned({1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1})},
                                     {'x', turned({0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})}}) {
    if (root == scale * rotation) return {up, unit};
  }
  source.fail("the scene has a transform of its own beside its unit and axes");
}

/// The transform of a scene's root, or what is asked for in its place, with a note of what it is.
Matrix4d root_transform(const Source& source, const aiScene& scene, FileFrame frame, std::vector<std::string>& notes) {
  const std::string extension = lower_case_extension(source.path);
  const Matrix4d root = transform_of(*scene.mRootNode);
  const char* const stored = "; read as stored";
  if (extension == ".dae" || extension == ".zae") {
    const auto [up, unit] = collada_frame(source, root);
    const std::string states = fmt::format("the file's unit is {} m and {} points up", static_cast<float>(unit), up);
    if (frame == FileFrame::as_stored) {
      notes.push_back(states + stored);
      return Matrix4d::Identity();
    }
    const bool turned = frame == FileFrame::y_up && up != 'y';
    notes.push_back(states + (unit == 1.0 ? "" : "; scaled to metres") +
                    (turned ? "; turned so that y points up" : "; axes kept"));
    return turned ? root : Matrix4d(Eigen::Vector4d(unit, unit, unit, 1.0).asDiagonal());
  }
  if (extension == ".fbx") {
    int axis = 1;
    float centimetres = 1.0f;
    if (scene.mMetaData != nullptr) {
      scene.mMetaData->Get("UpAxis", axis);
      scene.mMetaData->Get("UnitScaleFactor", centimetres);
    }
    notes.push_back(fmt::format("the file's unit is {} cm and {} points up{}", centimetres,
                                axis == 0   ? 'x'
                                : axis == 1 ? 'y'
                                            : 'z',
                                stored));
    // The format has no transform there. Assimp 5.4 puts unit and axes into it; later versions have the option below.
    return Matrix4d::Identity();
  }
  if (root == Matrix4d::Identity()) return root;
  // Assimp turns and scales some formats by the root.
  if (frame == FileFrame::as_stored) {
    notes.push_back("the transform of the scene's root is left out; read as stored");
    return Matrix4d::Identity();
  }
  notes.push_back("the scene's root has a transform, of the file or by assimp, which is applied");
  return root;
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

bool assimp_reads(const std::string& extension) {
  if (extension.size() < 2) return false;
  Assimp::Importer importer;
  keep_only(importer, extension.substr(1));
  return importer.GetImporterCount() > 0;
}

void read_by_assimp(const Source& original, FileFrame frame, const std::function<void(FileMesh&&)>& use) {
  const std::string extension = lower_case_extension(original.path);
  Source without_scene;
  if (extension == ".3ds") {
    without_scene = original;
    hide_3ds_scene(without_scene, 0, without_scene.bytes.size());
  }
  const Source& source = extension == ".3ds" ? without_scene : original;
  Assimp::Importer importer;
  keep_only(importer, extension.substr(1));
#ifdef AI_CONFIG_IMPORT_FBX_IGNORE_UP_DIRECTION  // later versions would turn FBX
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_IGNORE_UP_DIRECTION, true);
#endif
  static std::once_flag once;
  std::call_once(once, [] {
    if (Assimp::DefaultLogger::isNullLogger()) Assimp::DefaultLogger::set(new DamageLog);
  });
  DamageLog::first.clear();
  importer.SetIOHandler(new Files(source));  // deleted by the importer
  const aiScene* const scene = importer.ReadFile(source.path.string(), aiProcess_ValidateDataStructure);
  if (scene == nullptr) source.fail(fmt::format("assimp cannot read it: {}", importer.GetErrorString()));
  if (!DamageLog::first.empty()) source.fail("assimp finds it damaged: " + DamageLog::first);
  FileMesh surface;
  if (extension == ".3ds") {
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_mesh(source, *scene, i, Matrix4d::Identity(), surface);
    return use(std::move(surface));
  }
  const Matrix4d transform = root_transform(source, *scene, frame, surface.repairs.notes);
  add_node(source, *scene, *scene->mRootNode, transform, surface);
  use(std::move(surface));
}

}  // namespace sixdof::loading
