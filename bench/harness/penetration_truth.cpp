#include "bench/harness/penetration_truth.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <sixdof/oracle/convex_depth.h>
#include "bench/common/hulls.h"
#include "bench/harness/stored_truths.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_kind = "penetration-truth";
/// To be raised where PenetrationOracle, convex_depth() or what is stored changes.
constexpr int k_version = 3;
constexpr PenetrationOptions k_options{.tolerance = 1e-3, .budget = 1'000'000};
/// lo, hi.
constexpr std::size_t k_numbers = 2;
/// Rounding of convex_depth(), over the depth and both sizes.
constexpr double k_rounding = 1e-13;

std::optional<std::vector<PenetrationDepth>> load(const std::string& key, std::size_t count) {
  const std::optional<StoredTruths> stored = load_truths(k_kind, key, count, k_numbers);
  if (!stored) return std::nullopt;
  std::vector<PenetrationDepth> truths(count);
  for (std::size_t i = 0; i < count; ++i) {
    truths[i].lo = stored->numbers[k_numbers * i];
    truths[i].hi = stored->numbers[k_numbers * i + 1];
    truths[i].closed = stored->flags[i] != 0;
    if (!(truths[i].lo >= 0.0 && truths[i].lo <= truths[i].hi)) return std::nullopt;
  }
  return truths;
}

void store(const std::string& key, std::span<const PenetrationDepth> truths) {
  StoredTruths stored;
  for (const PenetrationDepth& truth : truths) {
    stored.numbers.insert(stored.numbers.end(), {truth.lo, truth.hi});
    stored.flags.push_back(truth.closed ? 1 : 0);
  }
  store_truths(k_kind, key, std::move(stored));
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
