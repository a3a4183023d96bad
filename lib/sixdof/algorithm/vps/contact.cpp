#include <sixdof/algorithm/vps/contact.h>

#include <algorithm>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/vps/contact.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/vps/lookup-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::vps {
namespace HWY_NAMESPACE {

/// Points of a leaf, one per SIMD lane.
struct PointLanes {
  const float* first;  ///< Row 0 of the first of them in PointTree::blocks().
  HWY_INLINE F row(std::size_t r) const { return hn::LoadU(k_floats, first + r * PointTree::k_leaf_points); }
  HWY_INLINE Vec3 position() const { return {row(0), row(1), row(2)}; }
  HWY_INLINE F weight() const { return row(3); }
  HWY_INLINE Vec3 normal() const { return {row(4), row(5), row(6)}; }
};

/// Sums over a batch of leaves, one per SIMD lane, in registers.
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

/// Sums over batches in double precision, one for each of the eight points of a leaf; see ContactSums.
class Accumulator {
 public:
  static constexpr std::size_t k_sums = 7;  ///< force, torque, contacts
  static constexpr std::size_t k_lanes = PointTree::k_leaf_points;

  /// Adds a batch's sums, which belong to the points from `lane` on.
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

/// Contact of points with a voxelmap. @tparam k_local LayerDepth::layers_and_local
template <bool k_local>
class LayerContact {
 public:
  LayerContact(const VoxelMap& map, const VoxelTransform& transform)
      : lookup_(map.grid), transform_(transform), rotation_(transform.rotation), layers_(map) {}

  HWY_INLINE void add(const PointLanes& points, LaneSums& sums) const {
    const Vec3 p = points.position();
    const Vec3 q = transform_ * p;
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
    const F magnitude = hn::Mul(w, depth);
    sums.add(scale(magnitude, n), scale(magnitude, cross(p, n)), hn::IfThenElseZero(hit, splat(1.0f)), depth);
  }

  HWY_INLINE bool touches(const PointLanes& points) const {
    const Cell cell = lookup_.cell(transform_ * points.position());
    const I layer = layers_.layers(cell, layers_.entries(cell));
    return !hn::AllFalse(k_ints, hn::Gt(layer, splat_int(-1)));
  }

 private:
  GridLookup lookup_;
  TransformLanes transform_;
  Matrix rotation_;
  LayerLookup layers_;
};

/// Contact of points with a distance field.
class FieldContact {
 public:
  FieldContact(const DistanceField& field, const VoxelTransform& transform)
      : lookup_(field.grid),
        transform_(transform),
        table_(field.table.data()),
        coefficients_(field.coefficients.data()) {}

  HWY_INLINE void add(const PointLanes& points, LaneSums& sums) const {
    const Vec3 arm = transform_.scaled * points.position();
    Value value;
    if (!evaluate(plus(arm, transform_.center), value)) return;
    const F w = points.weight();
    const F zero = hn::Zero(k_floats);
    const auto hit = hn::And(hn::Lt(value.distance, zero), hn::Gt(w, zero));
    const F depth = hn::IfThenElseZero(hit, hn::Neg(value.distance));
    const Vec3 force = scale(hn::Mul(w, depth), value.gradient);
    sums.add(force, cross(arm, force), hn::IfThenElseZero(hit, splat(1.0f)), depth);
  }

  HWY_INLINE bool touches(const PointLanes& points) const {
    Value value;
    return evaluate(transform_ * points.position(), value) &&
           !hn::AllFalse(k_floats, hn::Lt(value.distance, hn::Zero(k_floats)));
  }

 private:
  struct Value {
    F distance;
    Vec3 gradient;
  };

  /// Is the coefficient at the voxel's centre so large that the field is positive? See DistanceField::k_reach.
  HWY_INLINE hn::Mask<Ints> is_far(const Vec3& q, const Cell& cell, I first) const {
    constexpr int k = DistanceField::k_brick_edge;
    constexpr float k_rounding = 1e-3f;  // of coordinates below 2^12 in single precision
    const F zero = hn::Zero(k_floats), one = splat(1.0f), half = splat(0.5f);
    const auto off_center = [&](F coordinate, F low) HWY_ATTR {
      return hn::Sub(hn::Min(hn::Max(hn::Sub(coordinate, low), zero), one), half);
    };
    const Vec3 off{off_center(q.x, cell.low.x), off_center(q.y, cell.low.y), off_center(q.z, cell.low.z)};
    const F coefficient = hn::GatherIndex(k_floats, coefficients_, hn::Add(first, splat_int(1 + k + k * k)));
    const F reach = splat(static_cast<float>(DistanceField::k_reach) + k_rounding);
    return hn::RebindMask(k_ints, hn::Gt(hn::Sub(coefficient, hn::Sqrt(dot(off, off))), reach));
  }

