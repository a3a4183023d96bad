#include <sixdof/results/row_fields.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::results {
namespace {

using Json = nlohmann::ordered_json;

/// The members that are text and are left out where empty.
constexpr std::pair<const char*, std::string RowFields::*> k_texts[] = {
    {"pair", &RowFields::pair},         {"order", &RowFields::order},   {"cache", &RowFields::cache},
    {"scenario", &RowFields::scenario}, {"target", &RowFields::target}, {"question", &RowFields::question},
    {"body", &RowFields::body},         {"object", &RowFields::object}, {"partner", &RowFields::partner},
    {"kind", &RowFields::kind},         {"shape", &RowFields::shape},   {"runtime", &RowFields::runtime},
    {"law", &RowFields::law},
};

constexpr std::pair<const char*, std::optional<std::uint64_t> RowFields::*> k_counts[] = {
    {"sample_limit", &RowFields::sample_limit},
    {"configurations", &RowFields::configurations},
    {"triangles", &RowFields::triangles},
};

/// The whole text as a number; empty if it is none.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

Json number_or_text(const std::string& text) {
  if (const auto integer = parse<std::int64_t>(text)) return *integer;
  if (const auto number = parse<double>(text); number && std::isfinite(*number)) return *number;
  return text;
}

Json settings_object(const std::string& settings) {
  Json object = Json::object();
  std::istringstream words(settings);
  for (std::string word; std::getline(words, word, ',');) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) object[word.substr(0, equals)] = number_or_text(word.substr(equals + 1));
  }
  return object;
}

/// A conversion would wrap what is negative, and has no defined result for what is too large.
std::uint64_t count_of(const Json& number) {
  if (!number.is_number_unsigned()) throw BadArgument("not a whole number");
  return number.get<std::uint64_t>();
}

std::string settings_text(const Json& object) {
  if (!object.is_object()) throw BadArgument("not an object");
  std::string text;
  for (const auto& [name, value] : object.items()) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", name,
                        value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

/// Calls `read`; names the key where it throws.
template <class Read>
void read_key(const char* key, Read read) {
  try {
    read();
  } catch (const Json::exception& e) {
    throw Error(fmt::format("{}.{}: {}", k_row_fields_key, key, e.what()));
  } catch (const BadArgument& e) {
    throw Error(fmt::format("{}.{}: {}", k_row_fields_key, key, e.what()));
  }
}

}  // namespace

Json percent_number(BucketKey key) {
  const auto whole = static_cast<int>(key.percent);
  return whole == key.percent ? Json(whole) : Json(key.percent);
}

std::string settings_as_read(const std::string& settings) { return settings_text(settings_object(settings)); }

Json to_json_object(BucketKey key) { return {{"kind", to_string(key.kind)}, {"percent", percent_number(key)}}; }

BucketKey bucket_of(const Json& object) {
  const auto percent = object.at("percent").get<double>();
  return BucketKey::parse(fmt::format("{}/{}", object.at("kind").get<std::string>(), percent));
}

Json to_json_object(const RowFields& fields) {
  Json object = {{"query", fields.query}, {"algorithm", fields.algorithm}};
  object["settings"] = settings_object(fields.settings);
  for (const auto& [key, member] : k_texts) {
    if (!(fields.*member).empty()) object[key] = fields.*member;
  }
  if (fields.isolated) object["isolated"] = true;
  if (fields.approximates) object["approximates"] = true;
  if (fields.bucket) {
    object["bucket"] = to_json_object(*fields.bucket);
  }
  for (const auto& [key, member] : k_counts) {
    if (fields.*member) object[key] = *(fields.*member);
  }
  if (fields.volume_unit) object["volume_unit"] = *fields.volume_unit;
  return object;
}

RowFields row_fields_of(const Json& object) {
  RowFields fields;
  read_key("query", [&] { object.at("query").get_to(fields.query); });
  read_key("algorithm", [&] { object.at("algorithm").get_to(fields.algorithm); });
  read_key("settings", [&] { fields.settings = settings_text(object.at("settings")); });
  for (const auto& [key, member] : k_texts) {
    if (object.contains(key)) read_key(key, [&, name = key, to = member] { object.at(name).get_to(fields.*to); });
  }
  if (object.contains("isolated")) read_key("isolated", [&] { object.at("isolated").get_to(fields.isolated); });
  if (object.contains("approximates")) {
    read_key("approximates", [&] { object.at("approximates").get_to(fields.approximates); });
  }
  if (object.contains("bucket")) {
    read_key("bucket", [&] { fields.bucket = bucket_of(object.at("bucket")); });
  }
  for (const auto& [key, member] : k_counts) {
    if (object.contains(key)) {
      read_key(key, [&, name = key, to = member] { fields.*to = count_of(object.at(name)); });
    }
  }
  if (object.contains("volume_unit")) {
    read_key("volume_unit", [&] {
      fields.volume_unit = object.at("volume_unit").get<double>();
      if (!(*fields.volume_unit > 0.0)) throw BadArgument("not above zero");
    });
  }
  return fields;
}

}  // namespace sixdof::results
