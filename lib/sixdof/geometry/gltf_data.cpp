#include <sixdof/geometry/gltf_data.h>

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>

namespace sixdof::loading {
namespace {

using nlohmann::json;

/// The numbers of an accessor lie in this way in their bytes.
struct Component {
  std::size_t type;  ///< In the file.
  std::size_t bytes;
  double largest;  ///< Of a normalized one; 0 where that is not defined.
  double (*read)(const char* at);
};

template <class T>
double read_as(const char* at) {
  return static_cast<double>(load_bytes<T>(at));
}

constexpr std::array k_components{
    Component{5120, 1, 127.0, read_as<std::int8_t>},    Component{5121, 1, 255.0, read_as<std::uint8_t>},
    Component{5122, 2, 32767.0, read_as<std::int16_t>}, Component{5123, 2, 65535.0, read_as<std::uint16_t>},
    Component{5125, 4, 0.0, read_as<std::uint32_t>},    Component{5126, 4, 0.0, read_as<float>}};

/// The bytes that base64 stands for; nothing if it is none.
std::optional<std::string> decode_base64(std::string_view text) {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t i = 0; i < k_digits.size(); ++i)
    value[static_cast<unsigned char>(k_digits[i])] = static_cast<int>(i);
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFu);
  }
  if (count == 6) return std::nullopt;  // a single digit is left over
  return bytes;
}

}  // namespace

/// Where the numbers of an accessor are.
struct GltfData::Layout {
  std::string place;  ///< "accessors[3]"
  const json* accessor = nullptr;
  Component component{};
  std::size_t count = 0, width = 0, stride = 0;
  std::string_view bytes;  ///< From the first element on; empty if there is no view.
};

GltfData::GltfData(const Source& source) : source_(source) {
  read_container();
  document_ = json::parse(text_);
  if (!document_.at("asset").at("version").get<std::string>().starts_with("2.")) source_.fail("version 2 is expected");
}

/// Finds the JSON, and the binary part of a .glb file: magic, version and size of the file, then chunks of a size, a
/// type and content.
void GltfData::read_container() {
  const std::string_view bytes = source_.bytes;
  text_ = bytes.substr(text_begin(bytes));
  if (!bytes.starts_with("glTF")) return;
  constexpr std::size_t k_header = 12, k_chunk = 8;
  constexpr std::uint32_t k_json = 0x4E4F534A, k_binary = 0x004E4942;
  if (bytes.size() < k_header + k_chunk) source_.fail("is cut off in its header");
  if (load_bytes<std::uint32_t>(bytes.data() + 4) != 2) source_.fail("byte 4", "version 2 is expected");
  if (load_bytes<std::uint32_t>(bytes.data() + 8) != bytes.size()) source_.fail("byte 8", "not the file's size");
  std::size_t number = 0;
  for (std::size_t at = k_header; at < bytes.size(); ++number) {
    const auto place = [&] { return fmt::format("byte {}", at); };
    if (bytes.size() - at < k_chunk) source_.fail(place(), "is cut off in a chunk's header");
    const std::size_t length = load_bytes<std::uint32_t>(bytes.data() + at);
    const auto type = load_bytes<std::uint32_t>(bytes.data() + at + 4);
    at += k_chunk;
    if (length > bytes.size() - at) source_.fail(place(), fmt::format("a chunk of {} bytes is cut off", length));
    if ((number == 0) != (type == k_json)) source_.fail(place(), "one chunk has to be JSON, the first");
    if (number == 0) text_ = bytes.substr(at, length);
    if (number == 1 && type == k_binary) {
      binary_ = bytes.substr(at, length);
      has_binary_ = true;
    }
    at += length;
  }
}