  /// Weights of the three coefficients along one axis and their derivatives: a quadratic B-spline about the voxel's
  /// centre. A coordinate outside the grid is projected to its border, where the field is positive.
  struct Spline {
    F weight[3], slope[3];
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

  /// The splines along all axes, to be read lane by lane.
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

  /// The field and its gradient. Returns false if the field is known to be positive in all lanes; in single lanes where
  /// it is, the field is set to 1 and the gradient to 0.
  ///
  /// Each lane reads 9 rows of four coefficients, which is faster than gathering 27 in all lanes at once.
  HWY_INLINE bool evaluate(const Vec3& q, Value& result) const {
    constexpr int k = DistanceField::k_brick_edge;
    constexpr std::size_t k_lanes = PointTree::k_leaf_points, k_columns = 4;
    const Cell cell = lookup_.cell(q);
    const I brick = hn::GatherIndex(k_ints, table_, cell.brick), none = hn::Zero(k_ints);
    const I in_brick = hn::Add(cell.x, hn::Add(hn::Mul(cell.y, splat_int(k)), hn::Mul(cell.z, splat_int(k * k))));
    const I index = hn::Add(hn::Mul(brick, splat_int(DistanceField::k_brick_coefficients)), in_brick);
    const auto positive = hn::Or(hn::Eq(brick, none), is_far(q, cell, index));
    if (hn::AllTrue(k_ints, positive)) return false;
    const I first = hn::IfThenElse(positive, none, index);
    alignas(64) std::int32_t start[k_lanes];
    hn::Store(first, k_ints, start);
    SplineTable table;
    table.set(0, Spline(q.x, cell.low.x));
    table.set(1, Spline(q.y, cell.low.y));
    table.set(2, Spline(q.z, cell.low.z));
    alignas(64) float out[4][k_lanes];
    for (std::size_t lane = 0; lane < hn::Lanes(k_floats); ++lane) {
      if (start[lane] == 0) {
        out[0][lane] = 1.0f;
        out[1][lane] = out[2][lane] = out[3][lane] = 0.0f;
        continue;
      }
      // Sums over y, then over z, for each column along x; the columns are summed last.
      constexpr hn::CappedTag<float, k_columns> columns;
      alignas(16) float v[k_columns], v_dy[k_columns], v_dz[k_columns];
      for (std::size_t column = 0; column < k_columns; column += hn::Lanes(columns)) {
        auto value = hn::Zero(columns), value_dy = value, value_dz = value;
        for (std::size_t z = 0; z < 3; ++z) {
          auto sum_y = hn::Zero(columns), sum_dy = sum_y;
          for (std::size_t y = 0; y < 3; ++y) {
            const auto row = hn::LoadU(columns, coefficients_ + static_cast<std::size_t>(start[lane]) + column +
                                                    static_cast<std::size_t>(k) * (k * z + y));
            sum_y = hn::Add(sum_y, hn::Mul(hn::Set(columns, table.weight(1, y, lane)), row));
            sum_dy = hn::Add(sum_dy, hn::Mul(hn::Set(columns, table.slope(1, y, lane)), row));
          }
          const auto weight = hn::Set(columns, table.weight(2, z, lane));
          const auto slope = hn::Set(columns, table.slope(2, z, lane));
          value = hn::Add(value, hn::Mul(weight, sum_y));
          value_dy = hn::Add(value_dy, hn::Mul(weight, sum_dy));
          value_dz = hn::Add(value_dz, hn::Mul(slope, sum_y));
        }
        hn::Store(value, columns, v + column);
        hn::Store(value_dy, columns, v_dy + column);
        hn::Store(value_dz, columns, v_dz + column);
      }
      const float w0 = table.weight(0, 0, lane), w1 = table.weight(0, 1, lane), w2 = table.weight(0, 2, lane);
      out[0][lane] = w0 * v[0] + w1 * v[1] + w2 * v[2];
      out[1][lane] = table.slope(0, 0, lane) * v[0] + table.slope(0, 1, lane) * v[1] + table.slope(0, 2, lane) * v[2];
      out[2][lane] = w0 * v_dy[0] + w1 * v_dy[1] + w2 * v_dy[2];
      out[3][lane] = w0 * v_dz[0] + w1 * v_dz[1] + w2 * v_dz[2];
    }
    result = {hn::Load(k_floats, out[0]),
              {hn::Load(k_floats, out[1]), hn::Load(k_floats, out[2]), hn::Load(k_floats, out[3])}};
    return true;
  }

