#pragma once

// The JSON of a glTF file and the numbers in its buffers; only files of lib/sixdof/geometry include this.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {

/// A glTF 2.0 file. Every index, offset, count and length is looked at. Nothing copies a part of the JSON: copying is
/// recursive, and a file may be nested without a bound.
/// @throws BadFile, or nlohmann::json::exception where the JSON is no glTF
class GltfData {
 public:
  explicit GltfData(const Source& source);

  const nlohmann::json& document() const { return document_; }

  /// Member `name` of an object; an empty one if there is none.
  static const nlohmann::json& member(const nlohmann::json& object, const char* name);

  /// An index or a count. @param place of it, for messages
  std::size_t whole(const nlohmann::json& number, const std::string& place) const;
  std::size_t whole(const nlohmann::json& object, const char* name, std::size_t otherwise,
                    const std::string& place) const;

  /// Element `index` of the document's `list`, e.g. "accessors".
  const nlohmann::json& element(const char* list, std::size_t index, const std::string& place) const;

  /// Whether an accessor has numbers in a buffer.
  bool has_data(std::size_t accessor) const;

  /// The numbers of an accessor, element by element. Normalized integers are fractions of their largest value.
  /// @param width numbers of an element, as its type has to have: 1 for SCALAR, 3 for VEC3, 4 for VEC4
  std::vector<double> numbers(std::size_t accessor, std::size_t width);

  /// The whole numbers of an accessor of unsigned integers.
  std::vector<std::uint32_t> indices(std::size_t accessor);

 private:
  struct Layout;

  void read_container();
  std::string_view buffer(std::size_t index);
  std::string_view load_buffer(std::size_t index);
  std::string_view view(std::size_t index, const std::string& place);
  Layout layout_of(std::size_t accessor);

  const Source& source_;
  nlohmann::json document_;
  std::string_view text_, binary_;
  bool has_binary_ = false;
  std::map<std::size_t, std::string_view> buffers_;
  std::map<std::size_t, std::string> loaded_;  ///< Of buffers that are no part of the file's bytes.
};

}  // namespace sixdof::loading
