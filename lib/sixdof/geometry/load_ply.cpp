#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>

#include <fmt/format.h>

#include <sixdof/geometry/bytes.h>
#include <sixdof/geometry/load_ply_header.h>
#include <sixdof/geometry/text_lines.h>

namespace sixdof::loading {
namespace ply {
namespace {

/// The values of the elements in the file's order. A double holds integers of all types and floats exactly.
class Values {
 public:
  virtual ~Values() = default;
  /// Called before the first value of element `number` of `element`.
  virtual void begin(const Element& element, std::uint64_t number) = 0;
  /// Called after the last value of an element.
  virtual void end() = 0;
  virtual double value(Type type) = 0;
  /// Bytes that are left in the file.
  virtual std::size_t remaining() const = 0;
  /// The smallest number of bytes that a value takes in the file.
  virtual std::size_t least_bytes(Type type) const = 0;
  /// Throws a BadFile if the rest of the file, or of the line, is too short for a list of `count` values.
  virtual void check_list(double count, Type type) const = 0;
  virtual void expect_end() = 0;
  /// Where in the file the current element is: "face 3", in a text "line 17: face 3".
  virtual std::string place() const = 0;
  [[noreturn]] void fail(const std::string& cause) const { source_.fail(place(), cause); }

 protected:
  explicit Values(const Source& source) : source_(source) {}
  const Source& source_;
};

class BinaryValues final : public Values {
 public:
  BinaryValues(const Source& source, const Header& header)
      : Values(source),
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

  std::string place() const override { return fmt::format("{} {}", element_->name, number_); }

 private:
  template <class T>
  T load() {
    if (remaining() < sizeof(T)) fail("the file ends here");
    const T value = load_bytes<T>(source_.bytes.data() + at_, order_);
    at_ += sizeof(T);
    return value;
  }

  std::size_t at_;
  std::endian order_;
  const Element* element_ = nullptr;
  std::uint64_t number_ = 0;
};

/// One element per line.
class TextValues final : public Values {
 public:
  TextValues(const Source& source, const Header& header)
      : Values(source), lines_(source, {}, header.end, header.line) {}

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
    if (is_float(type)) return lines_.number(word_++);
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

  std::string place() const override { return fmt::format("{}: {} {}", lines_.place(), element_->name, number_); }

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
    if (indices == nullptr || !indices->count_type || is_float(indices->type)) {
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
      const PolygonShape shape = triangulate(corners, surface_.vertices, surface_.triangles);
      if (shape != PolygonShape::simple) count_polygon(source_, shape, values_->place(), surface_.repairs);
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
}  // namespace ply

Surface read_ply(const Source& source) {
  const ply::Header header = ply::read_header(source);
  return ply::Reader(source, header).read();
}

}  // namespace sixdof::loading