  GridLookup lookup_;
  TransformLanes transform_;
  const std::int32_t* table_;
  const float* coefficients_;
};

HWY_INLINE PointLanes lanes_of(const PointTree& tree, std::uint32_t leaf, std::size_t lane) {
  return {tree.blocks() + leaf * PointTree::k_rows * PointTree::k_leaf_points + lane};
}

template <class Contact>
HWY_INLINE ContactSums sum_leaves(const PosedLeaves points, const Contact& contact) {
  Accumulator sums;
  const F zero = hn::Zero(k_floats);
  const std::span<const std::uint32_t> leaves = points.leaves;
  for (std::size_t begin = 0, end = 0; begin < leaves.size(); begin = end) {
    const std::uint32_t batch = leaves[begin] / k_batch_leaves;
    while (end < leaves.size() && leaves[end] / k_batch_leaves == batch) ++end;
    for (std::size_t lane = 0; lane < PointTree::k_leaf_points; lane += hn::Lanes(k_floats)) {
      LaneSums lanes{{zero, zero, zero}, {zero, zero, zero}, zero, zero};
      for (std::size_t i = begin; i < end; ++i) contact.add(lanes_of(points.tree, leaves[i], lane), lanes);
      sums.add(lane, lanes);
    }
  }
  return sums.finish();
}

template <class Contact>
HWY_INLINE bool any_touches(const PosedLeaves points, const Contact& contact) {
  for (const std::uint32_t leaf : points.leaves) {
    for (std::size_t lane = 0; lane < PointTree::k_leaf_points; lane += hn::Lanes(k_floats)) {
      if (contact.touches(lanes_of(points.tree, leaf, lane))) return true;
    }
  }
  return false;
}

ContactSums sum_layers(const VoxelMap& map, const PosedLeaves& points, LayerDepth depth) {
  if (depth == LayerDepth::layers) return sum_leaves(points, LayerContact<false>(map, points.transform));
  return sum_leaves(points, LayerContact<true>(map, points.transform));
}

bool touches_layers(const VoxelMap& map, const PosedLeaves& points) {
  return any_touches(points, LayerContact<false>(map, points.transform));
}

ContactSums sum_field(const DistanceField& field, const PosedLeaves& points) {
  return sum_leaves(points, FieldContact(field, points.transform));
}

bool touches_field(const DistanceField& field, const PosedLeaves& points) {
  return any_touches(points, FieldContact(field, points.transform));
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::vps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::vps {

HWY_EXPORT(sum_layers);
HWY_EXPORT(touches_layers);
HWY_EXPORT(sum_field);
HWY_EXPORT(touches_field);

ContactSums sum_layers(const VoxelMap& map, const PosedLeaves& points, LayerDepth depth) {
  return HWY_DYNAMIC_DISPATCH(sum_layers)(map, points, depth);
}

bool touches_layers(const VoxelMap& map, const PosedLeaves& points) {
  return HWY_DYNAMIC_DISPATCH(touches_layers)(map, points);
}

ContactSums sum_field(const DistanceField& field, const PosedLeaves& points) {
  return HWY_DYNAMIC_DISPATCH(sum_field)(field, points);
}

bool touches_field(const DistanceField& field, const PosedLeaves& points) {
  return HWY_DYNAMIC_DISPATCH(touches_field)(field, points);
}

}  // namespace sixdof::vps
#endif  // HWY_ONCE
