#include <sixdof/geometry/assimp_import.h>

#include <set>
#include <string>

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

namespace sixdof::loading {
namespace {

/// Leaves the importer of one format registered. Who unregisters an importer owns it.
void keep_only(Assimp::Importer& importer, const char* format) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* one = importer.GetImporter(i);
    std::set<std::string> extensions;
    one->GetExtensionList(extensions);
    if (extensions.contains(format)) continue;
    importer.UnregisterLoader(one);
    delete one;
  }
}

class Collector {
 public:
  Collector(const Source& source, const aiScene& scene) : source_(source), scene_(scene) {}

  void add_node(const aiNode& node, const Eigen::Matrix4d& parent) {
    Eigen::Matrix4d local;
    for (unsigned row = 0; row < 4; ++row) {
      for (unsigned column = 0; column < 4; ++column) local(row, column) = node.mTransformation[row][column];
    }
    const Eigen::Matrix4d transform = parent * local;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(node.mMeshes[i], transform);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], transform);
  }

  void add_mesh(unsigned number, const Eigen::Matrix4d& transform) {
    const std::string place = fmt::format("mesh {}", number);
    if (number >= scene_.mNumMeshes) source_.fail(place, "does not exist");
    const aiMesh& mesh = *scene_.mMeshes[number];
    const auto first = static_cast<std::uint32_t>(surface_.vertices.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      const Eigen::Vector4d stored(p.x, p.y, p.z, 1.0);
      const Eigen::Vector3d placed = (transform * stored).head<3>();
      if (!placed.allFinite()) source_.fail(place, fmt::format("the coordinates of vertex {} are not finite", i));
      surface_.vertices.push_back(placed);
    }
    const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) source_.fail(place, fmt::format("face {} has {} corners", i, face.mNumIndices));
      Triangle triangle;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned v = face.mIndices[k];
        if (v >= mesh.mNumVertices) {
          source_.fail(place, fmt::format("face {}: vertex index {} of {}", i, v, mesh.mNumVertices));
        }
        triangle[mirrored ? 2 - k : k] = first + v;
      }
      surface_.triangles.push_back(triangle);
    }
  }

  Surface take() { return std::move(surface_); }

 private:
  const Source& source_;
  const aiScene& scene_;
  Surface surface_;
};

}  // namespace

Surface import_by_assimp(const Source& source, const AssimpRequest& request) {
  Assimp::Importer importer;
  keep_only(importer, request.format);
  const aiScene* scene = importer.ReadFileFromMemory(request.bytes.data(), request.bytes.size(),
                                                     aiProcess_ValidateDataStructure, request.format);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    source.fail(fmt::format("assimp cannot read it: {}", importer.GetErrorString()));
  }
  Collector collector(source, *scene);
  if (request.apply_transforms) {
    collector.add_node(*scene->mRootNode, Eigen::Matrix4d::Identity());
  } else {
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) collector.add_mesh(i, Eigen::Matrix4d::Identity());
  }
  Surface surface = collector.take();
  if (surface.triangles.size() != request.triangles) {
    source.fail(
        fmt::format("assimp read {} triangles where the file has {}", surface.triangles.size(), request.triangles));
  }
  return surface;
}

}  // namespace sixdof::loading
