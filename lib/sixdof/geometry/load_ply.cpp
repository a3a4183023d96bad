#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <sixdof/geometry/bytes.h>
#include <sixdof/geometry/load_formats.h>
#include <sixdof/geometry/text_lines.h>
#include <sixdof/geometry/triangulate.h>

namespace sixdof::loading {
namespace {

enum class Type {
  i8,
  u8,
  i16,
  u16,
  i32,
  u32,
  f32,
  f64
};

std::size_t size_of(Type type) {
  constexpr std::size_t k_sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return k_sizes[static_cast<std::size_t>(type)];
}

std::optional<Type> type_named(std::string_view name) {
  constexpr std::pair<std::string_view, Type> k_names[] = {
      {"char", Type::i8},   {"uchar", Type::u8},   {"short", Type::i16},   {"ushort", Type::u16},
      {"int", Type::i32},   {"uint", Type::u32},   {"float", Type::f32},   {"double", Type::f64},
      {"int8", Type::i8},   {"uint8", Type::u8},   {"int16", Type::i16},   {"uint16", Type::u16},
      {"int32", Type::i32}, {"uint32", Type::u32}, {"float32", Type::f32}, {"float64", Type::f64},
  };
  for (const auto& [known, type] : k_names) {
    if (known == name) return type;
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type;                       // of the value, or of the list's items
  std::optional<Type> count_type;  // set: this is a list
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

enum class Format {
  text,
  little_endian,
  big_endian
};

struct Header {
  Format format = Format::text;
  std::vector<Element> elements;
  std::size_t end = 0;   // byte behind the header
  std::size_t line = 1;  // of that byte, from 1
};

Property read_property(const TextLines& lines) {
  const auto& words = lines.words();
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) lines.fail("a property is 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  const auto type = [&](std::string_view word) {
    const auto known = type_named(word);
    if (!known) lines.fail(fmt::format("'{:.20}' is no type", word));
    return *known;
  };
  Property property{std::string(words.back()), type(words[words.size() - 2]), std::nullopt};
  if (list) {
    property.count_type = type(words[2]);
    if (*property.count_type == Type::f32 || *property.count_type == Type::f64) {
      lines.fail("a list's count must be an integer");
    }
  }
  return property;
}

Header read_header(const Source& source) {
  // The search bounds the walk: without its end the header would be looked for in the data.
  if (!source.bytes.starts_with("ply\n") && !source.bytes.starts_with("ply\r\n")) {
    source.fail("line 1", "does not begin with 'ply'");
  }
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
      if (words[1] == "ascii") {
        header.format = Format::text;
      } else if (words[1] == "binary_little_endian") {
        header.format = Format::little_endian;
      } else if (words[1] == "binary_big_endian") {
        header.format = Format::big_endian;
      } else {
        lines.fail(fmt::format("'{:.30}' is no format", words[1]));
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
      lines.fail(fmt::format("'{:.20}' is unknown in a header", words[0]));
    }
  }
  if (!has_format) lines.fail("the header names no format");
  header.end = lines.position();
  header.line = lines.line() + 1;
  return header;
}

/// Values of the elements one after the other. Integers of all types and floats are exact in a double.
class Values {
 public:
  virtual ~Values() = default;
  /// Called before the values of element `number` of `element`, and after its last one.
  virtual void begin(const Element& element, std::uint64_t number) = 0;
  virtual void end() = 0;
  virtual double value(Type type) = 0;
  /// Bytes that are left in the file.
  virtual std::size_t remaining() const = 0;
  /// The fewest bytes a value can take.
  virtual std::size_t least_bytes(Type type) const = 0;
  /// Fails if a list of `count` values of a type cannot follow.
  virtual void check_list(double count, Type type) const = 0;
  virtual void expect_end() = 0;
  [[noreturn]] virtual void fail(const std::string& cause) const = 0;
};

class BinaryValues final : public Values {
 public:
  BinaryValues(const Source& source, const Header& header)
      : source_(source),
        at_(header.end),
        order_(header.format == Format::big_endian ? std::endian::big : std::endian::little) {}

  void begin(const Element& element, std::uint64_t number) override {
    element_ = &element;
    number_ = number;
  }
  void end() override {}