const json& GltfData::member(const json& object, const char* name) {
  static const json nothing = json::object();
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

std::size_t GltfData::whole(const json& number, const std::string& place) const {
  if (!number.is_number_unsigned()) source_.fail(place, "is not a whole number");
  return number.get<std::size_t>();
}

std::size_t GltfData::whole(const json& object, const char* name, std::size_t otherwise,
                            const std::string& place) const {
  const auto found = object.find(name);
  return found == object.end() ? otherwise : whole(*found, place + "." + name);
}

const json& GltfData::element(const char* list, std::size_t index, const std::string& place) const {
  const json& elements = member(document_, list);
  if (!elements.is_array() || index >= elements.size()) {
    source_.fail(place, fmt::format("{}[{}] of {}", list, index, elements.size()));
  }
  return elements[index];
}

std::string_view GltfData::load_buffer(std::size_t index) {
  const std::string place = fmt::format("buffers[{}]", index);
  const json& object = element("buffers", index, place);
  const auto uri = object.find("uri");
  if (uri == object.end()) {
    if (index != 0 || !has_binary_) source_.fail(place, "has no data");
    return binary_;
  }
  const std::string& text = uri->get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    constexpr std::string_view k_mark = ";base64,";
    const std::size_t mark = text.find(k_mark);
    std::optional<std::string> bytes;
    if (mark != std::string::npos) bytes = decode_base64(std::string_view(text).substr(mark + k_mark.size()));
    if (!bytes) source_.fail(place + ".uri", "is not base64");
    return loaded_[index] = *std::move(bytes);
  }
  if (text.find("://") != std::string::npos) source_.fail(place + ".uri", visible_text(text) + " is no file");
  const std::filesystem::path folder = source_.path.parent_path();
  std::error_code ignored;
  const bool as_it_is = std::filesystem::exists(folder / text, ignored);
  try {
    return loaded_[index] = read_source(folder / (as_it_is ? text : decode_percent(text))).bytes;
  } catch (const BadFile& e) {
    source_.fail(place + ".uri", e.what());
  }
}

/// The bytes of a buffer, as many as it states.
std::string_view GltfData::buffer(std::size_t index) {
  const auto found = buffers_.find(index);
  if (found != buffers_.end()) return found->second;
  const std::string_view bytes = load_buffer(index);
  const std::string place = fmt::format("buffers[{}]", index);
  const std::size_t length = whole(element("buffers", index, place).at("byteLength"), place + ".byteLength");
  if (length > bytes.size()) source_.fail(place, fmt::format("{} bytes where {} are stated", bytes.size(), length));
  return buffers_[index] = bytes.substr(0, length);
}

std::string_view GltfData::view(std::size_t index, const std::string& place) {
  const json& object = element("bufferViews", index, place);
  const std::string here = fmt::format("bufferViews[{}]", index);
  const std::size_t number = whole(object.at("buffer"), here + ".buffer");
  // The buffer of a compressed view may hold the same uncompressed, or nothing.
  for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const json& replaced = element("buffers", number, here);
    if (!member(object, "extensions").contains(name) || replaced.contains("uri") || (number == 0 && has_binary_))
      continue;
    source_.fail(here, std::string("is compressed by ") + name + ", which is not supported");
  }
  const std::string_view bytes = buffer(number);
  const std::size_t offset = whole(object, "byteOffset", 0, here);
  const std::size_t length = whole(object.at("byteLength"), here + ".byteLength");
  if (offset > bytes.size() || length > bytes.size() - offset) {
    source_.fail(here, fmt::format("{} bytes from {} on where the buffer has {}", length, offset, bytes.size()));
  }
  return bytes.substr(offset, length);
}

bool GltfData::has_data(std::size_t accessor) const {
  const std::string place = fmt::format("accessors[{}]", accessor);
  const json& object = element("accessors", accessor, place);
  return object.contains("bufferView") || object.contains("sparse");
}

