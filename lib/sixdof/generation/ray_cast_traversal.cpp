#include <sixdof/generation/ray_cast_traversal.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include <sixdof/generation/ray_cast_pair.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/generation/ray_cast_traversal.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_bounds-inl.h>
#include <sixdof/generation/ray_cast_leaves-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

/// So many pairs are left open before the first try to cut some by their heights.
constexpr std::uint64_t k_first_try = 8;

/// Visits of a front, over those of the cast that began it. Nodes that were opened where hits were before are not
/// closed again; beyond this, starting over costs less.
constexpr double k_most_growth = 2.0;

/// Where two flat patches lie face to face, bounds in floats fall short by this times their radii: 1.3e-3 for normals
/// that are shorter than unit vectors, as much again for how far those of one rough face are turned.
constexpr float k_flat_blur = 2e-3f;

/// What a try to cut two subtrees by their heights adds to what may be looked at for it (CastTies), where they may tie
/// and elsewhere. Heights along the axis found last are exact, where volumes reach below their triangles: on smooth
/// surfaces they halve the nodes that are looked into. Of 1, 2, 4 .. 64 elsewhere, 8 took the least time on three
/// bodies.
constexpr std::uint64_t k_pay_near = 16;
constexpr std::uint64_t k_pay_far = 8;

/// When heights are to try a cut again: how many pairs bounds in floats have left open by then. Where they cut none,
/// tries become rare.
struct Tries {
  std::uint64_t last_cut = 0;
  std::uint64_t next = k_first_try;

  void note(bool cut, std::uint64_t left_open) {
    if (cut) last_cut = left_open;
    next = cut ? left_open : left_open + 1 + (left_open - last_cut) / 2;
  }
};

struct Descent {
  Cast& cast;
  CastFront& front;
  const CastTree& tree_a;
  const CastTree& tree_b;
  Ray ray;
  const double tie;
  std::uint64_t left_open = 0;  // pairs that bounds in floats left open so far
  Tries face_tries, axis_tries;

  explicit Descent(Cast& c) : cast(c), front(c.front), tree_a(c.a), tree_b(c.b), tie(k_cast_tie * c.size()) {
    for (int k = 0; k < 3; ++k) ray.u[k] = static_cast<float>(cast.direction[k]);
    ray.target = static_cast<float>(cast.target);
    ray.slack = static_cast<float>(k_slack * cast.size());
    ray.reach = static_cast<float>(1.01 * cast.size());
    update();
  }

  /// After a change of translation and axis.
  void update() {
    for (int k = 0; k < 3; ++k) {
      ray.axis[k] = static_cast<float>(k_axis_length * cast.axis[k]);
      ray.shift[k] = static_cast<float>(cast.translations * cast.direction[k]);
    }
    ray.translations = static_cast<float>(cast.translations);
  }

  /// What is opened next is not far.
  static void prefetch(const CastTree& tree, CastChild child) {
    constexpr std::size_t k_cache_line = 64;  // bytes
    const bool leaf = child.is_leaf();
    const char* begin = leaf ? reinterpret_cast<const char*>(&tree.leaves()[child.index()])
                             : reinterpret_cast<const char*>(&tree.nodes()[child.index()]);
    const std::size_t size = leaf ? sizeof(CastLeaf) : sizeof(CastNode);
    for (std::size_t offset = 0; offset < size; offset += k_cache_line) hwy::Prefetch(begin + offset);
  }

  static const CastVolume& volume_of(const CastTree& tree, std::uint32_t child) {
    return child == CastFront::k_root ? tree.root_volume() : tree.volume(child);
  }

  static CastChild child_of(const CastTree& tree, std::uint32_t child) {
    return child == CastFront::k_root ? CastChild::node(0) : tree.nodes()[child / k_width].child[child % k_width];
  }