  double value(Type type) override {
    switch (type) {
      case Type::i8:
        return load<std::int8_t>();
      case Type::u8:
        return load<std::uint8_t>();
      case Type::i16:
        return load<std::int16_t>();
      case Type::u16:
        return load<std::uint16_t>();
      case Type::i32:
        return load<std::int32_t>();
      case Type::u32:
        return load<std::uint32_t>();
      case Type::f32:
        return static_cast<double>(load<float>());
      case Type::f64:
        return load<double>();
    }
    fail("unknown type");
  }

  std::size_t remaining() const override { return source_.bytes.size() - at_; }
  std::size_t least_bytes(Type type) const override { return size_of(type); }

  void check_list(double count, Type type) const override {
    if (count > static_cast<double>(remaining() / size_of(type))) {
      fail(fmt::format("a list of {} values, but {} bytes are left", count, remaining()));
    }
  }

  void expect_end() override {
    if (remaining() != 0) source_.fail(fmt::format("{} bytes behind the last element", remaining()));
  }

  [[noreturn]] void fail(const std::string& cause) const override {
    source_.fail(fmt::format("{} {}", element_->name, number_), cause);
  }

 private:
  template <class T>
  T load() {
    if (remaining() < sizeof(T)) fail("the file ends here");
    const T value = load_bytes<T>(source_.bytes.data() + at_, order_);
    at_ += sizeof(T);
    return value;
  }

  const Source& source_;
  std::size_t at_;
  std::endian order_;
  const Element* element_ = nullptr;
  std::uint64_t number_ = 0;
};

/// One element per line.
class TextValues final : public Values {
 public:
  TextValues(const Source& source, const Header& header) : lines_(source, {}, header.end, header.line) {}

  void begin(const Element& element, std::uint64_t number) override {
    if (!lines_.next()) {
      lines_.fail(fmt::format("the file ends before {} {} of {}", element.name, number, element.count));
    }
    element_ = &element;
    number_ = number;
    word_ = 0;
  }
  void end() override {
    if (word_ != lines_.size()) fail(fmt::format("{} values where {} are expected", lines_.size(), word_));
  }

  double value(Type type) override {
    if (word_ >= lines_.size()) fail(fmt::format("{} values are too few", lines_.size()));
    if (type == Type::f32 || type == Type::f64) return lines_.number(word_++);
    const std::int64_t value = lines_.integer(word_++);
    const auto bits = static_cast<int>(8 * size_of(type));
    const bool is_signed = type == Type::i8 || type == Type::i16 || type == Type::i32;
    const std::int64_t least = is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
    const std::int64_t most = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
    if (value < least || value > most) fail(fmt::format("{} does not fit its type", value));
    return static_cast<double>(value);
  }

  std::size_t remaining() const override { return lines_.remaining(); }
  std::size_t least_bytes(Type) const override { return sizeof("0\n") - 1; }
  void check_list(double count, Type) const override {
    if (count > static_cast<double>(lines_.size() - word_)) {
      fail(fmt::format("a list of {} values, but {} follow", count, lines_.size() - word_));
    }
  }

  void expect_end() override { lines_.expect_end(); }

  [[noreturn]] void fail(const std::string& cause) const override {
    lines_.fail(fmt::format("{} {}: {}", element_->name, number_, cause));
  }

 private:
  TextLines lines_;
  const Element* element_ = nullptr;
  std::uint64_t number_ = 0;
  std::size_t word_ = 0;
};

/// The count of a list, which is not negative and fits into what is left.
std::size_t read_list_count(Values& values, const Property& list) {
  const double count = values.value(*list.count_type);
  if (count < 0.0) values.fail(fmt::format("a list of {} values", count));
  values.check_list(count, list.type);
  return static_cast<std::size_t>(count);
}

void skip(Values& values, const Property& property) {
  std::size_t count = 1;
  if (property.count_type) count = read_list_count(values, property);
  for (std::size_t i = 0; i < count; ++i) values.value(property.type);
}

class Reader {
 public:
  Reader(const Source& source, const Header& header) : source_(source), header_(header) {
    if (header.format == Format::text) {
      values_ = std::make_unique<TextValues>(source, header);
    } else {
      values_ = std::make_unique<BinaryValues>(source, header);
    }
  }

