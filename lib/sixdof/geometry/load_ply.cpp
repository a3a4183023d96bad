#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

/// A type of number. A double holds the integers and floats of all types exactly.
struct Type {
  std::string_view name, other_name;
  std::size_t bytes;  ///< In a binary file.
  bool is_float;
  double least, most;
  double (*load)(const char* at, std::endian order);
};

template <class T>
constexpr Type type_of(std::string_view name, std::string_view other_name) {
  using Limits = std::numeric_limits<T>;
  return {name,
          other_name,
          sizeof(T),
          !Limits::is_integer,
          static_cast<double>(Limits::lowest()),
          static_cast<double>(Limits::max()),
          [](const char* at, std::endian order) { return static_cast<double>(load_bytes<T>(at, order)); }};
}

constexpr std::array k_types{
    type_of<std::int8_t>("char", "int8"),    type_of<std::uint8_t>("uchar", "uint8"),
    type_of<std::int16_t>("short", "int16"), type_of<std::uint16_t>("ushort", "uint16"),
    type_of<std::int32_t>("int", "int32"),   type_of<std::uint32_t>("uint", "uint32"),
    type_of<float>("float", "float32"),      type_of<double>("double", "float64"),
};

struct Property {
  std::string name;
  const Type& type;                  ///< Of the value, or of the list's items.
  const Type* count_type = nullptr;  ///< Set if this is a list.
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

struct Header {
  bool text = false;
  std::endian order = std::endian::little;  ///< Of a binary file.
  std::vector<Element> elements;
  std::size_t end = 0;   ///< Byte behind the header.
  std::size_t line = 1;  ///< Line of that byte, from 1.
};

Property read_property(const TextLines& lines) {
  const auto& words = lines.words();
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) lines.fail("a property is 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  const auto type = [&](std::string_view word) -> const Type& {
    for (const Type& known : k_types) {
      if (word == known.name || word == known.other_name) return known;
    }
    lines.fail(fmt::format("'{}' is no type", visible_text(word)));
  };
  Property property{std::string(words.back()), type(words[words.size() - 2])};
  if (list) {
    property.count_type = &type(words[2]);
    if (property.count_type->is_float) lines.fail("a list's count must be an integer");
  }
  return property;
}

Header read_header(const Source& source) {
  const std::string_view text = std::string_view(source.bytes).substr(text_begin(source.bytes));
  refuse_utf16(source);
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n")) {
    const std::string first = visible_text(text.substr(0, text.find_first_of("\r\n")));
    source.fail("line 1", "does not begin with 'ply', but with '" + first + "'");
  }
  // Without this test the data of a binary file would be read as lines of the header.
  if (source.bytes.find("\nend_header") == std::string::npos) source.fail("the header has no 'end_header'");
  Header header;
  bool has_format = false;
  TextLines lines(source, {});
  lines.next();
  while (true) {
    if (!lines.next()) lines.fail("the header has no 'end_header'");
    const auto& words = lines.words();
    if (words[0] == "end_header") break;
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      if (words.size() != 3 || words[2] != "1.0") lines.fail("version 1.0 is expected");
      header.text = words[1] == "ascii";
      header.order = words[1] == "binary_big_endian" ? std::endian::big : std::endian::little;
      if (!header.text && words[1] != "binary_little_endian" && words[1] != "binary_big_endian") {
        lines.fail(fmt::format("'{}' is no format", visible_text(words[1])));
      }
      has_format = true;
    } else if (words[0] == "element") {
      if (words.size() != 3) lines.fail("an element is 'element NAME COUNT'");
      const std::int64_t count = lines.integer(std::size_t{2});
      if (count < 0) lines.fail(fmt::format("the count {} is negative", count));
      header.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(count), {}});
    } else if (words[0] == "property") {
      if (header.elements.empty()) lines.fail("a property before the first element");
      header.elements.back().properties.push_back(read_property(lines));
    } else {
      lines.fail(fmt::format("'{}' is unknown in a header", visible_text(words[0])));
    }
  }
  if (!has_format) lines.fail("the header names no format");
  header.end = lines.position();
  header.line = lines.line() + 1;
  return header;
}

/// Reads the elements in the file's order. In a text, each is one line.
class Reader {
 public:
  Reader(const Source& source, const Header& header) : source_(source), at_(header.end), order_(header.order) {
    if (header.text) lines_.emplace(source, TextLines::Syntax{}, header.end, header.line);
  }

  Surface read(const std::vector<Element>& elements) {
    bool has_vertices = false;
    bool has_faces = false;
    for (const Element& element : elements) {
      check_count(element);
      if (element.name == "vertex") {
        if (has_vertices) source_.fail("element vertex appears twice");
        has_vertices = true;
        read_vertices(element);
      } else if (element.name == "face") {
        if (!has_vertices || has_faces) source_.fail("element face must appear once, behind element vertex");
        has_faces = true;
        read_faces(element);
      } else if (element.name == "tristrips") {
        source_.fail("triangle strips are not supported");
      } else {
        for_each(element, [&] {
          for (const Property& property : element.properties) skip(property);
        });
      }
    }
    if (!has_vertices) source_.fail("the header has no element vertex");
    if (!has_faces) source_.fail("the header has no element face");
    if (lines_) lines_->expect_end();
    if (remaining() != 0) source_.fail(fmt::format("{} bytes behind the last element", remaining()));
    return std::move(surface_);
  }

 private:
  /// Bytes that are left in the file.
  std::size_t remaining() const { return lines_ ? lines_->remaining() : source_.bytes.size() - at_; }

  /// Where in the file the current element is: "face 3", in a text "line 17: face 3".
  std::string place() const {
    return fmt::format("{}{} {}", lines_ ? lines_->place() + ": " : "", element_->name, number_);
  }

