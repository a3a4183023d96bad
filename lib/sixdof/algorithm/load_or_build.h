#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>

namespace sixdof {

/// A prepared structure from the cache on disk (base/cache.h); if the cache has no valid entry, from build(), and then
/// stored.
/// @param key names everything that the structure depends on, and the version of its layout
/// @param pack from a structure to a CacheEntry
/// @param unpack from a CacheEntry to an optional structure: none if the arrays do not fit together
template <class Build, class Pack, class Unpack>
auto load_or_build(std::string_view kind, const std::string& key, const Build& build, const Pack& pack,
                   const Unpack& unpack) {
  if (std::optional<CacheEntry> entry = load_cached(kind, key)) {
    try {
      if (auto structure = unpack(std::move(*entry))) return std::move(*structure);
    } catch (const BadFile&) {
      // An entry without one of its arrays counts as none.
    }
  }
  auto structure = build();
  store_cached(kind, key, pack(structure));
  return structure;
}

}  // namespace sixdof
