#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading::ply {

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

std::size_t size_of(Type type);  ///< Bytes in a binary file.
bool is_float(Type type);

struct Property {
  std::string name;
  Type type;                       ///< Of the value, or of the list's items.
  std::optional<Type> count_type;  ///< Set if this is a list.
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
  std::size_t end = 0;   ///< Byte behind the header.
  std::size_t line = 1;  ///< Line of that byte, from 1.
};

/// @throws BadFile
Header read_header(const Source& source);

}  // namespace sixdof::loading::ply
