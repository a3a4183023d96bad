#include <sixdof/geometry/load_ply_header.h>

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <sixdof/geometry/text_lines.h>

namespace sixdof::loading::ply {
namespace {

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
    if (is_float(*property.count_type)) lines.fail("a list's count must be an integer");
  }
  return property;
}

}  // namespace

std::size_t size_of(Type type) {
  constexpr std::size_t k_sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return k_sizes[static_cast<std::size_t>(type)];
}

bool is_float(Type type) { return type == Type::f32 || type == Type::f64; }

Header read_header(const Source& source) {
  const std::string_view text = std::string_view(source.bytes).substr(text_begin(source.bytes));
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n")) source.fail("line 1", "does not begin with 'ply'");
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

}  // namespace sixdof::loading::ply
