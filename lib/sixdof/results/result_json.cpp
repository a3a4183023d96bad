#include <sixdof/results/result_json.h>

#include <map>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>

namespace sixdof::results {

nlohmann::ordered_json parse_document(const std::string& text, const std::string& path) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw BadFile(path, "is empty");
  try {
    return nlohmann::ordered_json::parse(visible_json(text));
  } catch (const nlohmann::ordered_json::exception& e) {
    throw BadFile(path, "not JSON: " + words_of(e));
  }
}

std::string words_of(const nlohmann::json::exception& e) {
  const std::string words = e.what();
  const std::size_t end = words.find("] ");
  return visible_words(end == std::string::npos ? words : words.substr(end + 2));
}

std::string text_at(const nlohmann::ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

double nanoseconds(const std::string& time_unit) {
  static const std::map<std::string, double> units{{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  const auto found = units.find(time_unit);
  if (found == units.end()) throw Error(fmt::format("time_unit \"{}\" is none of ns, us, ms, s", time_unit));
  return found->second;
}

}  // namespace sixdof::results