  /// Whether slab `x` and slab `y` with a box around are apart by the target, up to a tie, from cast.translation on.
  bool slabs_apart(const CastSlab& x, const CastSlab& y, const CastVolume& box) const {
    const double up = x.normal.dot(cast.direction);
    const double sign = up < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d n = sign * x.normal;
    const double along = n.dot(y.normal);
    double low = sign * x.middle - x.half + along * y.middle - std::abs(along) * y.half;
    const Eigen::Vector3d rest = n - along * y.normal;
    for (int k = 0; k < 3; ++k) {
      const double half = static_cast<double>(box.half[k]) + static_cast<double>(ray.slack);
      low += rest[k] * static_cast<double>(box.center[k]) - std::abs(rest[k]) * half;
    }
    return low + cast.translations * std::abs(up) >= cast.target - tie;
  }

  /// Whether two flat patches tie with what was found: in double precision, where floats cannot tell.
  bool ties(std::uint32_t a, std::uint32_t b) const {
    if (a == CastFront::k_root || b == CastFront::k_root) return false;
    const CastSlab slab_a = tree_a.slab(a);
    const CastSlab slab_b = tree_b.slab(b);
    return slabs_apart(slab_a, slab_b, tree_b.volume(b)) || slabs_apart(slab_b, slab_a, tree_a.volume(a));
  }

  /// Whether two subtrees are apart by the target along the face's normal, or along the axis along which triangles were
  /// last found to be, if it is time to find out. Where the axis does not point against the direction, they stay apart.
  /// What is cut is farther in than what offer_pair() turns down by half a tie, which is more than the rounding of
  /// both; as long as no pair stands for it, a tie is not cut. Unless it is more than floats round, the child's line
  /// stays as it is: a narrower target looks into it again.
  bool apart_along_axes(const CastFront::Open& child, std::uint32_t a, std::uint32_t b, std::uint64_t pay) {
    if (a == CastFront::k_root || b == CastFront::k_root) return false;
    const auto apart = [&](CastTies& known, const Eigen::Vector3d& axis, Tries& tries) {
      const double slope = axis.dot(cast.direction);
      if (slope < 0.0) return false;
      const double gap = cast.translations * slope + known.lowest(a, b, axis, pay) - cast.target;
      const bool cut = gap >= (cast.pair ? -0.5 * tie : 0.0);
      tries.note(cut, left_open);
      if (gap > ray.slack) set_line(child, static_cast<float>(gap), static_cast<float>(slope));
      return cut;
    };
    if (left_open >= face_tries.next && cast.face.faces(cast.axis, cast.direction) &&
        apart(cast.face_ties, cast.face.normal(), face_tries)) {
      return true;
    }
    return left_open >= axis_tries.next && apart(cast.ties, cast.apart_axis, axis_tries);
  }

  /// Learns the normal of the face that two flat patches are of.
  void note_face(std::uint32_t a, std::uint32_t b) {
    if (!cast.pair || a == CastFront::k_root || b == CastFront::k_root) return;
    const bool larger_a = tree_a.volume(a).size >= tree_b.volume(b).size;
    const CastTree& tree = larger_a ? tree_a : tree_b;
    const std::uint32_t larger = larger_a ? a : b;
    const float size = tree.volume(larger).size;
    if (size > cast.face.size() || !cast.face.faces(cast.axis, cast.direction)) {
      cast.face.note(tree.slab(larger).normal, size, cast.axis, cast.direction);
    }
  }

