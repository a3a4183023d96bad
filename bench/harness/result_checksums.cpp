#include "bench/harness/result_checksums.h"

#include <algorithm>
#include <span>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include "bench/common/json_text.h"

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_key = "checksum";

/// @param object without its checksum
/// @param context checksum of the context, empty for the context itself
std::string checksum_of(const Json& object, std::string_view context) {
  ContentHash hash;
  hash.add_values(std::span(context));
  const std::string text = json_text(object, -1);
  hash.add_values(std::span<const char>(text));
  return hash.hex();
}

/// Takes the checksum out of an object. @return the one that it should have had
std::string take(Json& object, std::string_view context, const std::string& what, const std::filesystem::path& file,
                 std::string_view text, const std::string& name) {
  const std::string found = object.value(k_key, "");
  object.erase(k_key);
  const std::string expected = checksum_of(object, context);
  if (found == expected) return expected;
  const std::size_t at = text.find(found.empty() ? name : found);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size())), '\n');
  throw BadFile(file.string(), fmt::format("line {}", line),
                fmt::format("cannot be continued: {} {}", what,
                            found.empty() ? "has no checksum: edited, or of another program"
                                          : "does not have its checksum: damaged or edited"));
}

}  // namespace

void add_checksums(Json& document) {
  Json& context = document.at("context");
  const std::string of_context = checksum_of(context, {});
  context[k_key] = of_context;
  for (Json& row : document.at("benchmarks")) row[k_key] = checksum_of(row, of_context);
}

void take_checksums(Json& document, const std::filesystem::path& file, std::string_view text) {
  const std::string of_context = take(document.at("context"), {}, "the context", file, text, "\"context\"");
  for (Json& row : document.at("benchmarks")) {
    const std::string name = row.at("name");
    take(row, of_context, fmt::format("row {}", name), file, text, json_text(Json(name), -1));
  }
}

}  // namespace sixdof::bench
