#include <sixdof/models/suggestions.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace sixdof {
namespace {

/// Letters to insert, delete, exchange or swap with a neighbour to get from one word to the other (optimal string
/// alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows i - 2, i - 1 and i of the table of distances between the first i letters of a and the first j of b.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t exchange = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({exchange, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
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
