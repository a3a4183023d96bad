#include "bench/common/hulls.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/oracle/convex_hull.h>

namespace sixdof {
namespace {

constexpr const char* k_kind = "convex-hull";
/// To be raised where convex_hull() gives other triangles.
constexpr int k_version = 1;

std::optional<Mesh> load(const std::string& key, const std::string& name) {
  std::optional<CacheEntry> entry = load_cached(k_kind, key);
  if (!entry) return std::nullopt;
  try {
    const auto numbers = entry->take<double>("vertices");
    const auto corners = entry->take<std::uint32_t>("triangles");
    std::vector<Eigen::Vector3d> vertices;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    return Mesh::build(std::move(vertices), std::move(triangles), name);
  } catch (const Error&) {  // an entry of another form
    return std::nullopt;
  }
}

void store(const std::string& key, const Mesh& hull) {
  std::vector<double> numbers;
  for (const Eigen::Vector3d& v : hull.vertices()) numbers.insert(numbers.end(), v.data(), v.data() + 3);
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : hull.triangles()) corners.insert(corners.end(), t.begin(), t.end());
  CacheEntry entry;
  entry.put("vertices", std::move(numbers));
  entry.put("triangles", std::move(corners));
  store_cached(k_kind, key, entry);
}

}  // namespace

Mesh hull_of(const Mesh& mesh) {
  const std::string key = fmt::format("version {}, mesh {}", k_version, mesh.hash());
  const std::string name = mesh.name() + " (convex hull)";
  if (std::optional<Mesh> known = load(key, name)) return *std::move(known);
  Mesh hull = convex_hull(mesh);
  store(key, hull);
  return hull;
}

}  // namespace sixdof