  [[noreturn]] void fail(const std::string& cause) const { source_.fail(place(), cause); }

  /// Before anything is allocated for it: the count must fit into the bytes that are left.
  void check_count(const Element& element) {
    std::size_t least = 0;
    for (const Property& p : element.properties) {
      least += lines_ ? sizeof("0\n") - 1 : (p.count_type != nullptr ? *p.count_type : p.type).bytes;
    }
    if (least == 0) source_.fail("element " + element.name, "has no properties");
    // The last line of a text may lack its line break.
    if (element.count > (remaining() + (lines_ ? 1 : 0)) / least) {
      source_.fail("element " + element.name, fmt::format("{} of at least {} bytes each do not fit into the {} bytes "
                                                          "that are left",
                                                          element.count, least, remaining()));
    }
  }

  /// read() for each element, which reads all of its values.
  template <class Read>
  void for_each(const Element& element, const Read& read) {
    element_ = &element;
    for (number_ = 0; number_ < element.count; ++number_) {
      if (lines_ && !lines_->next()) {
        lines_->fail(fmt::format("the file ends before {} {} of {}", element.name, number_, element.count));
      }
      word_ = 0;
      read();
      if (lines_ && word_ != lines_->size()) {
        fail(fmt::format("{} values where {} are expected", lines_->size(), word_));
      }
    }
  }

  double value(const Type& type) {
    if (!lines_) {
      if (remaining() < type.bytes) fail("the file ends here");
      at_ += type.bytes;
      return type.load(source_.bytes.data() + at_ - type.bytes, order_);
    }
    if (word_ >= lines_->size()) fail(fmt::format("{} values are too few", lines_->size()));
    if (type.is_float) return lines_->number(word_++);
    const std::int64_t integer = lines_->integer(word_++);
    const auto result = static_cast<double>(integer);
    if (result < type.least || result > type.most) fail(fmt::format("{} does not fit its type", integer));
    return result;
  }

  /// The count of a list, which is not negative and fits into what is left of the file, or of the line.
  std::size_t list_count(const Property& list) {
    const double count = value(*list.count_type);
    if (count < 0.0) fail(fmt::format("a list of {} values", count));
    const std::size_t left = lines_ ? lines_->size() - word_ : remaining() / list.type.bytes;
    if (count > static_cast<double>(left)) {
      fail(fmt::format("a list of {} values, but {}", count,
                       lines_ ? fmt::format("{} follow", left) : fmt::format("{} bytes are left", remaining())));
    }
    return static_cast<std::size_t>(count);
  }

  void skip(const Property& property) {
    const std::size_t count = property.count_type != nullptr ? list_count(property) : 1;
    for (std::size_t i = 0; i < count; ++i) value(property.type);
  }

  void read_vertices(const Element& element) {
    std::vector<int> axis_of;
    for (const Property& property : element.properties) {
      const int axis = property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
      if (axis >= 0 && property.count_type != nullptr) {
        source_.fail("element vertex", "property " + property.name + " is a list");
      }
      if (axis >= 0 && std::find(axis_of.begin(), axis_of.end(), axis) != axis_of.end()) {
        source_.fail("element vertex", "property " + property.name + " appears twice");
      }
      axis_of.push_back(axis);
    }
    if (std::count_if(axis_of.begin(), axis_of.end(), [](int axis) { return axis >= 0; }) != 3) {
      source_.fail("element vertex", "has no properties x, y and z");
    }
    surface_.vertices.reserve(element.count);
    for_each(element, [&] {
      Eigen::Vector3d point;
      for (std::size_t k = 0; k < axis_of.size(); ++k) {
        if (axis_of[k] >= 0) {
          point[axis_of[k]] = value(element.properties[k].type);
        } else {
          skip(element.properties[k]);
        }
      }
      if (!point.allFinite()) {
        fail(fmt::format("coordinates ({}, {}, {}) are not finite", point.x(), point.y(), point.z()));
      }
      surface_.vertices.push_back(point);
    });
  }

  void read_faces(const Element& element) {
    const Property* indices = nullptr;
    for (const Property& property : element.properties) {
      if (property.name == "vertex_indices" || property.name == "vertex_index") {
        if (indices != nullptr) source_.fail("element face", "has two lists of vertex indices");
        indices = &property;
      }
    }
    if (indices == nullptr || indices->count_type == nullptr || indices->type.is_float) {
      source_.fail("element face", "has no list of integers called vertex_indices");
    }
    surface_.triangles.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for_each(element, [&] {
      for (const Property& property : element.properties) {
        if (&property == indices) {
          read_corners(property, corners);
        } else {
          skip(property);
        }
      }
      add_polygon(
          source_, corners, [&] { return place(); }, surface_);
    });
  }

  void read_corners(const Property& list, std::vector<std::uint32_t>& corners) {
    const std::size_t count = list_count(list);
    if (count < 3) fail(fmt::format("has {} corners", count));
    corners.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const double index = value(list.type);
      if (index < 0.0 || index >= static_cast<double>(surface_.vertices.size())) {
        fail(fmt::format("vertex index {} of {}", index, surface_.vertices.size()));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
  }

  const Source& source_;
  std::size_t at_;     ///< Next byte of a binary file.
  std::endian order_;  ///< Of a binary file.
  std::optional<TextLines> lines_;
  std::size_t word_ = 0;  ///< Next word of the line.
  const Element* element_ = nullptr;
  std::uint64_t number_ = 0;  ///< Of the element.
  Surface surface_;
};

}  // namespace

Surface read_ply(const Source& source) {
  const Header header = read_header(source);
  return Reader(source, header).read(header.elements);
}

}  // namespace sixdof::loading
