#include <sixdof/models/suggestions.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace sixdof {
namespace {

/// Letters to insert, delete or exchange to get from one word to the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t exchange = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({exchange, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> suggestions(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t k_most_edits = 3;
  constexpr std::size_t k_shortest_part = 3;
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& name : names) {
    const std::size_t edits = edit_distance(word, name);
    const bool similar = edits <= std::min(k_most_edits, std::max<std::size_t>(1, (word.size() + 1) / 3));
    const bool contained = word.size() >= k_shortest_part &&
                           (name.find(word) != std::string::npos || word.find(name) != std::string_view::npos);
    if (similar || contained) found.emplace_back(edits, name);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> result;
  for (auto& entry : found) result.push_back(std::move(entry.second));
  return result;
}

}  // namespace sixdof
