// The inner loops over points, compiled once per instruction set and chosen at run time. Products and sums are separate
// operations (no fused multiply-add), so all sets round alike.
// Vectors are kept in structures here, which sets of unknown vector length (SVE, RVV) do not allow; NEON serves them.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/vps/contact.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <algorithm>

#include <hwy/highway.h>

#include <sixdof/algorithm/vps/contact.h>
#include <sixdof/algorithm/vps/lookup-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::vps {
namespace HWY_NAMESPACE {

/// Rows of a leaf, from the given lane on.
struct PointLanes {
  const float* at;
  HWY_INLINE F row(std::size_t r) const { return hn::LoadU(k_floats, at + r * PointTree::k_leaf_points); }
  HWY_INLINE Vec3 position() const { return {row(0), row(1), row(2)}; }
  HWY_INLINE F weight() const { return row(3); }
  HWY_INLINE Vec3 normal() const { return {row(4), row(5), row(6)}; }
};

/// Sums of some lanes over a batch of leaves, in registers.
struct LaneSums {
  Vec3 force, torque;
  F contacts, depth;

  HWY_INLINE void add(const Vec3& f, const Vec3& t, F contact, F d) {
    force = plus(force, f);
    torque = plus(torque, t);
    contacts = hn::Add(contacts, contact);
    depth = hn::Max(depth, d);
  }
};

/// Eight lanes of sums of double precision, of batches of single precision.
class Accumulator {
 public:
  static constexpr std::size_t k_sums = 7;  ///< force, torque, contacts
  static constexpr std::size_t k_lanes = PointTree::k_leaf_points;

  /// Adds a batch's sums of the lanes from `lane` on.
  HWY_INLINE void add(std::size_t lane, const LaneSums& sums) {
    if (hn::AllFalse(k_floats, hn::Gt(sums.contacts, hn::Zero(k_floats)))) return;
    HWY_ALIGN float batch[k_sums][k_lanes];
    const F rows[k_sums] = {sums.force.x,  sums.force.y,  sums.force.z, sums.torque.x,
                            sums.torque.y, sums.torque.z, sums.contacts};
    for (std::size_t s = 0; s < k_sums; ++s) {
      hn::Store(rows[s], k_floats, batch[s]);
      for (std::size_t l = 0; l < hn::Lanes(k_floats); ++l) total_[s][lane + l] += static_cast<double>(batch[s][l]);
    }
    hn::Store(hn::Max(hn::Load(k_floats, depth_ + lane), sums.depth), k_floats, depth_ + lane);
  }

  ContactSums finish() const {
    double sum[k_sums] = {};
    ContactSums result;
    for (std::size_t s = 0; s < k_sums; ++s) {
      for (const double lane : total_[s]) sum[s] += lane;
    }
    for (const float depth : depth_) result.depth = std::max(result.depth, static_cast<double>(depth));
    result.force = {sum[0], sum[1], sum[2]};
    result.torque = {sum[3], sum[4], sum[5]};
    result.contacts = sum[6];
    return result;
  }

 private:
  HWY_ALIGN float depth_[k_lanes] = {};
  HWY_ALIGN double total_[k_sums][k_lanes] = {};
};

class LayerLoop {
 public:
  LayerLoop(const VoxelMap& map, const Placement& placement)
      : lookup_(map.grid),
        scaled_(placement.scaled),
        rotation_(placement.rotation),
        offset_{splat(placement.center.x()), splat(placement.center.y()), splat(placement.center.z())},
        layers_(map) {}

  template <bool k_local>
  HWY_INLINE void add(const PointLanes& points, LaneSums& sums) const {
    const Vec3 p = points.position();
    const Vec3 q = transform(scaled_, offset_, p);
    const Cell cell = lookup_.cell(q);
    const I layer = layers_.layers(cell, layers_.entries(cell));
    const auto hit_int = hn::Gt(layer, splat_int(-1));
    if (hn::AllFalse(k_ints, hit_int)) return;
    const F w = points.weight();
    const F zero = hn::Zero(k_floats);
    const auto hit = hn::And(hn::RebindMask(k_floats, hit_int), hn::Gt(w, zero));
    const Vec3 n = points.normal();
    F depth = hn::ConvertTo(k_floats, layer);
    if constexpr (k_local) {
      const F half = splat(0.5f);
      const Vec3 center{hn::Add(cell.low.x, half), hn::Add(cell.low.y, half), hn::Add(cell.low.z, half)};
      depth = hn::Max(hn::Add(depth, dot(rotation_ * n, minus(center, q))), zero);
    }
    depth = hn::IfThenElseZero(hit, depth);
    const F push = hn::Mul(w, depth);
    sums.add(scale(push, n), scale(push, cross(p, n)), hn::IfThenElseZero(hit, splat(1.0f)), depth);
  }

