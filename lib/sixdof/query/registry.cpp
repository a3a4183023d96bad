#include <sixdof/query/registry.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/query/variant.h>

namespace sixdof {
namespace {

/// What is typed in command lines, and stands in results as "name=value,name=value".
void check_words(const std::string& algorithm, const Parameter& parameter) {
  constexpr std::size_t k_longest = 64;
  constexpr const char* k_in_names = "abcdefghijklmnopqrstuvwxyz0123456789_";
  const std::string& name = parameter.name;
  if (name.empty() || name.size() > k_longest || name.find_first_not_of(k_in_names) != std::string::npos) {
    throw BadArgument(
        fmt::format("algorithm {}: parameter '{}': only a-z, 0-9 and '_'", algorithm, visible_text(name)));
  }
  std::vector<std::string> values{parameter.default_value};
  values.insert(values.end(), parameter.choices.begin(), parameter.choices.end());
  values.insert(values.end(), parameter.sweep.begin(), parameter.sweep.end());
  for (const std::string& value : values) {
    if (value.empty() || value.size() > k_longest || value.find_first_of(" ,\"'`\\") != std::string::npos ||
        visible_text(value, k_any_length) != value) {
      throw BadArgument(
          fmt::format("algorithm {}: {}={}: a value has 1 to {} characters that print, without spaces, "
                      "commas, quotes and backslashes",
                      algorithm, name, visible_text(value), k_longest));
    }
  }
}

/// Names are typed, and stand in names of rows. That of a variant ends with its settings.
bool is_name(const Algorithm& algorithm) {
  const std::string& name = algorithm.traits().name;
  const bool is_variant = dynamic_cast<const VariantAlgorithm*>(&algorithm) != nullptr;
  const std::string own = is_variant ? base_name(name) : name;
  constexpr const char* k_in_values = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_+.=,";
  return !own.empty() && own.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos &&
         (own == name || name.find_first_not_of(k_in_values, own.size() + 1) == std::string::npos);
}

}  // namespace

void Registry::add(std::unique_ptr<Algorithm> algorithm) {
  if (algorithm == nullptr) throw BadArgument("an algorithm to be registered is null");
  const std::string& name = algorithm->traits().name;
  if (!is_name(*algorithm)) {
    throw BadArgument(fmt::format("algorithm name '{}': only a-z, 0-9 and '-'", visible_text(name)));
  }
  std::size_t values = 0;
  for (const Parameter& parameter : algorithm->traits().parameters) {
    check_words(name, parameter);
    const std::size_t own = parameter.sweep.size();
    if (own > 0 && values > 0 && own != values) {
      throw BadArgument(fmt::format("algorithm {}: its sweeps have {} and {} values", name, values, own));
    }
    values = std::max(values, own);
  }
  for (const auto& other : algorithms_) {
    if (other->traits().name == name) throw BadArgument(fmt::format("algorithm {}: already registered", name));
  }
  algorithms_.push_back(std::move(algorithm));
}

const Algorithm& Registry::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const auto& algorithm : algorithms_) {
    if (algorithm->traits().name == name) return *algorithm;
    names.push_back(algorithm->traits().name);
  }
  throw BadArgument(fmt::format("algorithm {}: no such algorithm; there are {}", name, fmt::join(names, ", ")));
}

}  // namespace sixdof
