// Compiled once per instruction set: part of contact.cpp and point_tree.cpp. It has no include guard.

#include <hwy/highway.h>

#include <sixdof/algorithm/vps/point_tree.h>

// Products and sums are separate operations (no fused multiply-add), so all instruction sets round alike.

HWY_BEFORE_NAMESPACE();
namespace sixdof::vps {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, PointTree::k_leaf_points>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

constexpr Floats k_floats;
constexpr Ints k_ints;
constexpr Words k_words;

struct Vec3 {
  F x, y, z;
};

HWY_INLINE F splat(float value) { return hn::Set(k_floats, value); }
HWY_INLINE I splat_int(std::int32_t value) { return hn::Set(k_ints, value); }

HWY_INLINE F dot(const Vec3& a, const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vec3 scale(F s, const Vec3& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE Vec3 minus(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 plus(const Vec3& a, const Vec3& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }

struct Matrix {
  Vec3 row[3];
  explicit HWY_INLINE Matrix(const Eigen::Matrix3f& m)
      : row{{splat(m(0, 0)), splat(m(0, 1)), splat(m(0, 2))},
            {splat(m(1, 0)), splat(m(1, 1)), splat(m(1, 2))},
            {splat(m(2, 0)), splat(m(2, 1)), splat(m(2, 2))}} {}
  HWY_INLINE Vec3 operator*(const Vec3& v) const { return {dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
};

/// The voxels of points, one per lane. For a point outside the grid: the nearest voxel of the grid.
struct Cell {
  Vec3 low;   ///< Lowest corner, in voxel coordinates.
  I brick;    ///< Index into the table of bricks.
  I x, y, z;  ///< Coordinates inside the brick, 0 .. 7.
};

class GridLookup {
 public:
  explicit HWY_INLINE GridLookup(const VoxelGrid& grid)
      : last_{splat(static_cast<float>(grid.voxels().x() - 1)), splat(static_cast<float>(grid.voxels().y() - 1)),
              splat(static_cast<float>(grid.voxels().z() - 1))},
        row_(splat_int(grid.bricks.x())),
        slice_(splat_int(grid.bricks.x() * grid.bricks.y())) {}

  HWY_INLINE Cell cell(const Vec3& q) const {
    Cell c;
    const F zero = hn::Zero(k_floats);
    c.low = {hn::Min(hn::Max(hn::Floor(q.x), zero), last_.x), hn::Min(hn::Max(hn::Floor(q.y), zero), last_.y),
             hn::Min(hn::Max(hn::Floor(q.z), zero), last_.z)};
    const I x = hn::ConvertTo(k_ints, c.low.x), y = hn::ConvertTo(k_ints, c.low.y), z = hn::ConvertTo(k_ints, c.low.z);
    c.brick = hn::Add(hn::Add(hn::ShiftRight<3>(x), hn::Mul(hn::ShiftRight<3>(y), row_)),
                      hn::Mul(hn::ShiftRight<3>(z), slice_));
    const I seven = splat_int(VoxelGrid::k_edge - 1);
    c.x = hn::And(x, seven);
    c.y = hn::And(y, seven);
    c.z = hn::And(z, seven);
    return c;
  }

 private:
  Vec3 last_;
  I row_, slice_;
};

struct TransformLanes {
  Matrix scaled;
  Vec3 center;
  explicit HWY_INLINE TransformLanes(const VoxelTransform& transform)
      : scaled(transform.scaled),
        center{splat(transform.center.x()), splat(transform.center.y()), splat(transform.center.z())} {}
  HWY_INLINE Vec3 operator*(const Vec3& p) const { return plus(scaled * p, center); }
};

/// Layers of voxels, one per lane.
class LayerLookup {
 public:
  explicit LayerLookup(const VoxelMap& map)
      : table_(map.table.data()),
        words_(reinterpret_cast<const std::int32_t*>(map.words.data())),
        layer_bits_(map.layer_bits) {}

  /// Entries of VoxelMap::table: negative where a brick is not stored.
  HWY_INLINE I entries(const Cell& cell) const { return hn::GatherIndex(k_ints, table_, cell.brick); }

  /// Layers of the voxels; VoxelMap::min_layer() in bricks that are not stored.
  HWY_INLINE I layers(const Cell& cell, I entry) const {
    const I stored = hn::Max(entry, hn::Zero(k_ints));
    const I in_brick = hn::Or(hn::Or(cell.x, hn::ShiftLeft<3>(cell.y)), hn::ShiftLeft<6>(cell.z));
    const I index = hn::Or(hn::ShiftLeft<9>(stored), in_brick);
    if (layer_bits_ == 8) {
      const I word = hn::GatherIndex(k_ints, words_, hn::ShiftRight<2>(index));
      const I up = hn::Sub(splat_int(24), hn::ShiftLeft<3>(hn::And(index, splat_int(3))));
      return hn::ShiftRight<24>(hn::Shl(word, up));
    }
    const I word = hn::GatherIndex(k_ints, words_, hn::ShiftRight<1>(index));
    const I up = hn::Sub(splat_int(16), hn::ShiftLeft<4>(hn::And(index, splat_int(1))));
    return hn::ShiftRight<16>(hn::Shl(word, up));
  }

  /// Lower bound, in voxels, of the distance from the centre of a voxel outside to the nearest surface voxel's centre;
  /// 0 where v >= 0. The squares of such distances are integers d^2 >= (|v| - 1/2)^2, so d^2 >= v^2 - |v| + 1.
  HWY_INLINE F outside_distance(const Cell& cell) const {
    const I entry = entries(cell);
    const F v = hn::ConvertTo(k_floats, layers(cell, entry)), one = splat(1.0f), zero = hn::Zero(k_floats);
    const F from_layer = hn::Sqrt(hn::Add(hn::Add(hn::Mul(v, v), v), one));
    const F from_table = hn::Sub(hn::Neg(one), hn::ConvertTo(k_floats, entry));
    const auto is_stored = hn::RebindMask(k_floats, hn::Gt(entry, splat_int(-1)));
    return hn::IfThenElse(is_stored, hn::IfThenElse(hn::Lt(v, zero), from_layer, zero), from_table);
  }

 private:
  const std::int32_t* table_;
  const std::int32_t* words_;
  int layer_bits_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::vps
HWY_AFTER_NAMESPACE();