  HWY_INLINE bool hits(const PointLanes& points) const {
    const Cell cell = lookup_.cell(transform(scaled_, offset_, points.position()));
    const I layer = layers_.layers(cell, layers_.entries(cell));
    return !hn::AllFalse(k_ints, hn::Gt(layer, splat_int(-1)));
  }

 private:
  GridLookup lookup_;
  Matrix scaled_, rotation_;
  Vec3 offset_;
  LayerLookup layers_;
};

class FieldLoop {
 public:
  FieldLoop(const DistanceField& field, const Placement& placement)
      : lookup_(field.grid),
        scaled_(placement.scaled),
        offset_{splat(placement.center.x()), splat(placement.center.y()), splat(placement.center.z())},
        table_(field.table.data()),
        samples_(field.samples.data()) {}

  HWY_INLINE void add(const PointLanes& points, LaneSums& sums) const {
    const Vec3 arm = scaled_ * points.position();
    Value value;
    if (!evaluate(plus(arm, offset_), value)) return;
    const F w = points.weight();
    const F zero = hn::Zero(k_floats);
    const auto hit = hn::And(hn::Lt(value.distance, zero), hn::Gt(w, zero));
    const F depth = hn::IfThenElseZero(hit, hn::Neg(value.distance));
    const Vec3 push = scale(hn::Mul(w, depth), value.gradient);
    sums.add(push, cross(arm, push), hn::IfThenElseZero(hit, splat(1.0f)), depth);
  }

  HWY_INLINE bool hits(const PointLanes& points) const {
    Value value;
    return evaluate(transform(scaled_, offset_, points.position()), value) &&
           !hn::AllFalse(k_floats, hn::Lt(value.distance, hn::Zero(k_floats)));
  }

 private:
  struct Value {
    F distance;
    Vec3 gradient;
  };

  /// Is the nearest sample, at the voxel's centre, so large that the field is positive? See DistanceField::k_reach.
  HWY_INLINE hn::Mask<Ints> is_far(const Vec3& q, const Cell& cell, I first) const {
    constexpr int k = DistanceField::k_samples;
    constexpr float k_rounding = 1e-3f;  // of coordinates below 2^12 in single precision
    const F zero = hn::Zero(k_floats), one = splat(1.0f), half = splat(0.5f);
    const auto off_center = [&](F coordinate, F low) HWY_ATTR {
      return hn::Sub(hn::Min(hn::Max(hn::Sub(coordinate, low), zero), one), half);
    };
    const Vec3 off{off_center(q.x, cell.low.x), off_center(q.y, cell.low.y), off_center(q.z, cell.low.z)};
    const F sample = hn::GatherIndex(k_floats, samples_, hn::Add(first, splat_int(1 + k + k * k)));
    const F reach = splat(static_cast<float>(DistanceField::k_reach) + k_rounding);
    return hn::RebindMask(k_ints, hn::Gt(hn::Sub(sample, hn::Sqrt(dot(off, off))), reach));
  }

  /// Weights and slopes of a quadratic B-spline about the nearest sample, which is the voxel's centre.
  struct Spline {
    F weight[3], slope[3];
    /// A coordinate beyond the grid counts as on its border, where the field is positive.
    HWY_INLINE Spline(F q, F low) {
      const F half = splat(0.5f);
      const F from_low = hn::Min(hn::Max(hn::Sub(q, low), hn::Zero(k_floats)), splat(1.0f));
      const F u = hn::Sub(from_low, half), below = hn::Sub(half, u), above = hn::Add(half, u);
      weight[0] = hn::Mul(half, hn::Mul(below, below));
      weight[1] = hn::Sub(splat(0.75f), hn::Mul(u, u));
      weight[2] = hn::Mul(half, hn::Mul(above, above));
      slope[0] = hn::Neg(below);
      slope[1] = hn::Mul(splat(-2.0f), u);
      slope[2] = above;
    }
  };

  /// The splines of all lanes, laid out to be read lane by lane.
  struct SplineTable {
    static constexpr std::size_t k_values = 6;
    alignas(64) float value[3 * k_values * PointTree::k_leaf_points];
    HWY_INLINE void set(std::size_t axis, const Spline& spline) {
      for (std::size_t i = 0; i < 3; ++i) {
        hn::Store(spline.weight[i], k_floats, value + (axis * k_values + i) * PointTree::k_leaf_points);
        hn::Store(spline.slope[i], k_floats, value + (axis * k_values + 3 + i) * PointTree::k_leaf_points);
      }
    }
    HWY_INLINE float weight(std::size_t axis, std::size_t i, std::size_t lane) const {
      return value[(axis * k_values + i) * PointTree::k_leaf_points + lane];
    }
    HWY_INLINE float slope(std::size_t axis, std::size_t i, std::size_t lane) const {
      return weight(axis, 3 + i, lane);
    }
  };