  /// Of each triangle, how low its lowest corner lies along the axis.
  void lowest_corners(const CastLeaf& leaf, float* HWY_RESTRICT low) const {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& p = leaf.corner[corner];
      for (std::size_t i = 0; i < k_leaf_triangles; ++i) {
        const float x = ray.axis[0] * p[0][i] + ray.axis[1] * p[1][i] + ray.axis[2] * p[2][i];
        low[i] = corner == 0 ? x : std::min(low[i], x);
      }
    }
  }

  /// @param line of the pair, to be set
  void look_into_leaves(std::uint32_t leaf_a, std::uint32_t leaf_b, const CastFront::Open& line) {
    ++cast.counts.leaf_pairs;
    const CastLeaf& a = tree_a.leaves()[leaf_a];
    const CastLeaf& b = tree_b.leaves()[leaf_b];

    // Along the axis found so far, all pairs at once.
    float low_a[k_leaf_triangles], low_b[k_leaf_triangles];
    lowest_corners(a, low_a);
    lowest_corners(b, low_b);
    const float along = ray.axis[0] * ray.shift[0] + ray.axis[1] * ray.shift[1] + ray.axis[2] * ray.shift[2] - ray.target;
    float least =
        along + *std::min_element(low_a, low_a + k_leaf_triangles) + *std::min_element(low_b, low_b + k_leaf_triangles);
    if (least > ray.slack) return set_line(line, least, ray.axis_slope());

    const Tree::Child child_a = tree_a.mesh().leaf_children()[leaf_a];
    const Tree::Child child_b = tree_b.mesh().leaf_children()[leaf_b];
    least = CastFront::k_always;  // of the pairs that are culled
    float steepest = ray.axis_slope();
    std::uint32_t left[k_leaf_triangles * k_leaf_triangles];  // 4 i + j for pair (i, j)
    float gap[k_leaf_triangles * k_leaf_triangles];
    std::size_t left_count = 0;
    for (std::uint32_t i = 0; i < child_a.count(); ++i) {
      for (std::uint32_t j = 0; j < child_b.count(); ++j) {
        left[left_count] = static_cast<std::uint32_t>(k_leaf_triangles) * i + j;
        const float over = along + low_a[i] + low_b[j];
        left_count += over > ray.slack ? 0 : 1;
        least = over > ray.slack ? std::min(least, over) : least;
      }
    }

    std::uint32_t order[k_leaf_triangles * k_leaf_triangles];
    std::size_t count = 0;
    LeafPair pairs;
    for (std::size_t first = 0; first < left_count; first += LeafPair::k_pairs) {
      const std::size_t chunk = std::min(LeafPair::k_pairs, left_count - first);
      pick_pairs(a, b, left + first, chunk, pairs);
      bound_triangles(pairs, ray);
      for (std::size_t n = 0; n < chunk; ++n) {
        if (pairs.gaps[n] > ray.slack) {
          least = std::min(least, pairs.gaps[n]);
          steepest = std::max(steepest, pairs.slopes[n]);
          continue;
        }
        const std::uint32_t pair = left[first + n];
        gap[pair] = pairs.gaps[n];
        std::size_t at = count++;
        for (; at > 0 && gap[order[at - 1]] > gap[pair]; --at) order[at] = order[at - 1];
        order[at] = pair;
      }
    }
    // Below the least gap with the steepest slope lie the lines of all.
    set_line(line, count == 0 ? least : CastFront::k_never, steepest);
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t i = order[n] / k_leaf_triangles;
      const std::uint32_t j = order[n] % k_leaf_triangles;
      if (offer_pair(cast, {child_a.first() + i, child_b.first() + j})) {
        update();
      } else {
        ++left_open;
      }
    }
  }

  /// @param chosen 4 i + j for pair (i, j)
  void pick_pairs(const CastLeaf& a, const CastLeaf& b, const std::uint32_t* chosen, std::size_t count,
                  LeafPair& pairs) const {
    for (std::size_t k = 0; k < 3; ++k) {
      // Relative to one corner, so that only the floats given round.
      const float origin = a.corner[0][k][0];
      const float b_shift = origin + ray.shift[k];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t n = 0; n < LeafPair::k_pairs; ++n) {
          const std::uint32_t pair = chosen[n < count ? n : 0];
          pairs.a[corner][k][n] = a.corner[corner][k][pair / k_leaf_triangles] - origin;
          pairs.b[corner][k][n] = b.corner[corner][k][pair % k_leaf_triangles] + b_shift;
        }
      }
    }
  }

  void set_line(const CastFront::Open& child, float gap, float slope) {
    front.lines[child.visit].low[child.lane] = gap + ray.target - slope * ray.translations;
    front.lines[child.visit].slope[child.lane] = slope;
  }

  /// What a child's line says, less the target.
  float gap_of(const CastFront::Open& child) const {
    const CastFront::Lines& lines = front.lines[child.visit];
    return lines.low[child.lane] + lines.slope[child.lane] * ray.translations - ray.target;
  }

  /// What the worst of a visit's lines says, less the target.
  float least_gap(std::uint32_t visit) const {
    const CastFront::Lines& lines = front.lines[visit];
    V least = set(CastFront::k_always);
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V slope = hn::Load(k_lanes, lines.slope + i);
      least = hn::Min(least, mul_add(slope, set(ray.translations), hn::Load(k_lanes, lines.low + i)));
    }
    return hn::GetLane(hn::MinOfLanes(k_lanes, least)) - ray.target;
  }

  /// Bounds a visit's children, which raises their lines, and leaves for later what no line culls.
  void look_into(std::uint32_t visit) {
    ++cast.counts.nodes;
    const auto [index, other, opens_a] = front.visits[visit];
    const CastTree& tree = opens_a ? tree_a : tree_b;
    const CastNode& node = tree.nodes()[index];
    const CastVolume& fixed = volume_of(opens_a ? tree_b : tree_a, other);
    HWY_ALIGN float gaps[k_width], slopes[k_width], heights[k_width];
    bound_children(node, fixed, ray, gaps, slopes, heights);
    CastFront::Lines& lines = front.lines[visit];
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V low = hn::Load(k_lanes, lines.low + i);
      const V slope = hn::Load(k_lanes, lines.slope + i);
      const V known = hn::Sub(mul_add(slope, set(ray.translations), low), set(ray.target));
      const V gap = hn::Load(k_lanes, gaps + i);
      const V new_slope = hn::Load(k_lanes, slopes + i);
      const V new_low = hn::Add(sub_mul(gap, new_slope, set(ray.translations)), set(ray.target));
      const auto raises = hn::Gt(gap, known);
      hn::Store(hn::IfThenElse(raises, new_low, low), k_lanes, lines.low + i);
      hn::Store(hn::IfThenElse(raises, new_slope, slope), k_lanes, lines.slope + i);
      HWY_ALIGN std::uint8_t stored[8] = {};
      hn::StoreMaskBits(k_lanes, hn::Le(hn::Max(gap, known), set(ray.slack)), stored);
      left |= static_cast<std::uint32_t>(stored[0]) << i;
    }
    std::vector<CastFront::Open>& open = front.open;
    const std::size_t first = open.size();
    const bool fixed_flat = fixed.slab_half <= ray.slack;
    for (; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const bool flat = fixed_flat && node.slab_half[lane] <= ray.slack;
      const float blur = flat ? k_flat_blur * (node.ball_radius[lane] + fixed.ball_radius) : 0.0f;
      const bool near = gaps[lane] > -ray.slack - blur;
      ++left_open;
      const auto own = static_cast<std::uint32_t>(index * k_width + lane);
      const std::uint32_t a = opens_a ? own : other;
      const std::uint32_t b = opens_a ? other : own;
      if (near && flat) {
        if (ties(a, b)) continue;
        note_face(a, b);
      }
      const CastFront::Open next{visit, lane, heights[lane]};
      if (apart_along_axes(next, a, b, near ? k_pay_near : k_pay_far)) continue;
      prefetch(tree, node.child[lane]);
      std::size_t at = open.size();
      open.push_back(next);
      for (; at > first && open[at - 1].height < next.height; --at) open[at] = open[at - 1];
      open[at] = next;
    }
  }

  /// Opens the larger of two volumes that are not both leaves.
  void visit(std::uint32_t a, std::uint32_t b) {
    const CastChild child_a = child_of(tree_a, a);
    const CastChild child_b = child_of(tree_b, b);
    const bool opens_a =
        child_b.is_leaf() || (!child_a.is_leaf() && volume_of(tree_a, a).size >= volume_of(tree_b, b).size);
    const std::uint32_t index = (opens_a ? child_a : child_b).index();
    front.visits.push_back({index, opens_a ? b : a, opens_a});
    CastFront::Lines& lines = front.lines.emplace_back();
    const std::uint32_t count = (opens_a ? tree_a : tree_b).nodes()[index].child_count;
    for (std::uint32_t lane = 0; lane < k_width; ++lane) {
      lines.low[lane] = lane < count ? CastFront::k_never : CastFront::k_always;
      lines.slope[lane] = 0.0f;
    }
    look_into(static_cast<std::uint32_t>(front.visits.size() - 1));
  }

  /// Looks into all that was left for later.
  void empty_open() {
    while (!front.open.empty()) {
      const CastFront::Open top = front.open.back();
      front.open.pop_back();
      const float gap = gap_of(top);
      if (gap > ray.slack) continue;  // the translation may have been raised since
      const CastFront::Visit from = front.visits[top.visit];
      const auto own = static_cast<std::uint32_t>(k_width * from.node + top.lane);
      const std::uint32_t a = from.opens_a ? own : from.other;
      const std::uint32_t b = from.opens_a ? from.other : own;
      if (apart_along_axes(top, a, b, gap > -ray.slack ? k_pay_near : k_pay_far)) continue;
      const CastChild child_a = child_of(tree_a, a);
      const CastChild child_b = child_of(tree_b, b);
      if (child_a.is_leaf() && child_b.is_leaf()) {
        look_into_leaves(child_a.index(), child_b.index(), top);
      } else {
        set_line(top, CastFront::k_always, 0.0f);
        visit(a, b);
      }
    }
  }

  /// Finds the visits of which a child is no longer culled.
  void find_uncovered() {
    front.uncovered.clear();
    const V enough = set(ray.target + ray.slack);
    const V translations = set(ray.translations);
    const auto count = static_cast<std::uint32_t>(front.visits.size());
    for (std::uint32_t visit = 0; visit < count; ++visit) {
      const CastFront::Lines& lines = front.lines[visit];
      bool culled = true;
      for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
        const V value = mul_add(hn::Load(k_lanes, lines.slope + i), translations, hn::Load(k_lanes, lines.low + i));
        culled = culled && hn::AllTrue(k_lanes, hn::Gt(value, enough));
      }
      if (!culled) front.uncovered.push_back(visit);
    }
  }

  /// Looks into the visits that are uncovered: into the worst few first, for as long as they raise the translation.
  void look_into_uncovered() {
    std::vector<std::uint32_t>& all = front.uncovered;
    double before = -1.0;
    while (!all.empty()) {
      if (cast.translations != before) {
        before = cast.translations;
        look_into_worst();
      } else {
        const std::uint32_t visit = all.back();
        all.pop_back();
        look_into(visit);
        empty_open();
      }
    }
  }

  /// Looks into the worst few of the visits that are uncovered, and drops those that no longer are.
  void look_into_worst() {
    constexpr std::size_t k_few = 8;
    struct {
      float gap;
      std::uint32_t visit;
    } worst[k_few];  // ascending
    std::size_t few = 0;
    std::size_t left = 0;
    std::vector<std::uint32_t>& all = front.uncovered;
    for (const std::uint32_t visit : all) {
      const float gap = least_gap(visit);
      if (gap > ray.slack) continue;
      if (few == k_few && gap >= worst[k_few - 1].gap) {
        all[left++] = visit;
        continue;
      }
      if (few == k_few) all[left++] = worst[--few].visit;
      std::size_t at = few++;
      for (; at > 0 && worst[at - 1].gap > gap; --at) worst[at] = worst[at - 1];
      worst[at] = {gap, visit};
    }
    all.resize(left);
    for (std::size_t i = 0; i < few; ++i) {
      if (i > 0 && least_gap(worst[i].visit) > ray.slack) continue;
      look_into(worst[i].visit);
      empty_open();
    }
  }

  void run() {
    if (cast.target > front.target) front.clear();  // lines need translations that do not grow
    const bool grown = static_cast<double>(front.visits.size()) > k_most_growth * static_cast<double>(front.fresh);
    if (cast.target != front.target && grown) front.clear();
    front.target = cast.target;
    front.open.clear();
    if (front.visits.empty()) {
      visit(CastFront::k_root, CastFront::k_root);
      empty_open();
      front.fresh = front.visits.size();
    } else {
      find_uncovered();
      look_into_uncovered();
    }
  }
};

