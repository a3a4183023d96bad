#include "bench/harness/penetration_truth.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/oracle/convex_depth.h>
#include "bench/common/hulls.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_kind = "penetration-truth";
/// To be raised where PenetrationOracle, convex_depth() or what is stored changes.
constexpr int k_version = 2;
constexpr PenetrationOptions k_options{.tolerance = 1e-3, .budget = 1'000'000};
/// lo, hi.
constexpr std::size_t k_numbers = 2;
/// Rounding of convex_depth(), over the depth and both sizes.
constexpr double k_rounding = 1e-13;

std::string hash_of(std::span<const Pose> poses) {
  ContentHash hash;
  for (const Pose& pose : poses) {
    hash.add_values(std::span<const double>(pose.R.data(), 9));
    hash.add_values(std::span<const double>(pose.t.data(), 3));
  }
  return hash.hex();
}

std::optional<std::vector<PenetrationDepth>> load(const std::string& key, std::size_t count) {
  std::optional<CacheEntry> entry = load_cached(k_kind, key);
  if (!entry) return std::nullopt;
  try {
    const auto numbers = entry->take<double>("intervals");
    const auto closed = entry->take<std::uint32_t>("closed");
    if (numbers.size() != k_numbers * count || closed.size() != count) return std::nullopt;
    std::vector<PenetrationDepth> truths(count);
    for (std::size_t i = 0; i < count; ++i) {
      truths[i].lo = numbers[k_numbers * i];
      truths[i].hi = numbers[k_numbers * i + 1];
      truths[i].closed = closed[i] != 0;
      if (!(truths[i].lo >= 0.0 && truths[i].lo <= truths[i].hi)) return std::nullopt;
    }
    return truths;
  } catch (const Error&) {  // an entry of another form
    return std::nullopt;
  }
}

void store(const std::string& key, std::span<const PenetrationDepth> truths) {
  std::vector<double> numbers;
  std::vector<std::uint32_t> closed;
  for (const PenetrationDepth& truth : truths) {
    numbers.insert(numbers.end(), {truth.lo, truth.hi});
    closed.push_back(truth.closed ? 1 : 0);
  }
  CacheEntry entry;
  entry.put("intervals", std::move(numbers));
  entry.put("closed", std::move(closed));
  store_cached(k_kind, key, entry);
}

}  // namespace

PenetrationTruths PenetrationTruths::of_hulls(const Mesh& a, const Mesh& b) {
  PenetrationTruths truths(a, b);
  truths.hull_a_ = std::make_shared<const Mesh>(hull_of(a));
  truths.hull_b_ = &a == &b ? truths.hull_a_ : std::make_shared<const Mesh>(hull_of(b));
  return truths;
}

PenetrationDepth PenetrationTruths::compute(const Pose& X_AB) {
  if (hull_a_) {
    const ConvexDepth found = convex_depth(*hull_a_, *hull_b_, X_AB);
    const double rounding = k_rounding * (found.depth + hull_a_->diagonal() + hull_b_->diagonal());
    return {.lo = std::max(0.0, found.depth - rounding), .hi = found.depth + rounding, .closed = true};
  }
  if (!oracle_) oracle_ = std::make_unique<const PenetrationOracle>(*a_, *b_);
  return oracle_->evaluate(X_AB, k_options);
}

std::span<const PenetrationDepth> PenetrationTruths::at(std::span<const Pose> poses) {
  poses = poses.first(std::min(poses.size(), k_most));
  const std::string key = fmt::format("version {}, {}, tolerance {}, budget {}, A {}, B {}, {} poses {}", k_version,
                                      hull_a_ ? "hulls" : "meshes", k_options.tolerance, k_options.budget, a_->hash(),
                                      b_->hash(), poses.size(), hash_of(poses));
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  std::optional<std::vector<PenetrationDepth>> truths = load(key, poses.size());
  if (!truths) {
    truths.emplace();
    for (const Pose& pose : poses) truths->push_back(compute(pose));
    store(key, *truths);
  }
  return known_.emplace(key, *std::move(truths)).first->second;
}

}  // namespace sixdof::bench
