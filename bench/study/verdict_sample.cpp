#include "bench/study/verdict_sample.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/distance.h>

namespace sixdof::study {
namespace {

using bench::QueryKind;

/// Gaps in A's diagonals; below zero B is pushed in.
constexpr double k_contact_gaps[] = {1e-4, -1e-4, 1e-3, -1e-3, 3e-3, -3e-3};
constexpr double k_small_gaps[] = {1e-4, 1e-3, 3e-3};
constexpr double k_overlap_gaps[] = {-0.01, -0.02, -0.05};

struct Part {
  std::vector<Pose> poses;
  std::vector<Reference> references;
};

Part part_of(StudySample sample) { return {std::move(sample.poses), std::move(sample.references)}; }

/// Poses of the pair's buckets that are chosen; none if there are no such buckets.
template <class Chosen>
Part drawn(bench::PairCache& cache, const CatalogueEntry& pair, std::size_t count, Chosen chosen) {
  std::vector<BucketKey> keys;
  std::ranges::copy_if(pair.buckets, std::back_inserter(keys), chosen);
  return keys.empty() ? Part{} : part_of(draw_sample(cache, pair, QueryKind::collide, keys, count));
}

bool is_apart(BucketKey key) { return key.kind == BucketKind::distance && key.percent >= 100.0 * k_near; }
bool is_overlap(BucketKey key) { return key.kind == BucketKind::volume && key.percent > 0.0; }

/// Moves B along the shortest way between the surfaces.
class Mover {
 public:
  Mover(const Mesh& a, const Mesh& b) : oracle_(a, b), query_(oracle_), diagonal_(a.diagonal()) {}

  /// Adds the pose at which the gap is left, if the truth there is on the meant side.
  void add(const Pose& X_AB, double gap, Part& part) {
    const Separation far = query_.distance(X_AB);
    if (!(far.distance > 0.0)) return;
    const Eigen::Vector3d outwards = (far.witness_b - far.witness_a) / far.distance;
    Pose moved = X_AB;
    moved.t -= (far.distance - gap * diagonal_) * outwards;
    const bool touches = query_.collide(moved);
    if (touches == (gap > 0.0)) return;
    const Nearness nearness = std::abs(gap) < k_near ? Nearness::near : Nearness::overlapping;
    bench::KnownAnswer known{.key = {BucketKind::volume, 1.0}, .diagonal = diagonal_};  // yes; distance 0
    if (!touches) {
      known.target = query_.distance(moved).distance;
      known.key = {BucketKind::distance, 100.0 * known.target / diagonal_};
    }
    part.poses.push_back(moved);
    part.references.push_back({.known = known, .nearness = nearness, .exact = {}});
  }

 private:
  const DistanceOracle oracle_;
  DistanceQuery query_;
  const double diagonal_;
};

/// From poses of the bucket with the smallest distance, one gap after the other.
Part moved(bench::PairCache& cache, const CatalogueEntry& pair, std::span<const double> gaps, std::size_t count) {
  Part part;
  std::vector<BucketKey> keys;
  std::ranges::copy_if(pair.buckets, std::back_inserter(keys),
                       [](BucketKey key) { return key.kind == BucketKind::distance && key.percent > 0.0; });
  std::ranges::sort(keys, {}, &BucketKey::percent);
  const auto found = std::ranges::find_if(keys, [&](BucketKey key) { return !cache.bucket(pair, key).poses.empty(); });
  if (found == keys.end()) return part;
  const std::vector<Pose>& poses = cache.bucket(pair, *found).poses;
  Mover mover(cache.mesh(pair.a), cache.mesh(pair.b));
  for (std::size_t i = 0; i < poses.size() * gaps.size() && part.poses.size() < count; ++i) {
    // Every pose with every gap, neighbours in the order with different ones of both.
    mover.add(poses[i % poses.size()], gaps[(i + i / poses.size()) % gaps.size()], part);
  }
  return part;
}

/// One pose of each part in turn.
StudySample interleaved(QueryKind question, const std::vector<BucketKey>& buckets, std::span<const Part> parts) {
  StudySample sample{.question = question, .buckets = buckets, .poses = {}, .references = {}, .motions = {}};
  std::size_t longest = 0;
  for (const Part& part : parts) longest = std::max(longest, part.poses.size());
  for (std::size_t i = 0; i < longest; ++i) {
    for (const Part& part : parts) {
      if (i >= part.poses.size()) continue;
      sample.poses.push_back(part.poses[i]);
      sample.references.push_back(part.references[i]);
    }
  }
  return sample;
}

}  // namespace

StudySample draw_verdict_sample(bench::PairCache& cache, const CatalogueEntry& pair, QueryKind question,
                                std::size_t count) {
  if (question == QueryKind::respond) return draw_sample(cache, pair, question, pair.buckets, count);
  std::vector<Part> parts;
  if (question == QueryKind::distance) {
    parts.push_back(drawn(cache, pair, (count + 1) / 2, is_apart));
    parts.push_back(moved(cache, pair, k_small_gaps, count / 2));
  } else {
    const std::size_t third = (count + 2) / 3;
    parts.push_back(drawn(cache, pair, third, is_apart));
    parts.push_back(moved(cache, pair, k_contact_gaps, third));
    parts.push_back(drawn(cache, pair, third, is_overlap));
    if (parts.back().poses.empty()) parts.back() = moved(cache, pair, k_overlap_gaps, third);
  }
  StudySample sample = interleaved(question, pair.buckets, parts);
  if (sample.poses.empty()) throw BadArgument(fmt::format("{}: no configuration can be reached", pair.pair));
  return sample;
}

std::string poses_text(const StudySample& sample) {
  std::array<std::size_t, 3> counts{};
  for (const Reference& reference : sample.references) ++counts[static_cast<std::size_t>(reference.nearness)];
  constexpr const char* k_words[] = {"apart", "near contact", "overlapping"};
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) texts.push_back(fmt::format("{} {}", counts[i], k_words[i]));
  }
  return fmt::format("{} judged poses: {}", sample.references.size(), fmt::join(texts, ", "));
}

}  // namespace sixdof::study
