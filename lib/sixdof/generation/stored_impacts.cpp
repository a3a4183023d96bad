#include <sixdof/generation/stored_impacts.h>

#include <optional>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/hash.h>
#include <sixdof/generation/impact_truth.h>

namespace sixdof {
namespace {

constexpr const char* k_kind = "impact-truth";

/// Kind, t_free, t_touch, queries, then the closest points: distance, a, b.
constexpr std::size_t k_numbers = 11;

void put(std::vector<double>& numbers, const ImpactBracket& bracket) {
  numbers.push_back(static_cast<double>(bracket.kind));
  numbers.insert(numbers.end(), {bracket.t_free, bracket.t_touch, static_cast<double>(bracket.queries)});
  numbers.push_back(bracket.closest.distance);
  for (const double x : bracket.closest.witness_a) numbers.push_back(x);
  for (const double x : bracket.closest.witness_b) numbers.push_back(x);
}

ImpactBracket bracket_of(const double* n) {
  ImpactBracket bracket{.kind = static_cast<ImpactBracket::Kind>(static_cast<int>(n[0])),
                        .t_free = n[1],
                        .t_touch = n[2],
                        .queries = static_cast<std::uint64_t>(n[3])};
  bracket.closest = {
      .distance = n[4], .has_witnesses = true, .witness_a = {n[5], n[6], n[7]}, .witness_b = {n[8], n[9], n[10]}};
  return bracket;
}

std::optional<std::vector<ImpactBracket>> load(const std::string& key, std::size_t count) {
  auto entry = load_cached(k_kind, key);
  if (!entry) return {};
  const auto numbers = entry->take<double>("brackets");
  if (numbers.size() != k_numbers * count) return {};
  std::vector<ImpactBracket> brackets;
  for (std::size_t i = 0; i < count; ++i) brackets.push_back(bracket_of(numbers.data() + k_numbers * i));
  return brackets;
}

}  // namespace

std::string impact_key(const Mesh& a, const Mesh& b, std::span<const Motion> motions) {
  ContentHash hash;
  const auto add = [&](const auto& matrix) {
    hash.add_values(std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
  };
  for (const Motion& motion : motions) {
    add(motion.start.R);
    for (const Eigen::Vector3d& v : {motion.start.t, motion.translation, motion.rotation, motion.reference}) add(v);
  }
  return fmt::format("version {} a {} b {} motions {} {}", k_impact_truth_version, a.hash(), b.hash(), motions.size(),
                     hash.hex());
}

std::vector<ImpactBracket> stored_impacts(const Mesh& a, const Mesh& b, std::span<const Motion> motions) {
  const std::string key = impact_key(a, b, motions);
  if (auto known = load(key, motions.size())) return *std::move(known);
  ImpactTruth truth(a, b);
  std::vector<ImpactBracket> brackets;
  std::vector<double> numbers;
  for (const Motion& motion : motions) {
    ImpactBracket& bracket = brackets.emplace_back(truth.find(motion).bracket);
    bracket.closest.triangle_a = bracket.closest.triangle_b = Separation::k_no_triangle;
    put(numbers, bracket);
  }
  CacheEntry entry;
  entry.put("brackets", std::move(numbers));
  store_cached(k_kind, key, entry);
  return brackets;
}

}  // namespace sixdof
