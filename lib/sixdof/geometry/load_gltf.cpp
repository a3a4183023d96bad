#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/gltf_data.h>

namespace sixdof::loading {
namespace {

using Eigen::Matrix4d;
using nlohmann::json;

/// Vertices and triangles that a file may have beyond what its accessors hold, by using meshes several times. A small
/// file could use one often enough to fill the memory.
constexpr std::size_t k_most_copies = 20'000'000;

constexpr const char* k_instancing = "EXT_mesh_gpu_instancing";

/// Whether a file that requires the extension can be read without knowing it, or by what is known of it here.
bool is_harmless(std::string_view extension) {
  constexpr std::array k_names{
      k_instancing,      "KHR_mesh_quantization", "KHR_lights_punctual",   "KHR_techniques_webgl",   "KHR_xmp",
      "KHR_xmp_json_ld", "EXT_mesh_features",     "EXT_instance_features", "EXT_structural_metadata"};
  constexpr std::array k_families{"KHR_materials_", "KHR_texture_",     "EXT_materials_", "EXT_texture_",
                                  "EXT_lights_",    "ADOBE_materials_", "MSFT_texture_"};
  const auto begins = [&](const char* family) { return extension.starts_with(family); };
  return std::ranges::find(k_names, extension) != k_names.end() || std::ranges::any_of(k_families, begins);
}

/// One mesh of the file, in its own coordinates.
struct Part {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), data_(source) {}

  FileMesh read() {
    check_extensions();
    add_scene();
    if (morphed_) note("morph targets are not applied");
    if (skinned_) note("skins are not applied: meshes stand as they were bound");
    if (!list("animations").empty()) note("animations are not applied");
    return std::move(surface_);
  }

 private:
  const json& list(const char* name) const { return GltfData::member(data_.document(), name); }
  void note(std::string words) { surface_.repairs.notes.push_back(std::move(words)); }

  void check_extensions() const {
    for (const json& name : list("extensionsRequired")) {
      const std::string& extension = name.get_ref<const std::string&>();
      if (is_harmless(extension)) continue;
      source_.fail("extensionsRequired", visible_text(extension) + " is not supported");
    }
  }

  /// The nodes at the top of the default scene, the first one if none is said to be it.
  void add_scene() {
    const json &scenes = list("scenes"), &nodes = list("nodes");
    std::vector<std::size_t> roots;
    if (!scenes.empty()) {
      const std::size_t number = data_.whole(data_.document(), "scene", 0, "the document");
      const json& scene = data_.element("scenes", number, "scene");
      for (const json& root : GltfData::member(scene, "nodes")) {
        roots.push_back(data_.whole(root, fmt::format("scenes[{}].nodes", number)));
      }
      if (scenes.size() > 1) note(fmt::format("scene {} of {} is read, the default one", number, scenes.size()));
    } else if (!nodes.empty()) {
      roots = roots_of(nodes);
      note("the file has no scenes: all nodes are read");
    } else {
      note("the file has no scenes and no nodes: all meshes are read");
      for (std::size_t i = 0; i < list("meshes").size(); ++i) place(part(i), i, Matrix4d::Identity());
    }
    add_nodes(roots);
  }

