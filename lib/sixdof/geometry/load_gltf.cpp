#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/assimp_import.h>
#include <sixdof/geometry/bytes.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

using nlohmann::json;

constexpr std::uint32_t k_magic = 0x46546C67;       // "glTF"
constexpr std::uint32_t k_json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t k_binary_chunk = 0x004E4942;
constexpr std::size_t k_glb_header = 12;
constexpr std::size_t k_glb_chunk_header = 8;

/// Nodes deeper than this are refused: assimp walks the tree by recursion.
constexpr std::size_t k_deepest_node = 500;
/// How far a rotation's norm may be from 1: a few digits printed in text.
constexpr double k_unit_norm_tolerance = 1e-3;

constexpr int k_float = 5126;

std::string decode_base64(const Source& source, const std::string& place, std::string_view text) {
  const auto value_of = [](char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  };
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int value = value_of(c);
    if (value < 0) source.fail(place, "its data are no base64");
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    have += 6;
    if (have >= 8) {
      have -= 8;
      bytes += static_cast<char>((bits >> have) & 0xFF);
    }
  }
  return bytes;
}

std::string decode_percent(const std::string& uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      result += static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

/// Checks the structure of a glTF document as far as triangles are concerned, and writes a GLB of these alone: one
/// buffer, the accessors of positions and indices, the nodes of the default scene.
class Checker {
 public:
  explicit Checker(const Source& source) : source_(source) {
    const bool binary = source.bytes.size() >= 4 && load_little_endian<std::uint32_t>(source.bytes.data()) == k_magic;
    std::string_view text = source.bytes;
    if (binary) text = split_glb();
    try {
      document_ = json::parse(text);
    } catch (const json::exception& e) {
      source_.fail(fmt::format("the JSON is malformed: {}", e.what()));
    }
    if (!document_.is_object()) source_.fail("the JSON is no object");
  }

  std::string rewrite() {
    check_asset();
    read_buffers();
    const json scene = default_scene();
    add_meshes();
    json nodes = json::array();
    const json& all = list("nodes");
    for (std::size_t i = 0; i < all.size(); ++i) nodes.push_back(checked_node(i));
    walk(scene, nodes);
    if (meshes_.empty()) source_.fail("no triangles");
    const json result{{"asset", {{"version", "2.0"}}},
                      {"scene", 0},
                      {"scenes", json::array({{{"nodes", scene}}})},
                      {"nodes", nodes},
                      {"meshes", meshes_},
                      {"accessors", accessors_},
                      {"bufferViews", views_},
                      {"buffers", json::array({{{"byteLength", binary_.size()}}})}};
    std::string text = result.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    const std::size_t size = k_glb_header + 2 * k_glb_chunk_header + text.size() + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max()) source_.fail("more than 4 GiB of geometry");
    std::string bytes;
    bytes.reserve(size);
    append_little_endian(bytes, k_magic);
    append_little_endian(bytes, std::uint32_t{2});
    append_little_endian(bytes, static_cast<std::uint32_t>(size));
    append_little_endian(bytes, static_cast<std::uint32_t>(text.size()));
    append_little_endian(bytes, k_json_chunk);
    bytes += text;
    append_little_endian(bytes, static_cast<std::uint32_t>(binary_.size()));
    append_little_endian(bytes, k_binary_chunk);
    bytes += binary_;
    return bytes;
  }

  std::size_t triangles() const { return triangles_; }

 private:
  /// The JSON of a GLB; keeps its binary chunk.
  std::string_view split_glb() {
    const std::string_view bytes = source_.bytes;
    const auto number = [&](std::size_t at) { return load_little_endian<std::uint32_t>(bytes.data() + at); };
    if (bytes.size() < k_glb_header + k_glb_chunk_header) source_.fail("the file ends within its header");
    if (number(4) != 2) source_.fail("byte 4", fmt::format("version {} is not supported, only 2", number(4)));
    if (number(8) != bytes.size()) {
      source_.fail("byte 8", fmt::format("the header says {} bytes, but the file has {}", number(8), bytes.size()));
    }
    std::string_view text;
    for (std::size_t at = k_glb_header, i = 0; at < bytes.size(); ++i) {
      const std::string place = fmt::format("byte {}", at);
      if (bytes.size() - at < k_glb_chunk_header) source_.fail(place, "the file ends within a chunk's header");
      const std::size_t length = number(at);
      const std::uint32_t type = number(at + 4);
      at += k_glb_chunk_header;
      if (length > bytes.size() - at) {
        source_.fail(place, fmt::format("a chunk of {} bytes where {} are left", length, bytes.size() - at));
      }
      if (i == 0 && type != k_json_chunk) source_.fail(place, "the first chunk must be JSON");
      if (i == 0) text = bytes.substr(at, length);
      if (i == 1 && type == k_binary_chunk) binary_chunk_ = bytes.substr(at, length);
      at += length;
    }
    return text;
  }

  const json& list(const char* key) const {
    static const json k_none = json::array();
    const auto found = document_.find(key);
    if (found == document_.end()) return k_none;
    if (!found->is_array()) source_.fail(key, "is no list");
    return *found;
  }

  const json& item(const char* key, std::size_t i) const {
    const json& items = list(key);
    const std::string place = fmt::format("{}[{}]", key, i);
    if (i >= items.size()) source_.fail(place, fmt::format("there are only {}", items.size()));
    if (!items[i].is_object()) source_.fail(place, "is no object");
    return items[i];
  }

  std::uint64_t number(const json& object, const char* key, const std::string& place,
                       std::optional<std::uint64_t> otherwise = std::nullopt) const {
    const auto found = object.find(key);
    if (found == object.end() && otherwise) return *otherwise;
    // Offsets and counts beyond 2^48 cannot be right, and their sums and products must not overflow.
    constexpr std::uint64_t k_largest = std::uint64_t{1} << 48;
    if (found == object.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > k_largest) {
      source_.fail(place, fmt::format("{} must be a whole number", key));
    }
    return found->get<std::uint64_t>();
  }

  void check_asset() const {
    const auto asset = document_.find("asset");
    if (asset == document_.end() || !asset->is_object() || asset->value("version", json()) != "2.0") {
      source_.fail("asset", "version 2.0 is expected");
    }
    for (const json& extension : list("extensionsRequired")) {
      const std::string name = extension.is_string() ? extension.get<std::string>() : "";
      // These say how a surface looks, not where it is.
      if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_") && name != "KHR_lights_punctual") {
        source_.fail("extensionsRequired", fmt::format("'{:.40}' is not supported", name));
      }
    }
  }

  void read_buffers() {
    constexpr std::size_t k_padding = 256;  // above the largest stride
    const json& buffers = list("buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::string place = fmt::format("buffers[{}]", i);
      const json& buffer = item("buffers", i);
      const std::uint64_t length = number(buffer, "byteLength", place);
      std::string bytes;
      if (!buffer.contains("uri")) {
        if (i != 0 || !binary_chunk_) source_.fail(place, "has no data");
        bytes = *binary_chunk_;
      } else {
        if (!buffer["uri"].is_string()) source_.fail(place, "uri must be a text");
        const std::string uri = buffer["uri"].get<std::string>();
        constexpr std::string_view k_marker = ";base64,";
        if (uri.starts_with("data:")) {
          const std::size_t begin = uri.find(k_marker);
          if (begin == std::string::npos) source_.fail(place, "its data are no base64");
          bytes = decode_base64(source_, place, std::string_view(uri).substr(begin + k_marker.size()));
        } else if (uri.find(':') != std::string::npos || uri.starts_with('/')) {
          source_.fail(place, "only files beside this one and data in it are read");
        } else {
          bytes = read_source(source_.path.parent_path() / decode_percent(uri)).bytes;
        }
      }
      if (bytes.size() < length) source_.fail(place, fmt::format("has {} bytes, not {}", bytes.size(), length));
      if (length > std::numeric_limits<std::uint32_t>::max() - binary_.size())
        source_.fail("more than 4 GiB of geometry");
      begins_.push_back(binary_.size());
      lengths_.push_back(length);
      binary_ += bytes.substr(0, length);
      binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    }
    binary_.resize(binary_.size() + k_padding, '\0');
  }

  json default_scene() const {
    const std::uint64_t which = number(document_, "scene", "scene", 0);
    const json& scene = item("scenes", which);
    const auto nodes = scene.find("nodes");
    return checked_indices(nodes == scene.end() ? json::array() : *nodes, fmt::format("scenes[{}].nodes", which));
  }

  /// A list of indices of nodes.
  json checked_indices(const json& indices, const std::string& place) const {
    if (!indices.is_array()) source_.fail(place, "is no list");
    for (const json& index : indices) {
      if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= list("nodes").size()) {
        source_.fail(place, fmt::format("{} is no node; there are {}", index.dump(), list("nodes").size()));
      }
    }
    return indices;
  }

  struct Span {
    std::uint64_t count;
    std::size_t accessor;             // in accessors_
    std::size_t begin, stride, size;  // bytes in binary_
  };

  Span add_accessor(std::uint64_t which, const std::string& user, bool is_position) {
    const json& accessor = item("accessors", which);
    const std::string place = fmt::format("accessors[{}] ({})", which, user);
    if (accessor.contains("sparse") || !accessor.contains("bufferView")) {
      source_.fail(place, "sparse accessors are not supported");
    }
    const std::uint64_t component = number(accessor, "componentType", place);
    const json type = accessor.value("type", json());
    std::uint64_t size = 0;
    if (is_position && component == k_float && type == "VEC3") size = 12;
    if (!is_position && type == "SCALAR")
      size = component == 5121 ? 1 : component == 5123 ? 2 : component == 5125 ? 4 : 0;
    if (size == 0) source_.fail(place, is_position ? "positions are float VEC3" : "indices are unsigned SCALAR");
    const std::uint64_t count = number(accessor, "count", place);
    if (count == 0) source_.fail(place, "count is 0");
    const std::uint64_t offset = number(accessor, "byteOffset", place, 0);

    const std::uint64_t view_number = number(accessor, "bufferView", place);
    const json& view = item("bufferViews", view_number);
    const std::string view_place = fmt::format("bufferViews[{}]", view_number);
    const std::uint64_t buffer = number(view, "buffer", view_place);
    if (buffer >= begins_.size()) source_.fail(view_place, fmt::format("buffer {} of {}", buffer, begins_.size()));
    const std::uint64_t view_offset = number(view, "byteOffset", view_place, 0);
    const std::uint64_t view_length = number(view, "byteLength", view_place);
    if (view_offset + view_length > lengths_[buffer]) {
      source_.fail(view_place, fmt::format("bytes {} to {} of a buffer of {}", view_offset, view_offset + view_length,
                                           lengths_[buffer]));
    }
    const std::uint64_t stride = number(view, "byteStride", view_place, size);
    constexpr std::uint64_t k_largest_stride = 252;  // the specification's
    if (stride < size || stride > k_largest_stride) source_.fail(view_place, fmt::format("byteStride {}", stride));
    if (count > view_length || offset + stride * (count - 1) + size > view_length) {
      source_.fail(
          place, fmt::format("{} values do not fit into bufferViews[{}] of {} bytes", count, view_number, view_length));
    }
    // Each accessor gets a view of its own. Assimp wants a whole stride behind the last value as well, which the
    // specification does not: binary_ is padded for it.
    const std::size_t begin = begins_[buffer] + view_offset + offset;
    json new_view{{"buffer", 0}, {"byteOffset", begin}, {"byteLength", stride * count}};
    if (stride != size) new_view["byteStride"] = stride;
    views_.push_back(new_view);
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    return {count, accessors_.size() - 1, begin, stride, size};
  }

  void add_meshes() {
    const json& meshes = list("meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const json& mesh = item("meshes", i);
      const std::string place = fmt::format("meshes[{}]", i);
      const auto primitives = mesh.find("primitives");
      if (primitives == mesh.end() || !primitives->is_array()) source_.fail(place, "has no list of primitives");
      json kept = json::array();
      std::uint64_t triangles = 0;
      for (std::size_t k = 0; k < primitives->size(); ++k) {
        triangles += add_primitive((*primitives)[k], fmt::format("{}.primitives[{}]", place, k), kept);
      }
      triangles_of_.push_back(triangles);
      new_number_.push_back(kept.empty() ? std::optional<std::size_t>() : meshes_.size());
      if (!kept.empty()) meshes_.push_back({{"primitives", kept}});
    }
  }

  std::uint64_t add_primitive(const json& primitive, const std::string& place, json& kept) {
    if (!primitive.is_object()) source_.fail(place, "is no object");
    constexpr std::uint64_t k_triangles = 4, k_fan = 6;  // 5: strip
    const std::uint64_t mode = number(primitive, "mode", place, k_triangles);
    if (mode > k_fan) source_.fail(place, fmt::format("mode {} does not exist", mode));
    if (mode < k_triangles) return 0;  // points and lines hold no surface
    if (primitive.contains("targets")) source_.fail(place, "morph targets are not supported");
    if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression")) {
      source_.fail(place, "compressed meshes are not supported");
    }
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) source_.fail(place, "has no attributes");
    const Span position = add_accessor(number(*attributes, "POSITION", place), place, true);
    json result{{"attributes", {{"POSITION", position.accessor}}}, {"mode", mode}};
    std::uint64_t corners = position.count;
    if (primitive.contains("indices")) {
      const Span indices = add_accessor(number(primitive, "indices", place), place, false);
      result["indices"] = indices.accessor;
      corners = indices.count;
      check_indices(indices, position.count, place);
    }
    if (corners < 3 || (mode == k_triangles && corners % 3 != 0)) {
      source_.fail(place, fmt::format("{} corners do not make triangles", corners));
    }
    kept.push_back(result);
    return mode == k_triangles ? corners / 3 : corners - 2;
  }

  /// Assimp would leave out a face with an index out of range.
  void check_indices(const Span& indices, std::uint64_t vertices, const std::string& place) const {
    for (std::uint64_t i = 0; i < indices.count; ++i) {
      const char* at = binary_.data() + indices.begin + indices.stride * i;
      const std::uint32_t v = indices.size == 1   ? load_little_endian<std::uint8_t>(at)
                              : indices.size == 2 ? load_little_endian<std::uint16_t>(at)
                                                  : load_little_endian<std::uint32_t>(at);
      if (v >= vertices) source_.fail(place, fmt::format("corner {}: vertex index {} of {}", i, v, vertices));
    }
  }

  json checked_node(std::size_t i) const {
    const json& node = item("nodes", i);
    const std::string place = fmt::format("nodes[{}]", i);
    json result = json::object();
    const auto copy_numbers = [&](const char* key, std::size_t count) {
      const auto found = node.find(key);
      if (found == node.end()) return false;
      bool good = found->is_array() && found->size() == count;
      for (std::size_t k = 0; good && k < count; ++k) {
        good = (*found)[k].is_number() && std::abs((*found)[k].get<double>()) <= std::numeric_limits<float>::max();
      }
      if (!good) source_.fail(place, fmt::format("{} must be {} numbers", key, count));
      result[key] = *found;
      return true;
    };
    const bool has_matrix = copy_numbers("matrix", 16);
    const bool has_parts = copy_numbers("translation", 3) | copy_numbers("scale", 3) | copy_numbers("rotation", 4);
    if (has_matrix && has_parts) source_.fail(place, "has a matrix and parts of one");
    if (has_matrix) {
      for (std::size_t row = 0; row < 4; ++row) {
        if (result["matrix"][4 * row + 3].get<double>() != (row == 3 ? 1.0 : 0.0)) {
          source_.fail(place, "matrix is not affine");
        }
      }
    }
    if (result.contains("rotation")) {
      double square = 0.0;
      for (const json& q : result["rotation"]) square += q.get<double>() * q.get<double>();
      if (std::abs(std::sqrt(square) - 1.0) > k_unit_norm_tolerance) {
        source_.fail(place, fmt::format("rotation has norm {}, not 1", std::sqrt(square)));
      }
    }
    if (node.contains("mesh")) {
      if (node.contains("skin")) source_.fail(place, "skinned meshes are not supported");
      const std::uint64_t mesh = number(node, "mesh", place);
      if (mesh >= new_number_.size()) source_.fail(place, fmt::format("mesh {} of {}", mesh, new_number_.size()));
      if (new_number_[mesh]) result["mesh"] = *new_number_[mesh];
    }
    if (node.contains("children")) result["children"] = checked_indices(node["children"], place + ".children");
    return result;
  }

  /// Every node must be reached once at most, or the tree would be walked forever or grow without bounds.
  void walk(const json& roots, const json& nodes) {
    struct Visit {
      std::size_t node, depth;
    };
    std::vector<Visit> open;
    std::vector<bool> seen(nodes.size(), false);
    for (const json& root : roots) open.push_back({root.get<std::size_t>(), 0});
    while (!open.empty()) {
      const Visit at = open.back();
      open.pop_back();
      const std::string place = fmt::format("nodes[{}]", at.node);
      if (seen[at.node]) source_.fail(place, "is reached twice");
      if (at.depth > k_deepest_node) source_.fail(place, fmt::format("lies deeper than {} levels", k_deepest_node));
      seen[at.node] = true;
      const json& node = nodes[at.node];
      const json& original = list("nodes")[at.node];
      if (original.contains("mesh")) triangles_ += triangles_of_[original["mesh"].get<std::size_t>()];
      if (triangles_ > std::numeric_limits<std::uint32_t>::max()) source_.fail("more triangles than 2^32");
      if (node.contains("children")) {
        for (const json& child : node["children"]) open.push_back({child.get<std::size_t>(), at.depth + 1});
      }
    }
    if (triangles_ == 0) source_.fail("no triangles in the default scene");
  }

  const Source& source_;
  json document_;
  std::optional<std::string_view> binary_chunk_;
  std::string binary_;                  // all buffers, one behind the other
  std::vector<std::size_t> begins_;     // of the buffers in binary_
  std::vector<std::uint64_t> lengths_;  // of the buffers
  json meshes_ = json::array(), accessors_ = json::array(), views_ = json::array();
  std::vector<std::uint64_t> triangles_of_;             // of the original meshes
  std::vector<std::optional<std::size_t>> new_number_;  // of the original meshes in meshes_
  std::size_t triangles_ = 0;
};

}  // namespace

Surface read_gltf(const Source& source) {
  Checker checker(source);
  const std::string bytes = checker.rewrite();
  return import_by_assimp(
      source, {.format = "glb", .bytes = bytes, .apply_transforms = true, .triangles = checker.triangles()});
}

}  // namespace sixdof::loading
