#include <sixdof/query/registry.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>

namespace sixdof {

void Registry::add(std::unique_ptr<Algorithm> algorithm) {
  if (algorithm == nullptr) throw BadArgument("an algorithm to be registered is null");
  const std::string& name = algorithm->traits().name;
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos) {
    throw BadArgument(fmt::format("algorithm name '{}': only a-z, 0-9 and '-'", name));
  }
  std::size_t values = 0;
  for (const Parameter& parameter : algorithm->traits().parameters) {
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
