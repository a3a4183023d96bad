#include "bench/harness/variants.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/query/variant.h>
#include "bench/common/rivals.h"

namespace sixdof::bench {
namespace {

/// "NAME=VALUE" of each value.
using Choices = std::vector<std::string>;

/// "NAME=V,V" as its assignments; empty for one value.
Choices choices_of(const std::string& text, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || assignment.find(',', equals) == std::string::npos) return {};
  const std::string name = assignment.substr(0, equals + 1);
  Choices choices;
  for (std::size_t at = equals + 1, end = 0; end != std::string::npos; at = end + 1) {
    end = assignment.find(',', at);
    const std::string value = assignment.substr(at, end == std::string::npos ? end : end - at);
    if (value.empty()) throw BadArgument(fmt::format("--parameter {}: a value is missing", text));
    choices.push_back(name + value);
  }
  return choices;
}

/// Every combination of one of each.
std::vector<Choices> combinations(const std::vector<Choices>& lists) {
  std::vector<Choices> all{{}};
  for (const Choices& list : lists) {
    std::vector<Choices> longer;
    for (const Choices& so_far : all) {
      for (const std::string& choice : list) {
        longer.push_back(so_far);
        longer.back().push_back(choice);
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace

std::vector<std::string> register_variants(const std::vector<std::string>& parameters,
                                           const std::vector<VariantRequest>& further, Registry& registry) {
  std::map<std::string, std::vector<Choices>> lists;  // by algorithm
  std::vector<std::string> others;
  for (const std::string& text : parameters) {
    const std::size_t colon = text.find(':');
    const std::string assignment = colon == std::string::npos ? text : text.substr(colon + 1);
    const Choices choices = choices_of(text, assignment);
    if (colon == std::string::npos || choices.empty()) {
      others.push_back(text);
      continue;
    }
    const std::string parameter = assignment.substr(0, assignment.find('='));
    const auto suits = [&](const Traits& traits) {
      return std::ranges::any_of(traits.parameters, [&](const Parameter& each) { return each.name == parameter; });
    };
    for (const std::string& name : with_rivals({text.substr(0, colon)}, registry, suits)) {
      registry.find(name);  // throws for one that does not exist
      lists[name].push_back(choices);
    }
  }
  for (std::unique_ptr<Algorithm>& algorithm : registry.take()) {
    const std::string name = algorithm->traits().name;
    std::vector<Choices> wanted;
    for (const VariantRequest& request : further) {
      if (request.algorithm == name) wanted.push_back(request.assignments);
    }
    const auto found = lists.find(name);
    if (found == lists.end() && wanted.empty()) {
      registry.add(std::move(algorithm));
      continue;
    }
    const std::shared_ptr<const Algorithm> base = std::move(algorithm);
    if (found == lists.end()) {
      registry.add(std::make_unique<VariantAlgorithm>(base));
    } else {
      const std::vector<Choices> all = combinations(found->second);
      wanted.insert(wanted.begin(), all.begin(), all.end());
    }
    for (const Choices& assignments : wanted) registry.add(std::make_unique<VariantAlgorithm>(base, assignments));
  }
  return others;
}

}  // namespace sixdof::bench
