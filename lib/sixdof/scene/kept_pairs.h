#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <sixdof/oracle/near_query.h>
#include <sixdof/scene/bodies.h>
#include <sixdof/scene/box_tree.h>

namespace sixdof::scene::detail {

/// What decides whether a pair is asked in a frame.
struct KeptPair {
  std::uint32_t a = 0, b = 0;  ///< Ranks, a < b.
  /// Sum of both bodies' motion (Motions) at which the surfaces may meet: what is left until then is a lower bound on
  /// their distance.
  double meets_at = -std::numeric_limits<double>::infinity();
};

/// What is known of a pair that was asked.
struct PairMemory {
  NearHint hint;
  std::uint32_t asked = 0;  ///< Frame, from 1; 0 if never.
  bool within = false;      ///< The answer then: within the reach of the question.
  /// Within, since one body is inside the other. It stays so until the surfaces may meet.
  bool nested = false;
  double distance = 0.0;  ///< If within.
};

/// How far each body has moved, as upper bounds that only rise.
class Motions {
 public:
  explicit Motions(std::size_t bodies) : sum_(bodies, 0.0), last_(bodies, 0.0), moved_in_(bodies, 0) {}
  void add(std::uint32_t rank, double distance, std::uint32_t frame) {
    sum_[rank] = (sum_[rank] + distance) * k_up;
    last_[rank] = distance;
    moved_in_[rank] = frame;
  }
  double sum(const KeptPair& pair) const { return sum_[pair.a] + sum_[pair.b]; }
  double last(std::uint32_t rank) const { return last_[rank]; }  ///< Of its last move.
  /// Lower bound on the distance of a pair.
  double distance_left(const KeptPair& pair) const { return pair.meets_at - sum(pair); }
  bool moved_since(const KeptPair& pair, std::uint32_t frame) const {
    return moved_in_[pair.a] > frame || moved_in_[pair.b] > frame;
  }
  /// Notes that the pair's distance is at least `lower` now.
  void note(KeptPair& pair, double lower) const {
    const double at = sum(pair) + lower;
    pair.meets_at = at - k_down * (sum(pair) + std::abs(lower));
  }

 private:
  // Sums are rounded up and bounds down, by more than the roundings of a sum and of a difference.
  static constexpr double k_up = 1.0 + 4e-16;
  static constexpr double k_down = 1e-15;
  std::vector<double> sum_, last_;
  std::vector<std::uint32_t> moved_in_;
};

/// The broad phase: all pairs that may come within a reach, kept from frame to frame. Every body has a box that is
/// larger than it needs to be by a few frames' motion; while it stays inside, the pairs whose large boxes meet are the
/// same.
class KeptPairs {
 public:
  explicit KeptPairs(const Bodies& bodies) : loose_(bodies.size()), pads_(bodies.size(), -1.0) {}

  /// Pairs that may be within `reach` of each other, given the bodies that have moved since the last call. All pairs
  /// are found anew, for `headroom` times the reach, if it is larger than that for which pairs are known, or far
  /// smaller.
  void update(const Bodies& bodies, const Motions& motions, std::span<const std::uint32_t> moved, double reach,
              double headroom = 1.0);

  std::span<KeptPair> pairs() { return pairs_; }  ///< Sorted by (a, b).
  std::span<PairMemory> memory() { return memory_; }
  double reach() const { return reach_; }
  std::size_t bytes() const;

 private:
  void loosen(const Bodies& bodies, const Motions& motions, std::uint32_t rank);
  void find_all(const Bodies& bodies);
  void find_changed(const Bodies& bodies);
  /// Keeps what is known of pairs that are kept.
  void replace(std::span<const std::uint64_t> keys);

  double reach_ = -1.0;
  std::vector<Box> loose_;    // of a body
  std::vector<double> pads_;  // of a body (length); negative before it has a box
  BoxTree tree_;
  std::size_t changes_since_build_ = 0;
  std::vector<std::uint32_t> changed_;
  std::vector<bool> is_changed_;
  std::vector<KeptPair> pairs_, new_pairs_;
  std::vector<PairMemory> memory_, new_memory_;
  std::vector<std::uint64_t> keys_, found_;
};

}  // namespace sixdof::scene::detail
