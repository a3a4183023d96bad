#include "bench/common/mesh_warning.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include "bench/common/interrupt.h"

namespace sixdof {
namespace {

constexpr const char* k_kind = "mesh-check";
constexpr const char* k_version = "2";  // of check_mesh() and of the entry

std::string cache_key(const Mesh& mesh) { return fmt::format("{} version {}", mesh.hash(), k_version); }

std::optional<std::string> load_summary(const Mesh& mesh) {
  std::optional<CacheEntry> entry = load_cached(k_kind, cache_key(mesh));
  if (!entry) return std::nullopt;
  try {
    const std::vector<std::uint32_t> letters = entry->take<std::uint32_t>("summary");
    return std::string(letters.begin(), letters.end());
  } catch (const BadFile&) {
    return std::nullopt;
  }
}

void store_summary(const Mesh& mesh, const std::string& text) {
  CacheEntry entry;
  entry.put("summary", std::vector<std::uint32_t>(text.begin(), text.end()));
  store_cached(k_kind, cache_key(mesh), entry);
}

/// The summary of a check that ends after k_longest_check_s; nothing if it had not finished.
std::optional<std::string> checked_summary(const Mesh& mesh) {
  const auto start = std::chrono::steady_clock::now();
  RunOptions options;
  options.cancelled = [start] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    return elapsed.count() > k_longest_check_s || InterruptGuard::requested();
  };
  try {
    return summary(check_mesh(mesh, options));
  } catch (const Interrupted&) {
    return std::nullopt;
  } catch (const BadMesh&) {  // too large for a tree: who uses it says so
    return std::nullopt;
  }
}

}  // namespace

std::string summary(const MeshCheck& check) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, count == 1 ? one : many);
  };
  add(check.contacts.pairs(), "pair of triangles meets", "pairs of triangles meet");
  add(check.doubled, "shell is doubled", "shells are doubled");
  add(check.nested, "shell lies inside another solid shell", "shells are nested in material");
  add(check.inverted, "shell is inside out", "shells are inside out");
  return text;
}

std::string mesh_warning(const Mesh& mesh, const std::string& argument) {
  if (!mesh.solid()) return {};
  std::optional<std::string> found = load_summary(mesh);
  if (!found) {
    found = checked_summary(mesh);
    if (!found) return {};
    store_summary(mesh, *found);
  }
  if (found->empty()) return {};
  return fmt::format("warning: {}: {}; volumes count a region once for every shell around it ({} {})", mesh.name(),
                     *found, own_command("sixdof info --check"), shell_quoted(argument));
}

}  // namespace sixdof