void find_first_hit(Cast& cast) { Descent(cast).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {
namespace {

/// Grazing rays halve the error per step, others square it.
constexpr int k_most_steps = 100;

/// |distance - target| at which a step changes nothing, in units of Cast::size(): the rounding of the corners.
constexpr double k_settled = 2e-16;

/// Below this target, in units of Cast::size(), the rounding of closest points turns the axis between them so far that
/// ties along it are not seen. Of buckets this is only that of contact.
constexpr double k_blurred_target = 1e-3;

}  // namespace

HWY_EXPORT(find_first_hit);

void find_first_hit(Cast& cast) {
  HWY_DYNAMIC_DISPATCH(find_first_hit)(cast);
  cast.counts.supports = cast.ties.supports() + cast.face_ties.supports();
}

bool offer_pair(Cast& cast, CastPair pair) {
  ++cast.counts.offers;
  const TriangleCorners mirrored = cast.a.triangle(pair.a);
  const TriangleCorners a{-mirrored[0], -mirrored[1], -mirrored[2]};
  const TriangleCorners at_center = cast.b.triangle(pair.b);
  const double size = cast.size();
  const double tie = k_cast_tie * size;
  // Triangles around the corners and edges of the closest pair tie with it along its axis.
  const auto apart_along = [&](const Eigen::Vector3d& axis) {
    return cast.translations * axis.dot(cast.direction) + lowest_difference(mirrored, at_center, axis);
  };
  const double enough = cast.target - tie;
  if (cast.pair && (apart_along(cast.axis) >= enough || apart_along(cast.apart_axis) >= enough)) return false;
  const MovingPair moving(a, at_center, cast.direction);
  const auto sample_at = [&](double t) {
    ++cast.counts.distances;
    return moving.at(t);
  };
  // The distance is convex in t. Where it reaches the target at t or beyond, Newton's method ends at the last such place:
  // a step up the slope ends to the right of it, and from there no step goes past it.
  double t = cast.translations;
  MovingPair::Sample sample = sample_at(t);
  const auto separating_axis = [&](const MovingPair::Sample& at, double translations) -> Eigen::Vector3d {
    if (cast.target >= k_blurred_target * size) return at.axis;
    const Eigen::Vector3d move = translations * cast.direction;
    const Eigen::Vector3d axis =
        sharp_axis(mirrored, {at_center[0] + move, at_center[1] + move, at_center[2] + move}, at.axis, 0.25 * tie);
    return axis.dot(cast.direction) >= 0.0 ? axis : at.axis;
  };
  if (sample.distance >= cast.target - tie && sample.slope >= 0.0) {
    if (cast.pair) cast.apart_axis = separating_axis(sample, t);
    return false;
  }
  if (sample.distance >= cast.target || !(sample.slope > 0.0)) {
    double highest_a = -std::numeric_limits<double>::infinity();
    double lowest_b = -highest_a;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      highest_a = std::max(highest_a, a[corner].dot(cast.direction));
      lowest_b = std::min(lowest_b, at_center[corner].dot(cast.direction));
    }
    t = highest_a - lowest_b + cast.target;  // apart by the target along the ray
    if (t <= cast.translations) return false;
    sample = sample_at(t);
  }
  for (int step = 0; step < k_most_steps; ++step) {
    const double above = sample.distance - cast.target;
    if (std::abs(above) <= k_settled * size) break;
    if (!(sample.slope > 0.0)) return false;  // the least distance is above the target
    const double next = t - above / sample.slope;
    if (next <= cast.translations) return false;
    if (next == t) break;
    t = next;
    sample = sample_at(t);
  }
  if (!(sample.slope >= 0.0)) return false;
  cast.translations = t;
  cast.pair = pair;
  cast.axis = cast.apart_axis = separating_axis(sample, t);
  return true;
}

}  // namespace sixdof::ray_cast
#endif
