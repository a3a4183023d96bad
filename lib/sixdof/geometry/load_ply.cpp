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

/// A type of number. A double holds the integers and floats of all types of up to four bytes exactly, and rounds
/// others.
struct Type {
  std::string_view name, other_name;
  std::size_t bytes;  ///< In a binary file; 0: programs do not agree.
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
    type_of<std::int8_t>("char", "int8"),
    type_of<std::uint8_t>("uchar", "uint8"),
    type_of<std::int16_t>("short", "int16"),
    type_of<std::uint16_t>("ushort", "uint16"),
    type_of<std::int32_t>("int", "int32"),
    type_of<std::uint32_t>("uint", "uint32"),
    type_of<float>("float", "float32"),
    type_of<double>("double", "float64"),
    type_of<std::int64_t>("int64", "int64"),
    type_of<std::uint64_t>("uint64", "uint64"),
    Type{"long", "longlong", 0, false, -0x1p63, 0x1p63, nullptr},
    Type{"ulong", "ulonglong", 0, false, 0.0, 0x1p64, nullptr},
    Type{"float16", "half", 0, true, -65504.0, 65504.0, nullptr},
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
  FileRepairs lone_returns;
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

/// Whether the first line ends in CR alone. Then bytes of a binary file may begin with LF.
bool has_lone_return(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  return end != std::string_view::npos && text[end] == '\r' && text.substr(end + 1, 1) != "\n";
}

Header read_header(const Source& source) {
  const std::string_view text = std::string_view(source.bytes).substr(text_begin(source.bytes));
  refuse_utf16(source);
  const std::string_view first = text.substr(0, text.find_first_of("\r\n"));
  if (!first.starts_with("ply") || !is_blank_text(first.substr(3)) || first.size() == text.size()) {
    source.fail("line 1", "does not begin with 'ply', but with '" + visible_text(first) + "'");
  }
  // Without this test the data of a binary file would be read as lines of the header.
  if (text.find("\nend_header") == std::string::npos && text.find("\rend_header") == std::string::npos) {
    source.fail("the header has no 'end_header'");
  }
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
  if (has_lone_return(text) && source.bytes[header.end - 1] == '\n') --header.end;
  header.line = lines.line() + 1;
  header.lone_returns = lines.lone_returns();
  if (header.text) return header;
  for (const Element& element : header.elements) {
    for (const Property& p : element.properties) {
      for (const Type* type : {&p.type, p.count_type}) {
        if (type == nullptr || type->bytes > 0) continue;
        source.fail("element " + element.name,
                    fmt::format("property {}: programs do not agree on the bytes of '{}'", p.name, type->name));
      }
    }
  }
  return header;
}

/// Reads the elements in the file's order, which is free.
class Reader {
 public:
  Reader(const Source& source, const Header& header) : source_(source), header_(header), at_(header.end) {
    if (!header.text) return;
    lines_.emplace(source, TextLines::Syntax{}, header.end, header.line);
    values_.emplace(*lines_, [this] { return name(); });
  }

  FileMesh read() {
    const Element* const vertices = find_once("vertex");
    if (vertices == nullptr) source_.fail("the header has no element vertex");
    vertex_count_ = vertices->count;
    if (find_once("face") == nullptr && find_once("tristrips") == nullptr) {
      source_.fail("the header has no element face, and no tristrips");
    }
    for (const Element& element : header_.elements) {
      if (element.count == 0) continue;
      check_count(element);
      element_ = &element;
      if (values_) values_->begin_kind(has_list(element));
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face" || element.name == "tristrips") {
        read_faces(element);
      } else {
        for_each(element, [&] {
          for (const Property& property : element.properties) skip(property);
        });
      }
    }
    read_end();
    return std::move(surface_);
  }

 private:
  using Corners = std::vector<std::uint32_t>;
  struct Late {
    const Element* element;
    LatePolygons polygons;
  };

