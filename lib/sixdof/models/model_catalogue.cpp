#include <sixdof/models/model_catalogue.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/models/manifest.h>
#include <sixdof/models/recipe.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

/// "12500", "100k", "1m".
std::optional<std::size_t> parse_count(std::string_view text) {
  std::size_t factor = 1;
  if (text.ends_with('k')) factor = 1'000;
  if (text.ends_with('m')) factor = 1'000'000;
  if (factor > 1) text.remove_suffix(1);
  std::size_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || value > k_maximum_triangles) return std::nullopt;
  return value * factor;
}

/// Without those of the collection, which are too many for a message.
std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const Recipe& recipe : recipes()) names.emplace_back(recipe.name);
  for (const FetchedModel& model : fetched_models()) names.push_back(model.name);
  return names;
}

std::vector<std::string> all_names() {
  std::vector<std::string> names = model_names();
  for (const Recipe& recipe : recipe_variants()) names.emplace_back(recipe.name);
  for (const FetchedModel& model : collection_files()) names.push_back(model.name);
  return names;
}

/// The entry of that name, or null.
template <class Entry>
const Entry* find(std::span<const Entry> entries, std::string_view name) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

const Recipe* find_recipe(std::string_view name) {
  const Recipe* const found = find(recipes(), name);
  return found != nullptr ? found : find(recipe_variants(), name);
}

const FetchedModel* find_fetched(std::string_view name) {
  const FetchedModel* const found = find(fetched_models(), name);
  return found != nullptr ? found : find(collection_files(), name);
}

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

[[noreturn]] void throw_unknown(std::string_view name) {
  const std::vector<std::string> near = suggestions(name, all_names());
  throw BadArgument(near.empty()
                        ? fmt::format("no model is called {}; known: {}; more: sixdof models list --collection", name,
                                      fmt::join(model_names(), ", "))
                        : fmt::format("no model is called {}; did you mean {}?", name, fmt::join(near, " or ")));
}

/// Reads a file. If it does not exist, but has a model's name, the message says how to name the model.
Mesh load_file(const std::string& file, const LoadOptions& options) {
  const std::filesystem::path path = mesh_file_of(file);
  if (!std::filesystem::exists(path)) {
    const std::string stem = path.stem().string();
    if (find_fetched(stem) != nullptr) {
      throw BadFile(file, fmt::format("no such file; for the model {0} run models/fetch {0}, and name it {0}, without "
                                      "folder and extension",
                                      stem));
    }
  }
  return load_mesh(file, options);
}

}  // namespace

ModelName parse_model_name(std::string_view name) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed)) {
    throw BadArgument(fmt::format("\"{}\" is no model's name: names consist of a to z, 0 to 9 and -", name));
  }
  const std::size_t dash = name.rfind('-');
  if (dash != std::string_view::npos) {
    if (const auto count = parse_count(name.substr(dash + 1))) return {std::string(name.substr(0, dash)), count};
  }
  return {std::string(name), std::nullopt};
}

bool names_file(std::string_view name_or_file) { return name_or_file.find_first_of("./") != std::string_view::npos; }

Mesh load_model(const std::string& name_or_file, const LoadOptions& options) {
  if (names_file(name_or_file)) return load_file(name_or_file, options);
  const ModelName parts = parse_model_name(name_or_file);
  if (const Recipe* const recipe = find_recipe(parts.base)) {
    if (!parts.triangles) {
      throw BadArgument(fmt::format("{0} is a recipe: say how many triangles, as in {0}-10k", parts.base));
    }
    return recipe->make(*parts.triangles).renamed(name_or_file);
  }
  const FetchedModel* const fetched = find_fetched(parts.base);
  if (fetched == nullptr) throw_unknown(parts.base);
  const std::size_t triangles = parts.triangles.value_or(fetched->triangles);
  if (triangles < fetched->triangles) {
    throw BadArgument(fmt::format("{} has {} triangles and can be subdivided, not coarsened; {} were asked for",
                                  parts.base, fetched->triangles, triangles));
  }
  Mesh mesh = load_fetched_model(*fetched);
  if (triangles == fetched->triangles) return std::move(mesh).renamed(name_or_file);
  return subdivide(mesh, triangles, name_or_file);
}

std::vector<std::string> suggestions(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t k_most_edits = 3;
  constexpr std::size_t k_shortest_part = 3;
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& name : names) {
    const std::size_t edits = edit_distance(word, name);
    const bool similar = edits <= std::min(k_most_edits, std::max<std::size_t>(1, (word.size() + 1) / 3));
    const bool contained = std::min(word.size(), name.size()) >= k_shortest_part &&
                           (name.find(word) != std::string::npos || word.find(name) != std::string_view::npos);
    if (similar || contained) found.emplace_back(edits, name);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> result;
  for (auto& entry : found) result.push_back(std::move(entry.second));
  return result;
}

}  // namespace sixdof