  Surface read() {
    bool has_vertices = false;
    bool has_faces = false;
    for (const Element& element : header_.elements) {
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
        for (std::uint64_t i = 0; i < element.count; ++i) {
          values_->begin(element, i);
          for (const Property& property : element.properties) skip(*values_, property);
          values_->end();
        }
      }
    }
    if (!has_vertices) source_.fail("the header has no element vertex");
    if (!has_faces) source_.fail("the header has no element face");
    values_->expect_end();
    return std::move(surface_);
  }

 private:
  /// Before anything is allocated for it: the count must fit into the bytes that are left.
  void check_count(const Element& element) {
    std::size_t least = 0;
    for (const Property& p : element.properties) least += values_->least_bytes(p.count_type.value_or(p.type));
    if (least == 0) source_.fail("element " + element.name, "has no properties");
    if (element.count > values_->remaining() / least) {
      source_.fail("element " + element.name, fmt::format("{} of at least {} bytes each do not fit into the {} bytes "
                                                          "that are left",
                                                          element.count, least, values_->remaining()));
    }
  }

  void read_vertices(const Element& element) {
    constexpr std::string_view k_axes[] = {"x", "y", "z"};
    std::vector<int> axis_of;
    int found = 0;
    for (const Property& property : element.properties) {
      int axis = -1;
      for (int k = 0; k < 3; ++k) {
        if (property.name == k_axes[k]) axis = k;
      }
      if (axis >= 0) {
        if (property.count_type) source_.fail("element vertex", "property " + property.name + " is a list");
        if (std::find(axis_of.begin(), axis_of.end(), axis) != axis_of.end()) {
          source_.fail("element vertex", "property " + property.name + " appears twice");
        }
        ++found;
      }
      axis_of.push_back(axis);
    }
    if (found != 3) source_.fail("element vertex", "has no properties x, y and z");
    surface_.vertices.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_->begin(element, i);
      Eigen::Vector3d point;
      for (std::size_t k = 0; k < axis_of.size(); ++k) {
        if (axis_of[k] >= 0) {
          point[axis_of[k]] = values_->value(element.properties[k].type);
        } else {
          skip(*values_, element.properties[k]);
        }
      }
      if (!point.allFinite()) {
        values_->fail(fmt::format("coordinates ({}, {}, {}) are not finite", point.x(), point.y(), point.z()));
      }
      values_->end();
      surface_.vertices.push_back(point);
    }
  }

  void read_faces(const Element& element) {
    const Property* indices = nullptr;
    for (const Property& property : element.properties) {
      if (property.name == "vertex_indices" || property.name == "vertex_index") {
        if (indices != nullptr) source_.fail("element face", "has two lists of vertex indices");
        indices = &property;
      }
    }
    if (indices == nullptr || !indices->count_type || indices->type == Type::f32 || indices->type == Type::f64) {
      source_.fail("element face", "has no list of integers called vertex_indices");
    }
    surface_.triangles.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_->begin(element, i);
      for (const Property& property : element.properties) {
        if (&property == indices) {
          read_corners(property, corners);
        } else {
          skip(*values_, property);
        }
      }
      values_->end();
      const std::string cause = triangulate(corners, surface_.vertices, surface_.triangles);
      if (!cause.empty()) values_->fail("is " + cause);
    }
  }

  void read_corners(const Property& list, std::vector<std::uint32_t>& corners) {
    const std::size_t count = read_list_count(*values_, list);
    if (count < 3) values_->fail(fmt::format("has {} corners", count));
    corners.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const double index = values_->value(list.type);
      if (index < 0.0 || index >= static_cast<double>(surface_.vertices.size())) {
        values_->fail(fmt::format("vertex index {} of {}", index, surface_.vertices.size()));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
  }

  const Source& source_;
  const Header& header_;
  std::unique_ptr<Values> values_;
  Surface surface_;
};

}  // namespace

Surface read_ply(const Source& source) {
  const Header header = read_header(source);
  return Reader(source, header).read();
}

}  // namespace sixdof::loading