  const Element* find_once(std::string_view name) const {
    const Element* found = nullptr;
    for (const Element& element : header_.elements) {
      if (element.name != name) continue;
      if (found != nullptr) source_.fail(fmt::format("element {} appears twice", name));
      found = &element;
    }
    return found;
  }

  static bool has_list(const Element& element) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [](const Property& property) { return property.count_type != nullptr; });
  }

  /// Bytes that are left in the file.
  std::size_t remaining() const { return lines_ ? lines_->remaining() : source_.bytes.size() - at_; }

  std::string name() const { return fmt::format("{} {}", element_->name, number_); }
  /// Where in the file the current element is: "face 3", in a text "line 17: face 3".
  std::string place() const { return lines_ ? lines_->place() + ": " + name() : name(); }
  std::size_t line() const { return lines_ ? lines_->line() : 0; }

  [[noreturn]] void fail(const std::string& cause) const { source_.fail(place(), cause); }

  /// Before anything is allocated for it: the count must fit into the bytes that are left.
  void check_count(const Element& element) {
    std::size_t least = 0;
    for (const Property& p : element.properties) {
      least += lines_ ? sizeof("0\n") - 1 : (p.count_type != nullptr ? *p.count_type : p.type).bytes;
    }
    if (least == 0) source_.fail("element " + element.name, "has no properties");
    // The last line of a text may lack its line break, and words may be left on the current one.
    const std::size_t left = lines_ ? 2 * values_->most_left() + 1 : remaining();
    if (element.count > left / least) {
      source_.fail("element " + element.name, fmt::format("{} of at least {} bytes each do not fit into the {} bytes "
                                                          "that are left",
                                                          element.count, least, left));
    }
  }

  /// read() for each element, which reads all of its values.
  template <class Read>
  void for_each(const Element& element, const Read& read) {
    for (number_ = 0; number_ < element.count; ++number_) {
      if (values_ && !values_->begin_element()) {
        lines_->fail(fmt::format("the file ends before {} {} of {}", element.name, number_, element.count));
      }
      read();
      if (values_) values_->end_element();
    }
  }

  double value(const Type& type) {
    if (!lines_) {
      if (remaining() < type.bytes) fail("the file ends here");
      at_ += type.bytes;
      return type.load(source_.bytes.data() + at_ - type.bytes, header_.order);
    }
    const std::string_view word = values_->word();
    if (type.is_float) return lines_->number(word);
    const std::int64_t integer = lines_->integer(word);
    const auto result = static_cast<double>(integer);
    if (result < type.least || result > type.most) fail(fmt::format("{} does not fit its type", integer));
    return result;
  }

  /// The count of a list, which is not negative and fits into what is left of the file.
  std::size_t list_count(const Property& list) {
    const double count = value(*list.count_type);
    if (count < 0.0) fail(fmt::format("a list of {} values", count));
    const std::size_t left = lines_ ? values_->most_left() : remaining() / list.type.bytes;
    if (count > static_cast<double>(left)) {
      fail(
          fmt::format("a list of {} values, but {}", count,
                      lines_ ? fmt::format("at most {} follow", left) : fmt::format("{} bytes are left", remaining())));
    }
    return static_cast<std::size_t>(count);
  }

  /// Values that nobody needs may be anything: normals that are not numbers, colours from 0 to 1 called uchar.
  void skip(const Property& property) {
    const std::size_t count = property.count_type != nullptr ? list_count(property) : 1;
    if (!lines_) {
      if (remaining() / property.type.bytes < count) fail("the file ends here");
      at_ += count * property.type.bytes;
      return;
    }
    for (std::size_t i = 0; i < count; ++i) values_->word();
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
      surface_.add_vertex(point, line());
    });
    for (const Late& late : late_) {
      late.polygons.for_each([&](std::span<const std::uint32_t> corners, std::size_t line, std::uint64_t number) {
        const auto place = [&] {
          return fmt::format("{}{} {}", line > 0 ? fmt::format("line {}: ", line) : "", late.element->name, number);
        };
        add_polygon(source_, corners, place, surface_);
      });
    }
    late_.clear();
  }

  void read_faces(const Element& element) {
    const Property* indices = nullptr;
    for (const Property& property : element.properties) {
      if (property.name == "vertex_indices" || property.name == "vertex_index") {
        if (indices != nullptr) source_.fail("element " + element.name, "has two lists of vertex indices");
        indices = &property;
      }
    }
    if (indices == nullptr || indices->count_type == nullptr || indices->type.is_float) {
      source_.fail("element " + element.name, "has no list of integers called vertex_indices");
    }
    const bool strips = element.name == "tristrips";
    const bool late = surface_.vertices.size() < vertex_count_;
    if (late) {
      late_.push_back({&element, {}});
    } else {
      surface_.triangles.reserve(surface_.triangles.size() + element.count);
    }
    const auto add = [&](std::span<const std::uint32_t> corners) {
      if (late) return late_.back().polygons.add(corners, line(), number_);
      add_polygon(
          source_, corners, [&] { return place(); }, surface_);
    };
    Corners corners;
    for_each(element, [&] {
      for (const Property& property : element.properties) {
        if (&property != indices) {
          skip(property);
        } else if (strips) {
          read_strip(property, add);
        } else {
          read_corners(property, corners);
        }
      }
      if (!strips) add(corners);
    });
  }

  std::uint32_t vertex(double index) const {
    if (index < 0.0 || index >= static_cast<double>(vertex_count_)) {
      fail(fmt::format("vertex index {} of {}", index, vertex_count_));
    }
    return static_cast<std::uint32_t>(index);
  }

  void read_corners(const Property& list, Corners& corners) {
    const std::size_t count = list_count(list);
    corners.clear();
    for (std::size_t i = 0; i < count; ++i) corners.push_back(vertex(value(list.type)));
  }

  /// Triangles of each three successive vertices, every other one turned. -1, or the largest uint, begins anew. A strip
  /// is led from one place to another by triangles that repeat a vertex.
  template <class Add>
  void read_strip(const Property& list, const Add& add) {
    constexpr double k_restart = -1.0, k_unsigned_restart = 4294967295.0;
    const std::size_t count = list_count(list);
    Triangle t{};
    std::size_t length = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double index = value(list.type);
      if (index == k_restart || index == k_unsigned_restart) {
        length = 0;
        continue;
      }
      t = {t[1], t[2], vertex(index)};
      if (++length < 3 || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      add(length % 2 == 1 ? t : Triangle{t[1], t[0], t[2]});
    }
  }

  void read_end() {
    ForgivenKinds& forgiven = surface_.repairs.forgiven;
    FileRepairs returns = header_.lone_returns;
    if (lines_) {
      values_->expect_end();
      forgiven.set(Forgiven::loose_elements, values_->loose_elements());
      if (returns.count == 0) returns.first_place = lines_->lone_returns().first_place;
      returns.count += lines_->lone_returns().count;
    } else if (remaining() > 0) {
      if (!is_blank_text(std::string_view(source_.bytes).substr(at_))) {
        source_.fail(fmt::format("{} bytes behind the last element", remaining()));
      }
      forgiven.set(Forgiven::trailing_blanks, {remaining(), fmt::format("byte {}", at_)});
    }
    forgiven.set(Forgiven::lone_returns, returns);
  }

  const Source& source_;
  const Header& header_;
  std::size_t at_;  ///< Next byte of a binary file.
  std::optional<TextLines> lines_;
  std::optional<TextValues> values_;
  const Element* element_ = nullptr;
  std::uint64_t number_ = 0;        ///< Of the element.
  std::uint64_t vertex_count_ = 0;  ///< In the header.
  std::vector<Late> late_;          ///< Faces that stand before the vertices.
  FileMesh surface_;
};

}  // namespace

FileMesh read_ply(const Source& source) {
  const Header header = read_header(source);
  return Reader(source, header).read();
}

}  // namespace sixdof::loading
