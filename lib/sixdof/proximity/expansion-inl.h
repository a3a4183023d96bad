// Part of the searches of oracle/ and generation/. Taken once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_PROXIMITY_EXPANSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_PROXIMITY_EXPANSION_INL_H_
#undef SIXDOF_PROXIMITY_EXPANSION_INL_H_
#else
#define SIXDOF_PROXIMITY_EXPANSION_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/close_search.h>
#include <sixdof/proximity/volumes-inl.h>

// A step of a traversal of two trees: a pair of volumes is replaced by the pairs of their children, up to 8 x 8. If one
// of the two is a leaf, or much smaller than the other, it stays whole.

HWY_BEFORE_NAMESPACE();
namespace sixdof::volumes {
namespace HWY_NAMESPACE {

// Volumes of a tree are numbered as in CloseVolume.
HWY_INLINE bool is_leaf(std::uint32_t volume) { return (volume & detail::CloseVolume::k_leaf) != 0; }
HWY_INLINE const Tree::Leaf& leaf_of(const Tree& tree, std::uint32_t volume) {
  return tree.leaves()[volume - detail::CloseVolume::k_leaf];
}
HWY_INLINE const Tree::Volume& volume_of(const Tree& tree, std::uint32_t volume) {
  return is_leaf(volume) ? leaf_of(tree, volume).volume : tree.nodes()[volume].volume;
}

/// The children of a node, or one volume that stays whole.
/// @tparam kept how many of those loaded last are kept, for volumes that meet several of the other tree
template <Rounding rounding, std::size_t kept = 1>
class Side {
 public:
  explicit Side(const Tree& tree) : nodes_(tree.nodes().data()), leaves_(tree.leaves().data()) {}

  /// Loads what it has not loaded already.
  /// @param own, other whose N is the tree's frame, and the other tree's
  template <bool with_front>
  HWY_INLINE void take(std::uint32_t volume, bool splits, const Frame& own, const Frame& other) {
    now_ = &kept_[volume % kept];
    if (HWY_LIKELY(volume == now_->volume && splits == now_->splits)) return;
    now_->volume = volume;
    now_->splits = splits;
    if (splits) {
      now_->whole = &nodes_[volume].volume;
      now_->lanes = (1u << nodes_[volume].child_count) - 1;
      load<with_front>(ChildrenOf{nodes_[volume]}, own, other);
    } else {
      now_->whole = is_leaf(volume) ? &leaves_[volume - Tree::k_leaf_number].volume : &nodes_[volume].volume;
      now_->lanes = 1;
      load<with_front>(Whole{whole()}, own, other);
    }
  }
  /// After a frame changed.
  void forget() {
    for (Loaded& loaded : kept_) loaded.volume = k_none;
  }

  bool splits() const { return now_->splits; }
  const Volumes& volumes() const { return now_->volumes; }
  /// The volume around all.
  const Tree::Volume& whole() const { return *now_->whole; }
  /// Bits of the lanes in use.
  std::uint32_t lanes() const { return now_->lanes; }
  /// The volume in a lane.
  HWY_INLINE std::uint32_t child(std::size_t i) const {
    return now_->splits ? nodes_[now_->volume].number[i] : now_->volume;
  }
  /// Fetches what a child's children, or its triangles, are loaded from.
  HWY_INLINE void prefetch_child(std::uint32_t child) const {
    is_leaf(child) ? prefetch(leaves_[child - Tree::k_leaf_number]) : prefetch(nodes_[child]);
  }

 private:
  static constexpr std::uint32_t k_none = ~std::uint32_t{0};

  struct Loaded {
    std::uint32_t volume = k_none;
    bool splits = false;
    std::uint32_t lanes = 0;
    const Tree::Volume* whole = nullptr;
    Volumes volumes;
  };

  template <bool with_front, class Source>
  HWY_INLINE void load(const Source& source, const Frame& own, const Frame& other) {
    Volumes& volumes = now_->volumes;
    volumes.load_own<rounding>(source);
    volumes.turn<rounding>(other);
    if constexpr (with_front) volumes.set_front<rounding>(source, own);
  }

  const Tree::Node* nodes_;
  const Tree::Leaf* leaves_;
  Loaded kept_[kept];
  Loaded* now_ = kept_;
};

/// Two volumes that are not both leaves.
template <Rounding rounding, bool with_front, std::size_t kept = 1>
struct Expansion {
  Side<rounding, kept> a, b;

  Expansion(const Tree& tree_a, const Tree& tree_b) : a(tree_a), b(tree_b) {}

  /// @param size_a, size_b squares of their boxes' diagonals
  HWY_INLINE void take(std::uint32_t volume_a, float size_a, std::uint32_t volume_b, float size_b,
                       const Frames& frames) {
    // Of two volumes the smaller is split, too, if the square of its size is not below that of the larger divided by
    // this: from 2 to 24 the same within 3 %.
    constexpr float k_alike = 4.0f;
    const bool leaf_a = is_leaf(volume_a), leaf_b = is_leaf(volume_b);
    a.template take<with_front>(volume_a, !leaf_a && (leaf_b || k_alike * size_a >= size_b), frames.a, frames.b);
    b.template take<with_front>(volume_b, !leaf_b && (leaf_a || k_alike * size_b >= size_a), frames.b, frames.a);
  }
  HWY_INLINE void take(const Tree& tree_a, std::uint32_t volume_a, const Tree& tree_b, std::uint32_t volume_b,
                       const Frames& frames) {
    take(volume_a, volume_of(tree_a, volume_a).squared_diagonal(), volume_b,
         volume_of(tree_b, volume_b).squared_diagonal(), frames);
  }
  void forget() {
    a.forget();
    b.forget();
  }
};

/// Volumes of y (bits) whose boxes are not farther than `limit` from the box of a volume of x.
/// @param sweep half a translation of y, in x's frame: y is all that it passes
template <Rounding rounding>
HWY_INLINE std::uint32_t near_boxes(const Tree::Volume& x, const Volumes& y, float limit, const float (&sweep)[3]) {
  std::uint32_t near = 0;
  for (std::size_t j = 0; j < k_width; j += hn::Lanes(k_lanes)) {
    V squared = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V center = load(y.other_center[k] + j), half = hn::Add(load(y.other_half[k] + j), set(std::abs(sweep[k])));
      const V above = hn::Sub(hn::Sub(center, half), set(x.upper[k]));
      const V below = hn::Sub(set(x.lower[k]), hn::Add(center, half));
      const V gap = hn::Max(hn::Max(above, below), hn::Zero(k_lanes));
      squared = mul_add<rounding>(gap, gap, squared);
    }
    near |= bits_of(hn::Le(squared, set(limit * limit)), j);
  }
  return near;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::volumes
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