  /// False if the field is surely positive in all lanes; else the field and its gradient, 1 and 0 in the lanes where it
  /// surely is. Each lane reads 9 rows of samples, four floats at a time of which three count: that is faster than
  /// gathering 27 samples in all lanes at once.
  HWY_INLINE bool evaluate(const Vec3& q, Value& result) const {
    constexpr int k = DistanceField::k_samples;
    constexpr std::size_t k_lanes = PointTree::k_leaf_points, k_columns = 4;
    const Cell cell = lookup_.cell(q);
    const I brick = hn::GatherIndex(k_ints, table_, cell.brick), none = hn::Zero(k_ints);
    const I place = hn::Add(cell.x, hn::Add(hn::Mul(cell.y, splat_int(k)), hn::Mul(cell.z, splat_int(k * k))));
    const I at = hn::Add(hn::Mul(brick, splat_int(DistanceField::k_brick_samples)), place);
    const auto positive = hn::Or(hn::Eq(brick, none), is_far(q, cell, at));
    if (hn::AllTrue(k_ints, positive)) return false;
    const I first = hn::IfThenElse(positive, none, at);
    alignas(64) std::int32_t start[k_lanes];
    hn::Store(first, k_ints, start);
    SplineTable table;
    table.set(0, Spline(q.x, cell.low.x));
    table.set(1, Spline(q.y, cell.low.y));
    table.set(2, Spline(q.z, cell.low.z));
    alignas(64) float out[4][k_lanes];
    for (std::size_t lane = 0; lane < hn::Lanes(k_floats); ++lane) {
      if (start[lane] == 0) {  // brick 0
        out[0][lane] = 1.0f;
        out[1][lane] = out[2][lane] = out[3][lane] = 0.0f;
        continue;
      }
      // Four columns of the rows: along x the samples stay apart until the end.
      constexpr hn::CappedTag<float, k_columns> columns;
      alignas(16) float v[k_columns], vy[k_columns], vz[k_columns];
      for (std::size_t column = 0; column < k_columns; column += hn::Lanes(columns)) {
        auto value = hn::Zero(columns), along_y = value, along_z = value;
        for (std::size_t z = 0; z < 3; ++z) {
          auto line = hn::Zero(columns), line_y = line;
          for (std::size_t y = 0; y < 3; ++y) {
            const auto row = hn::LoadU(columns, samples_ + static_cast<std::size_t>(start[lane]) + column +
                                                    static_cast<std::size_t>(k) * (k * z + y));
            line = hn::Add(line, hn::Mul(hn::Set(columns, table.weight(1, y, lane)), row));
            line_y = hn::Add(line_y, hn::Mul(hn::Set(columns, table.slope(1, y, lane)), row));
          }
          const auto weight = hn::Set(columns, table.weight(2, z, lane));
          const auto slope = hn::Set(columns, table.slope(2, z, lane));
          value = hn::Add(value, hn::Mul(weight, line));
          along_y = hn::Add(along_y, hn::Mul(weight, line_y));
          along_z = hn::Add(along_z, hn::Mul(slope, line));
        }
        hn::Store(value, columns, v + column);
        hn::Store(along_y, columns, vy + column);
        hn::Store(along_z, columns, vz + column);
      }
      const float w0 = table.weight(0, 0, lane), w1 = table.weight(0, 1, lane), w2 = table.weight(0, 2, lane);
      out[0][lane] = w0 * v[0] + w1 * v[1] + w2 * v[2];
      out[1][lane] = table.slope(0, 0, lane) * v[0] + table.slope(0, 1, lane) * v[1] + table.slope(0, 2, lane) * v[2];
      out[2][lane] = w0 * vy[0] + w1 * vy[1] + w2 * vy[2];
      out[3][lane] = w0 * vz[0] + w1 * vz[1] + w2 * vz[2];
    }
    result = {hn::Load(k_floats, out[0]),
              {hn::Load(k_floats, out[1]), hn::Load(k_floats, out[2]), hn::Load(k_floats, out[3])}};
    return true;
  }

