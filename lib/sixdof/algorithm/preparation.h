#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/solid.h>

/// Shared by the algorithms that prepare structures of their own.

namespace sixdof {

/// @param what needs the solid, for the message
/// @throws BadMesh with the reason if the mesh is not solid(), or of a size whose cube has no double
inline void require_solid(const Mesh& mesh, const std::string& what) {
  if (!mesh.solid())
    throw BadMesh(mesh.name() + ": " + what + " needs a solid: " + mesh.why_not_solid() + k_repair_hint);
  if (!(mesh.diagonal() >= Tree::k_smallest_diagonal && mesh.diagonal() <= Tree::k_largest_diagonal)) {
    throw BadMesh(fmt::format("{}: {} needs a box diagonal of {} to {}, not {}", mesh.name(), what,
                              Tree::k_smallest_diagonal, Tree::k_largest_diagonal, mesh.diagonal()));
  }
}

/// Whether all numbers of an array from the cache are finite.
inline bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}
inline bool all_finite(const std::vector<Eigen::Vector3d>& points) {
  return std::all_of(points.begin(), points.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

/// Copies the members of a structure to a CacheEntry, or moves them back. Reading throws BadFile where an array is
/// missing or has another size.
struct CacheMembers {
  CacheEntry& entry;
  bool reading;

  template <class T>
  void array(const std::string& name, std::vector<T>& values) {
    if (reading) {
      values = entry.take<T>(name);
    } else {
      entry.put(name, values);
    }
  }

  /// Records that consist of doubles.
  template <class Record>
  void records(const std::string& name, std::vector<Record>& values) {
    constexpr std::size_t k_numbers = sizeof(Record) / sizeof(double);
    const auto* const first = reinterpret_cast<const double*>(values.data());
    std::vector<double> numbers(first, first + k_numbers * values.size());
    array(name, numbers);
    values.resize(numbers.size() / k_numbers);
    std::copy_n(numbers.begin(), k_numbers * values.size(), reinterpret_cast<double*>(values.data()));
  }

  /// Single numbers, as one array of type T.
  template <class T, class... Number>
  void numbers(const std::string& name, Number&... number) {
    std::vector<T> values{static_cast<T>(number)...};
    array(name, values);
    if (values.size() != sizeof...(number)) throw BadFile(name, "another size");
    std::size_t next = 0;
    ((number = values[next++]), ...);
  }
};

/// A structure from the cache on disk (base/cache.h); if the cache has no valid entry, from build(), and then stored.
/// @param key names everything that the structure depends on, and the version of its layout
/// @param visit called with CacheMembers and the structure
/// @param valid whether the arrays of a structure that was read fit together and hold what queries rely on
template <class Build, class Visit, class Valid>
auto load_or_build(std::string_view kind, const std::string& key, const Build& build, const Visit& visit,
                   const Valid& valid) {
  if (std::optional<CacheEntry> entry = load_cached(kind, key)) {
    try {
      decltype(build()) structure;
      visit(CacheMembers{*entry, true}, structure);
      if (valid(structure)) return structure;
    } catch (const BadFile&) {
      // Counts as no entry.
    }
  }
  auto structure = build();
  CacheEntry entry;
  visit(CacheMembers{entry, false}, structure);
  store_cached(kind, key, entry);
  return structure;
}

}  // namespace sixdof
