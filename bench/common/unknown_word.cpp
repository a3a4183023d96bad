#include "bench/common/unknown_word.h"

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

/// The one of `names` that `word` probably means; empty if none is similar.
std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  if (const std::vector<std::string> near = suggestions(word, names); !near.empty()) return near.front();
  // Exchanged letters, which are too many edits for a short word.
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return std::is_permutation(word.begin(), word.end(), name.begin(), name.end());
  });
  return found == names.end() ? std::string() : *found;
}

}  // namespace

std::string explain_unknown_word(std::string_view word, const std::vector<std::string>& names, std::string_view help) {
  const bool is_option = word.starts_with('-');
  if (is_option) word = word.substr(0, word.find('='));
  const std::string meant = nearest(word.substr(std::min(word.find_first_not_of('-'), word.size())), names);
  const std::string hint = meant.empty() ? fmt::format(" ({} lists them)", help)
                                         : fmt::format("; did you mean {}{}?", is_option ? "--" : "", meant);
  return fmt::format("{}: no such {}{}", word, is_option ? "option" : "command", hint);
}

}  // namespace sixdof