  GridLookup lookup_;
  Matrix scaled_;
  Vec3 offset_;
  const std::int32_t* table_;
  const float* samples_;
};

HWY_INLINE PointLanes lanes_of(const PointTree& tree, std::uint32_t leaf, std::size_t lane) {
  return {tree.blocks() + leaf * PointTree::k_rows * PointTree::k_leaf_points + lane};
}

/// Calls add(lanes, sums) for all points of the leaves.
template <class Add>
HWY_INLINE ContactSums sum_leaves(const PointTree& tree, std::span<const std::uint32_t> leaves, const Add& add) {
  Accumulator sums;
  const F zero = hn::Zero(k_floats);
  for (std::size_t begin = 0, end = 0; begin < leaves.size(); begin = end) {
    const std::uint32_t batch = leaves[begin] / k_batch_leaves;
    while (end < leaves.size() && leaves[end] / k_batch_leaves == batch) ++end;
    for (std::size_t lane = 0; lane < PointTree::k_leaf_points; lane += hn::Lanes(k_floats)) {
      LaneSums lanes{{zero, zero, zero}, {zero, zero, zero}, zero, zero};
      for (std::size_t i = begin; i < end; ++i) add(lanes_of(tree, leaves[i], lane), lanes);
      sums.add(lane, lanes);
    }
  }
  return sums.finish();
}

/// Does hits(lanes) hold for some points of the leaves?
template <class Hits>
HWY_INLINE bool any_point(const PointTree& tree, std::span<const std::uint32_t> leaves, const Hits& hits) {
  for (const std::uint32_t leaf : leaves) {
    for (std::size_t lane = 0; lane < PointTree::k_leaf_points; lane += hn::Lanes(k_floats)) {
      if (hits(lanes_of(tree, leaf, lane))) return true;
    }
  }
  return false;
}

ContactSums sum_layers_simd(const VoxelMap& map, const PointTree& tree, const Placement& placement, LayerDepth depth,
                            std::span<const std::uint32_t> leaves) {
  const LayerLoop loop(map, placement);
  if (depth == LayerDepth::layers) {
    return sum_leaves(tree, leaves, [&](PointLanes points, LaneSums& sums) HWY_ATTR { loop.add<false>(points, sums); });
  }
  return sum_leaves(tree, leaves, [&](PointLanes points, LaneSums& sums) HWY_ATTR { loop.add<true>(points, sums); });
}

bool touches_layers_simd(const VoxelMap& map, const PointTree& tree, const Placement& placement,
                         std::span<const std::uint32_t> leaves) {
  const LayerLoop loop(map, placement);
  return any_point(tree, leaves, [&](PointLanes points) HWY_ATTR { return loop.hits(points); });
}

ContactSums sum_field_simd(const DistanceField& field, const PointTree& tree, const Placement& placement,
                           std::span<const std::uint32_t> leaves) {
  const FieldLoop loop(field, placement);
  return sum_leaves(tree, leaves, [&](PointLanes points, LaneSums& sums) HWY_ATTR { loop.add(points, sums); });
}

bool touches_field_simd(const DistanceField& field, const PointTree& tree, const Placement& placement,
                        std::span<const std::uint32_t> leaves) {
  const FieldLoop loop(field, placement);
  return any_point(tree, leaves, [&](PointLanes points) HWY_ATTR { return loop.hits(points); });
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::vps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::vps {

HWY_EXPORT(sum_layers_simd);
HWY_EXPORT(touches_layers_simd);
HWY_EXPORT(sum_field_simd);
HWY_EXPORT(touches_field_simd);

ContactSums sum_layers(const VoxelMap& map, const PointTree& tree, const Placement& placement, LayerDepth depth,
                       std::span<const std::uint32_t> leaves) {
  return HWY_DYNAMIC_DISPATCH(sum_layers_simd)(map, tree, placement, depth, leaves);
}

bool touches_layers(const VoxelMap& map, const PointTree& tree, const Placement& placement,
                    std::span<const std::uint32_t> leaves) {
  return HWY_DYNAMIC_DISPATCH(touches_layers_simd)(map, tree, placement, leaves);
}

ContactSums sum_field(const DistanceField& field, const PointTree& tree, const Placement& placement,
                      std::span<const std::uint32_t> leaves) {
  return HWY_DYNAMIC_DISPATCH(sum_field_simd)(field, tree, placement, leaves);
}

bool touches_field(const DistanceField& field, const PointTree& tree, const Placement& placement,
                   std::span<const std::uint32_t> leaves) {
  return HWY_DYNAMIC_DISPATCH(touches_field_simd)(field, tree, placement, leaves);
}

}  // namespace sixdof::vps
#endif  // HWY_ONCE