GltfData::Layout GltfData::layout_of(std::size_t accessor) {
  Layout layout;
  layout.place = fmt::format("accessors[{}]", accessor);
  const json& object = element("accessors", accessor, layout.place);
  layout.accessor = &object;
  const std::size_t component = whole(object.at("componentType"), layout.place + ".componentType");
  for (const Component& known : k_components) {
    if (known.type == component) layout.component = known;
  }
  if (layout.component.read == nullptr) {
    source_.fail(layout.place, fmt::format("component type {} is unknown", component));
  }
  const std::string& type = object.at("type").get_ref<const std::string&>();
  layout.width = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  layout.count = whole(object.at("count"), layout.place + ".count");
  const std::size_t element_bytes = layout.width * layout.component.bytes;
  layout.stride = element_bytes;
  const auto index = object.find("bufferView");
  if (index == object.end()) return layout;
  const std::size_t number = whole(*index, layout.place + ".bufferView");
  const std::string_view bytes = view(number, layout.place);
  layout.stride = whole(element("bufferViews", number, layout.place), "byteStride", element_bytes, layout.place);
  const std::size_t offset = whole(object, "byteOffset", 0, layout.place);
  if (layout.stride < element_bytes || element_bytes == 0) source_.fail(layout.place, "its elements overlap");
  if (layout.count > 0 && (offset > bytes.size() || element_bytes > bytes.size() - offset ||
                           layout.count - 1 > (bytes.size() - offset - element_bytes) / layout.stride)) {
    source_.fail(layout.place,
                 fmt::format("{} elements are out of range of a view of {} bytes", layout.count, bytes.size()));
  }
  if (layout.count > 0) layout.bytes = bytes.substr(offset);
  return layout;
}

std::vector<double> GltfData::numbers(std::size_t accessor, std::size_t width) {
  const Layout layout = layout_of(accessor);
  const Component& component = layout.component;
  if (layout.width != width) source_.fail(layout.place, fmt::format("{} numbers in an element are expected", width));
  const bool is_sparse = layout.accessor->contains("sparse");
  const bool normalized = layout.accessor->value("normalized", false) && component.largest > 0.0;
  const auto read = [&](const char* at) {
    const double value = component.read(at);
    return normalized ? std::max(value / component.largest, -1.0) : value;
  };
  std::string_view patches;
  std::vector<std::uint32_t> patched;
  if (is_sparse) {
    const json& sparse = layout.accessor->at("sparse");
    const std::string place = layout.place + ".sparse";
    const std::size_t count = whole(sparse.at("count"), place + ".count");
    if (count > layout.count) source_.fail(place, fmt::format("{} elements of {}", count, layout.count));
    const json &where = sparse.at("indices"), &values = sparse.at("values");
    const auto part = [&](const json& object, std::size_t element_bytes) {
      const std::string_view bytes = view(whole(object.at("bufferView"), place), place);
      const std::size_t offset = whole(object, "byteOffset", 0, place);
      if (offset > bytes.size() || count > (bytes.size() - offset) / element_bytes) {
        source_.fail(place, fmt::format("{} elements are out of range of a view of {} bytes", count, bytes.size()));
      }
      return bytes.substr(offset);
    };
    patches = part(values, layout.width * component.bytes);
    const std::size_t type = whole(where.at("componentType"), place);
    const Component& index = k_components[type == 5121 ? 1 : type == 5123 ? 3 : 4];
    if (index.type != type) source_.fail(place, "indices are unsigned integers");
    const std::string_view bytes = part(where, index.bytes);
    for (std::size_t i = 0; i < count; ++i) {
      patched.push_back(static_cast<std::uint32_t>(index.read(bytes.data() + i * index.bytes)));
      if (patched.back() >= layout.count) {
        source_.fail(place, fmt::format("index {} is out of range of {} elements", patched.back(), layout.count));
      }
    }
  }
  if (layout.bytes.empty() && layout.count > 0) {
    if (!is_sparse) source_.fail(layout.place, "has no data");
    // What no buffer states is zero, and takes memory without a file to match.
    if (layout.count > source_.bytes.size() + patches.size()) source_.fail(layout.place, "is larger than its file");
  }
  std::vector<double> result(layout.count * width);
  for (std::size_t i = 0; i < layout.count && !layout.bytes.empty(); ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      result[i * width + k] = read(layout.bytes.data() + i * layout.stride + k * component.bytes);
    }
  }
  for (std::size_t i = 0; i < patched.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      result[patched[i] * width + k] = read(patches.data() + (i * width + k) * component.bytes);
    }
  }
  return result;
}

std::vector<std::uint32_t> GltfData::indices(std::size_t accessor) {
  const Layout how = layout_of(accessor);
  const std::size_t type = how.component.type;
  if (type != 5121 && type != 5123 && type != 5125) source_.fail(how.place, "indices are unsigned integers");
  std::vector<std::uint32_t> result;
  for (const double value : numbers(accessor, 1)) result.push_back(static_cast<std::uint32_t>(value));
  return result;
}

}  // namespace sixdof::loading
