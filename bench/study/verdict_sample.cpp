#include "bench/study/verdict_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Gaps in diagonals of the smaller body; below zero B is pushed in.
constexpr double k_contact_gaps[] = {1e-4, -1e-4, 1e-3, -1e-3, 3e-3, -3e-3};
constexpr double k_small_gaps[] = {1e-4, 1e-3, 3e-3};
constexpr double k_overlap_gaps[] = {-0.01, -0.02, -0.05};
constexpr const char* k_near_words = "0.01 to 0.3 % of the smaller box's diagonal";
constexpr const char* k_pushed_words = "pushed in by 1 to 5 % of the smaller box's diagonal";

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
  Mover(const Mesh& a, const Mesh& b)
      : oracle_(a, b), query_(oracle_), diagonal_(a.diagonal()), unit_(std::min(a.diagonal(), b.diagonal())) {}

  /// Adds the pose at which the gap is left, if the truth there is on the meant side.
  void add(const Pose& X_AB, double gap, Part& part) {
    const Separation far = query_.distance(X_AB);
    if (!(far.distance > 0.0)) return;
    const Eigen::Vector3d outwards = (far.witness_b - far.witness_a) / far.distance;
    Pose moved = X_AB;
    moved.t -= (far.distance - gap * unit_) * outwards;
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
  const double diagonal_;  ///< Of A, in which distances are judged.
  const double unit_;      ///< Of the gaps.
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
    // Every pose with every gap once, neighbours in the order with different ones of both.
    const std::size_t place = i % poses.size(), round = i / poses.size();
    mover.add(poses[place], gaps[(place + round) % gaps.size()], part);
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

/// "1 to 20 %" of the chosen ones, "5 %" of a single one.
std::string percents_text(const std::vector<BucketKey>& buckets, bool (*chosen)(BucketKey)) {
  std::vector<double> percents;
  for (const BucketKey key : buckets) {
    if (chosen(key)) percents.push_back(key.percent);
  }
  if (percents.empty()) return {};
  const auto [least, most] = std::ranges::minmax(percents);
  return least == most ? fmt::format("{:g} %", most) : fmt::format("{:g} to {:g} %", least, most);
}

/// How far from contact the poses of a kind are.
std::string extent_text(const StudySample& sample, Nearness nearness) {
  if (nearness == Nearness::near) return k_near_words;
  const bool apart = nearness == Nearness::apart;
  const std::string percents = percents_text(sample.buckets, apart ? is_apart : is_overlap);
  if (percents.empty()) return k_pushed_words;
  return percents + (apart ? " of the diagonal of A's box" : " of A's volume");
}

}  // namespace

StudySample draw_verdict_sample(bench::PairCache& cache, const CatalogueEntry& pair, QueryKind question,
                                std::size_t count) {
  if (question == QueryKind::respond) return draw_sample(cache, pair, question, pair.buckets, count);
  std::vector<BucketKey> buckets = pair.buckets;
  std::vector<Part> parts;
  if (question == QueryKind::distance) {
    parts.push_back(drawn(cache, pair, (count + 1) / 2, is_apart));
    parts.push_back(moved(cache, pair, k_small_gaps, count / 2));
  } else {
    const std::size_t third = (count + 2) / 3;
    parts.push_back(drawn(cache, pair, third, is_apart));
    parts.push_back(moved(cache, pair, k_contact_gaps, third));
    parts.push_back(drawn(cache, pair, third, is_overlap));
    if (parts.back().poses.empty()) {
      std::erase_if(buckets, is_overlap);
      parts.back() = moved(cache, pair, k_overlap_gaps, third);
    }
  }
  StudySample sample = interleaved(question, buckets, parts);
  if (sample.poses.empty()) throw BadArgument(fmt::format("{}: its set has no poses for this question", pair.pair));
  return sample;
}

std::string poses_text(const StudySample& sample) {
  std::array<std::size_t, 3> counts{};
  for (const Reference& reference : sample.references) ++counts[static_cast<std::size_t>(reference.nearness)];
  constexpr const char* k_words[] = {"apart", "near contact", "overlapping"};
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    texts.push_back(fmt::format("{} {} ({})", counts[i], k_words[i], extent_text(sample, static_cast<Nearness>(i))));
  }
  return fmt::format("{} judged poses: {}", sample.references.size(), fmt::join(texts, ", "));
}

}  // namespace sixdof::study