  std::vector<std::size_t> roots_of(const json& nodes) const {
    std::set<std::size_t> children;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (const json& child : GltfData::member(nodes[i], "children"))
        children.insert(data_.whole(child, child_place(i)));
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!children.contains(i)) roots.push_back(i);
    }
    return roots;
  }

  static std::string child_place(std::size_t node) { return fmt::format("nodes[{}].children", node); }

  /// Adds nodes and all below them; depth first, without recursion: a file may be deep.
  void add_nodes(const std::vector<std::size_t>& roots) {
    struct Pending {
      std::size_t node;
      Matrix4d parent;
    };
    std::vector<Pending> pending;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending.push_back({*root, Matrix4d::Identity()});
    std::set<std::size_t> seen;
    while (!pending.empty()) {
      const auto [number, parent] = pending.back();
      pending.pop_back();
      const std::string here = fmt::format("nodes[{}]", number);
      const json& node = data_.element("nodes", number, here);
      if (!seen.insert(number).second) source_.fail(here, "is used twice, or below itself");
      const Matrix4d transform = parent * local_transform(node, here);
      add_meshes(node, here, transform);
      const json& children = GltfData::member(node, "children");
      for (std::size_t i = children.size(); i-- > 0;) {
        pending.push_back({data_.whole(children[i], child_place(number)), transform});
      }
    }
  }

  /// Numbers of a node; nothing if it has none of that name.
  template <int count>
  std::optional<Eigen::Matrix<double, count, 1>> numbers_of(const json& node, const char* name,
                                                            const std::string& place) const {
    const auto found = node.find(name);
    if (found == node.end()) return std::nullopt;
    if (!found->is_array() || found->size() != count)
      source_.fail(place + "." + name, fmt::format("is not {} numbers", count));
    Eigen::Matrix<double, count, 1> values;
    for (int i = 0; i < count; ++i) values[i] = (*found)[static_cast<std::size_t>(i)].template get<double>();
    return values;
  }

  Matrix4d transform_of(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
                        const Eigen::Vector3d& scale, const std::string& place) const {
    const double length = rotation.norm();
    if (!(length > 0.0)) source_.fail(place, "its rotation is no quaternion");
    Matrix4d transform = Matrix4d::Identity();
    // What was written in a few digits is no unit quaternion, and would scale.
    const Eigen::Quaterniond q(rotation / length);  // x, y, z, w in both
    transform.topLeftCorner<3, 3>() = q.toRotationMatrix() * scale.asDiagonal();
    transform.topRightCorner<3, 1>() = translation;
    return transform;
  }

  Matrix4d local_transform(const json& node, const std::string& place) const {
    if (const auto matrix = numbers_of<16>(node, "matrix", place)) return Eigen::Map<const Matrix4d>(matrix->data());
    const auto translation = numbers_of<3>(node, "translation", place), scale = numbers_of<3>(node, "scale", place);
    const auto rotation = numbers_of<4>(node, "rotation", place);
    if (!translation && !scale && !rotation) return Matrix4d::Identity();
    return transform_of(translation.value_or(Eigen::Vector3d::Zero()), rotation.value_or(Eigen::Vector4d::UnitW()),
                        scale.value_or(Eigen::Vector3d::Ones()), place);
  }

  void add_meshes(const json& node, const std::string& here, const Matrix4d& transform) {
    const auto mesh = node.find("mesh");
    if (mesh == node.end()) return;
    skinned_ = skinned_ || node.contains("skin");
    const std::size_t number = data_.whole(*mesh, here + ".mesh");
    data_.element("meshes", number, here + ".mesh");
    const Part placed = part(number);
    const json& extensions = GltfData::member(node, "extensions");
    const auto instancing = extensions.find(k_instancing);
    if (instancing == extensions.end()) return place(placed, number, transform);
    for (const Matrix4d& instance : instances(*instancing, here)) place(placed, number, transform * instance);
  }

  /// The transforms of a node's copies.
  std::vector<Matrix4d> instances(const json& instancing, const std::string& here) {
    const json& attributes = instancing.at("attributes");
    std::optional<std::size_t> count;
    const auto values = [&](const char* name, std::size_t width) {
      const auto found = attributes.find(name);
      if (found == attributes.end()) return std::vector<double>();
      std::vector<double> list = data_.numbers(data_.whole(*found, here + "." + name), width);
      if (count && *count != list.size() / width) source_.fail(here, "its instances differ in number");
      count = list.size() / width;
      return list;
    };
    const std::vector<double> translations = values("TRANSLATION", 3), rotations = values("ROTATION", 4),
                              scales = values("SCALE", 3);
    if (!count) source_.fail(here, std::string(k_instancing) + " states no instances");
    visits_ += *count;
    check_size({}, 0);
    std::vector<Matrix4d> transforms;
    for (std::size_t i = 0; i < *count; ++i) {
      const auto triple = [i](const std::vector<double>& list, double otherwise) -> Eigen::Vector3d {
        if (list.empty()) return Eigen::Vector3d::Constant(otherwise);
        return {list[3 * i], list[3 * i + 1], list[3 * i + 2]};
      };
      Eigen::Vector4d rotation = Eigen::Vector4d::UnitW();
      if (!rotations.empty()) rotation = Eigen::Map<const Eigen::Vector4d>(&rotations[4 * i]);
      transforms.push_back(transform_of(triple(translations, 0.0), rotation, triple(scales, 1.0), here));
    }
    return transforms;
  }

  /// Before `more` vertices or triangles are added to a part, or to the surface.
  void check_size(const Part& part, std::size_t more) const {
    const std::size_t size = part.vertices.size() + part.triangles.size() + surface_.vertices.size() +
                             surface_.triangles.size() + visits_ + more;
    if (size <= k_most_copies + accessors_size_) return;
    source_.fail(fmt::format(
        "its meshes, as often as they are used, have more than {} vertices and triangles of copies", k_most_copies));
  }

  /// An accessor has been read.
  void count_accessor(std::size_t accessor, std::size_t size) {
    if (sizes_.try_emplace(accessor, size).second) accessors_size_ += size;
  }

  Part part(std::size_t number) {
    const std::string here = fmt::format("meshes[{}]", number);
    Part part;
    std::map<std::size_t, std::uint32_t> first_of;  // of an accessor of positions: its vertices in the part
    const json& primitives = data_.element("meshes", number, here).at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      add_primitive(primitives[i], fmt::format("{}.primitives[{}]", here, i), part, first_of);
    }
    return part;
  }

  void add_primitive(const json& primitive, const std::string& here, Part& part,
                     std::map<std::size_t, std::uint32_t>& first_of) {
    constexpr std::size_t k_triangles = 4, k_strip = 5, k_fan = 6;
    ++visits_;
    const std::size_t mode = data_.whole(primitive, "mode", k_triangles, here);
    if (mode > k_fan) source_.fail(here, fmt::format("mode {} is unknown", mode));
    check_size(part, 0);
    if (mode < k_triangles) return;  // points or lines
    morphed_ = morphed_ || primitive.contains("targets");
    const std::size_t accessor = data_.whole(primitive.at("attributes").at("POSITION"), here + ".attributes.POSITION");
    data_.element("accessors", accessor, here + ".attributes.POSITION");
    refuse_compressed(primitive, accessor, here);
    const std::size_t before = part.vertices.size();
    const auto [known, is_new] = first_of.try_emplace(accessor, static_cast<std::uint32_t>(before));
    if (is_new) {
      const std::vector<double> positions = data_.numbers(accessor, 3);
      count_accessor(accessor, positions.size() / 3);
      check_size(part, positions.size() / 3);
      for (std::size_t i = 0; i < positions.size(); i += 3) {
        part.vertices.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
        if (!part.vertices.back().allFinite()) source_.fail(here, fmt::format("vertex {}: not finite", i / 3));
      }
    }
    const std::size_t size = sizes_.at(accessor);
    std::vector<std::uint32_t> corners;
    if (const auto found = primitive.find("indices"); found != primitive.end()) {
      const std::size_t of_corners = data_.whole(*found, here + ".indices");
      data_.element("accessors", of_corners, here + ".indices");
      corners = data_.indices(of_corners);
      count_accessor(of_corners, corners.size());
    } else {
      for (std::uint32_t i = 0; i < size; ++i) corners.push_back(i);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] >= size) source_.fail(here, fmt::format("index {}: vertex {} of {}", i, corners[i], size));
    }
    if (mode == k_triangles && corners.size() % 3 != 0) {
      source_.fail(here, fmt::format("{} corners are no whole number of triangles", corners.size()));
    }
    check_size(part, corners.size());
    const std::uint32_t first = known->second;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      part.triangles.push_back({first + corners[a], first + corners[b], first + corners[c]});
    };
    for (std::size_t i = 0; i + 2 < corners.size(); i += mode == k_triangles ? 3 : 1) {
      if (mode == k_fan) {
        add(0, i + 1, i + 2);
      } else {
        // Every second triangle of a strip is the other way round.
        const std::size_t turn = mode == k_strip ? i % 2 : 0;
        add(i + turn, i + 1 - turn, i + 2);
      }
    }
  }

  void refuse_compressed(const json& primitive, std::size_t accessor, const std::string& here) const {
    constexpr const char* k_draco = "KHR_draco_mesh_compression";
    if (!GltfData::member(primitive, "extensions").contains(k_draco) || data_.has_data(accessor)) return;
    source_.fail(here, std::string("is compressed by ") + k_draco + ", which is not supported");
  }

  void place(const Part& part, std::size_t number, const Matrix4d& transform) {
    const std::size_t first = surface_.vertices.size();
    check_size(part, 0);
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      surface_.vertices.push_back((transform * part.vertices[i].homogeneous()).head<3>());
      if (!surface_.vertices.back().allFinite()) {
        source_.fail(fmt::format("meshes[{}]", number), fmt::format("vertex {}: not finite where it is placed", i));
      }
    }
    // A mirror reverses the corners, so that outside stays outside.
    const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0.0;
    for (const auto& [a, b, c] : part.triangles) {
      const auto at = [first](std::uint32_t v) { return static_cast<std::uint32_t>(first + v); };
      mirrored ? surface_.triangles.push_back({at(c), at(b), at(a)})
               : surface_.triangles.push_back({at(a), at(b), at(c)});
    }
  }

  const Source& source_;
  GltfData data_;
  FileMesh surface_;
  std::map<std::size_t, std::size_t> sizes_;  ///< Elements of the accessors that were read,
  std::size_t accessors_size_ = 0;            ///< and their sum.
  std::size_t visits_ = 0;                    ///< Of primitives and instances, which may all be empty: they take time.
  bool morphed_ = false, skinned_ = false;
};

}  // namespace

FileMesh read_gltf(const Source& source) {
  try {
    return Reader(source).read();
  } catch (const json::exception& e) {
    source.fail(fmt::format("the JSON is malformed: {}", e.what()));
  }
}

}  // namespace sixdof::loading
