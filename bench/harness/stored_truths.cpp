#include "bench/harness/stored_truths.h"

#include <utility>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>

namespace sixdof::bench {

std::string hash_of(std::span<const Pose> poses) {
  ContentHash hash;
  for (const Pose& pose : poses) {
    hash.add_values(std::span<const double>(pose.R.data(), 9));
    hash.add_values(std::span<const double>(pose.t.data(), 3));
  }
  return hash.hex();
}

std::optional<StoredTruths> load_truths(const char* kind, const std::string& key, std::size_t count,
                                        std::size_t numbers) {
  std::optional<CacheEntry> entry = load_cached(kind, key);
  if (!entry) return std::nullopt;
  try {
    StoredTruths truths{entry->take<double>("numbers"), entry->take<std::uint32_t>("flags")};
    if (truths.numbers.size() != numbers * count || truths.flags.size() != count) return std::nullopt;
    return truths;
  } catch (const Error&) {  // an entry of another form
    return std::nullopt;
  }
}

void store_truths(const char* kind, const std::string& key, StoredTruths truths) {
  CacheEntry entry;
  entry.put("numbers", std::move(truths.numbers));
  entry.put("flags", std::move(truths.flags));
  store_cached(kind, key, entry);
}

}  // namespace sixdof::bench
