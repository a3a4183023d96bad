#include <sixdof/scene/kept_pairs.h>

#include <algorithm>

namespace sixdof::scene::detail {
namespace {

/// A loose box allows for as many moves like the last one, within shares of the body's radius.
constexpr double k_frames = 4.0;
constexpr double k_least_pad = 0.01;
constexpr double k_first_pad = 0.05;
constexpr double k_largest_pad = 0.4;
/// All pairs are found anew where more than this share of the bodies has left its box.
constexpr std::size_t k_many = 6;  // one in six
/// The tree is made anew after as many changes as it has this share of bodies.
constexpr std::size_t k_stale = 2;  // one in two

/// Pairs that are known for a reach this many times as large as needed are too many.
constexpr double k_far_smaller = 0.1;

std::uint64_t key_of(std::uint32_t i, std::uint32_t j) { return std::uint64_t{std::min(i, j)} << 32 | std::max(i, j); }

std::uint64_t key_of(const KeptPair& pair) { return std::uint64_t{pair.a} << 32 | pair.b; }

}  // namespace

void KeptPairs::loosen(const Bodies& bodies, const Motions& motions, std::uint32_t rank) {
  const double radius = bodies.radius(rank);
  double pad = 0.0;
  if (!bodies.fixed(rank)) {
    pad = pads_[rank] < 0.0 ? k_first_pad * radius
                            : std::clamp(k_frames * motions.last(rank), k_least_pad * radius, k_largest_pad * radius);
  }
  pads_[rank] = pad;
  loose_[rank] = bodies.box(rank).grown(0.5 * reach_ * (1.0 + 1e-12) + pad);
}

void KeptPairs::update(const Bodies& bodies, const Motions& motions, std::span<const std::uint32_t> moved, double reach,
                       double headroom) {
  const auto n = static_cast<std::uint32_t>(bodies.size());
  if (reach > reach_ || reach < k_far_smaller * reach_) {
    reach_ = headroom * reach;
    for (std::uint32_t i = 0; i < n; ++i) loosen(bodies, motions, i);
    return find_all(bodies);
  }
  changed_.clear();
  const double half = 0.5 * reach_ * (1.0 + 1e-12);
  for (const std::uint32_t i : moved) {
    if (!loose_[i].contains(bodies.box(i).grown(half))) changed_.push_back(i);
  }
  if (changed_.empty()) return;
  if (k_many * changed_.size() > n) {
    // Those that are about to leave their boxes would be next.
    for (const std::uint32_t i : moved) loosen(bodies, motions, i);
    return find_all(bodies);
  }
  for (const std::uint32_t i : changed_) loosen(bodies, motions, i);
  find_changed(bodies);
}

void KeptPairs::find_all(const Bodies& bodies) {
  tree_.build(loose_);
  changes_since_build_ = 0;
  replace(tree_.meeting_pairs([&](std::uint32_t i, std::uint32_t j) { return bodies.matters(i, j); }));
}

void KeptPairs::find_changed(const Bodies& bodies) {
  is_changed_.resize(bodies.size());
  changes_since_build_ += changed_.size();
  if (k_stale * changes_since_build_ > bodies.size()) {
    tree_.build(loose_);
    changes_since_build_ = 0;
  } else {
    for (const std::uint32_t i : changed_) tree_.set(i, loose_[i]);
  }
  found_.clear();
  for (const std::uint32_t i : changed_) is_changed_[i] = true;
  for (const std::uint32_t i : changed_) {
    tree_.for_each_meeting(loose_[i], [&](std::uint32_t j) {
      // Of two changed ones, the first finds the pair.
      if (i == j || (is_changed_[j] && j < i) || !bodies.matters(i, j)) return;
      found_.push_back(key_of(i, j));
    });
  }
  std::ranges::sort(found_);
  keys_.clear();
  auto next = found_.begin();
  for (const KeptPair& pair : pairs_) {
    if (is_changed_[pair.a] || is_changed_[pair.b]) continue;
    const std::uint64_t key = key_of(pair);
    for (; next != found_.end() && *next < key; ++next) keys_.push_back(*next);
    keys_.push_back(key);
  }
  keys_.insert(keys_.end(), next, found_.end());
  for (const std::uint32_t i : changed_) is_changed_[i] = false;
  replace(keys_);
}

void KeptPairs::replace(std::span<const std::uint64_t> keys) {
  new_pairs_.clear();
  new_memory_.clear();
  new_pairs_.reserve(keys.size());
  new_memory_.reserve(keys.size());
  std::size_t old = 0;
  for (const std::uint64_t key : keys) {
    while (old < pairs_.size() && key_of(pairs_[old]) < key) ++old;
    if (old < pairs_.size() && key_of(pairs_[old]) == key) {
      new_pairs_.push_back(pairs_[old]);
      new_memory_.push_back(memory_[old]);
    } else {
      new_pairs_.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)});
      new_memory_.emplace_back();
    }
  }
  pairs_.swap(new_pairs_);
  memory_.swap(new_memory_);
}

std::size_t KeptPairs::bytes() const {
  return loose_.capacity() * sizeof(Box) + tree_.bytes() +
         (pairs_.capacity() + new_pairs_.capacity()) * sizeof(KeptPair) +
         (memory_.capacity() + new_memory_.capacity()) * sizeof(PairMemory) +
         (keys_.capacity() + found_.capacity()) * sizeof(std::uint64_t);
}

}  // namespace sixdof::scene::detail
