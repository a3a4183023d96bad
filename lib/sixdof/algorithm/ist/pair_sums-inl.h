// Compiled once per instruction set: part of traversal.cpp. It has no include guard.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/traversal.h>

// Overlaps of pairs of spheres and their forces, in double precision. Products and sums are separate operations (no
// fused multiply-add), so all instruction sets round alike.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ist {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Sums over pairs of overlapping spheres, which are collected and then computed several at a time. Each of eight lanes
/// has its own sums, which are added at the end: the same bits on every instruction set.
class PairSums {
 public:
  PairSums(PairForce law, const Pose& X_AB, const Eigen::Vector3d& about) : law_(law), X_AB_(X_AB), about_(about) {}

  /// Adds the overlap of a sphere of A and one of B, each in its own frame, times `weight`. PairForce::cones also needs
  /// the axes of their normal cones, each in its own frame; zero: none.
  void add(const Sphere& a, const Sphere& b, double weight) {
    a_[filled_] = a;
    b_[filled_] = b;
    weight_[filled_] = weight;
    if (++filled_ == k_batch) flush();
  }
  void add(const Sphere& a, const Sphere& b, double weight, const Eigen::Vector3d& axis_a,
           const Eigen::Vector3d& axis_b) {
    axis_a_[filled_] = axis_a;
    axis_b_[filled_] = axis_b;
    add(a, b, weight);
  }

  void finish(PenetrationSum& sum) {
    while (filled_ % k_lanes != 0) {
      const std::size_t last = filled_ - 1;
      add(a_[last], b_[last], 0.0, axis_a_[last], axis_b_[last]);
    }
    flush();
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      sum.volume += total_[k_volume][lane];
      sum.second_moment += total_[k_second_moment][lane];
      for (std::size_t k = 0; k < 3; ++k) {
        sum.force[static_cast<Eigen::Index>(k)] += total_[k_force + k][lane];
        sum.moment[static_cast<Eigen::Index>(k)] += total_[k_moment + k][lane];
        sum.first_moment[static_cast<Eigen::Index>(k)] += total_[k_first_moment + k][lane];
      }
    }
  }

  /// Number of added pairs that overlap.
  std::uint64_t overlapping() const { return overlapping_; }

 private:
  static constexpr std::size_t k_lanes = 8;
  static constexpr std::size_t k_batch = 32;  ///< Pairs. Delays reading as vectors what was just written as scalars.
  using Lanes = hn::CappedTag<double, k_lanes>;
  enum Output : std::size_t {
    k_volume,
    k_force,
    k_moment = k_force + 3,
    k_first_moment = k_moment + 3,
    k_second_moment = k_first_moment + 3,
    k_outputs
  };

  void flush() {
    const Lanes d;
    for (std::size_t first = 0; first < filled_; first += hn::Lanes(d)) compute(first);
    filled_ = 0;
  }

  using Vector = hn::Vec<Lanes>;

  /// Pairs of spheres, one per SIMD lane; vectors in A's frame.
  struct Pairs {
    std::size_t first, sums;  ///< Index of the first, and where its sums stand in total_.
    Vector weight, r1, r2;
    Vector x, y, z;                             ///< From A's centre to B's,
    Vector ax, ay, az;                          ///< from about_ to B's centre.
    Vector squared, distance, sum, difference;  ///< Of the centres, their distance; of the radii.
    hn::Mask<Lanes> contained;                  ///< One sphere lies in the other.
    Vector volume;                              ///< Of the overlap, times the weight.
  };

  static HWY_INLINE Vector constant(double value) { return hn::Set(Lanes(), value); }

  /// Component k of R_AB v.
  HWY_INLINE Vector rotated(Eigen::Index k, Vector v_x, Vector v_y, Vector v_z) const {
    return hn::Add(hn::Add(hn::Mul(constant(X_AB_.R(k, 0)), v_x), hn::Mul(constant(X_AB_.R(k, 1)), v_y)),
                   hn::Mul(constant(X_AB_.R(k, 2)), v_z));
  }

  /// Distance from A's centre to the plane in which the spheres meet.
  static HWY_INLINE Vector plane(const Pairs& p) {
    return hn::Div(hn::Add(p.squared, hn::Mul(p.difference, p.sum)), hn::Mul(constant(2.0), p.distance));
  }

  HWY_INLINE void add_to(const Pairs& p, std::size_t i, Vector value) {
    const Lanes d;
    hn::Store(hn::Add(hn::Load(d, total_[i] + p.sums), value), d, total_[i] + p.sums);
  }

  HWY_INLINE void add_wrench(const Pairs& p, Vector fx, Vector fy, Vector fz, Vector mx, Vector my, Vector mz) {
    add_to(p, k_force, fx);
    add_to(p, k_force + 1, fy);
    add_to(p, k_force + 2, fz);
    add_to(p, k_moment, mx);
    add_to(p, k_moment + 1, my);
    add_to(p, k_moment + 2, mz);
  }

  /// Adds the pairs from `first` on. Volumes are those of overlap_volume().
  HWY_INLINE void compute(std::size_t first) {
    const Pairs p = pairs_from(first);
    const auto overlap = hn::And(hn::Lt(p.distance, p.sum), hn::Gt(p.weight, hn::Zero(Lanes())));
    overlapping_ += hn::CountTrue(Lanes(), overlap);
    add_to(p, k_volume, p.volume);
    if (law_ == PairForce::cones) {
      add_along_cones(p);
    } else {
      add_along_centres(p);
    }
  }

  HWY_INLINE Pairs pairs_from(std::size_t first) const {
    const Lanes d;
    constexpr double k_pi = std::numbers::pi;
    static_assert(sizeof(Sphere) == 4 * sizeof(double), "center x, y, z and radius");
    Pairs p;
    p.first = first;
    p.sums = first % k_lanes;
    p.weight = hn::LoadU(d, weight_ + first);
    Vector a_x, a_y, a_z, b_x, b_y, b_z;
    hn::LoadInterleaved4(d, &a_[first].center.x(), a_x, a_y, a_z, p.r1);
    hn::LoadInterleaved4(d, &b_[first].center.x(), b_x, b_y, b_z, p.r2);
    const auto p_x = hn::Add(rotated(0, b_x, b_y, b_z), constant(X_AB_.t[0])),
               p_y = hn::Add(rotated(1, b_x, b_y, b_z), constant(X_AB_.t[1])),
               p_z = hn::Add(rotated(2, b_x, b_y, b_z), constant(X_AB_.t[2]));
    p.x = hn::Sub(p_x, a_x);
    p.y = hn::Sub(p_y, a_y);
    p.z = hn::Sub(p_z, a_z);
    p.ax = hn::Sub(p_x, constant(about_.x()));
    p.ay = hn::Sub(p_y, constant(about_.y()));
    p.az = hn::Sub(p_z, constant(about_.z()));
    p.squared = hn::Add(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), hn::Mul(p.z, p.z));
    p.distance = hn::Sqrt(p.squared);
    p.sum = hn::Add(p.r1, p.r2);
    p.difference = hn::Sub(p.r1, p.r2);
    p.contained = hn::Le(p.distance, hn::Abs(p.difference));
    const auto smaller = hn::Min(p.r1, p.r2);
    const auto ball = hn::Mul(constant(4.0 / 3.0 * k_pi), hn::Mul(smaller, hn::Mul(smaller, smaller)));
    const auto depth = hn::Max(hn::Sub(p.sum, p.distance), hn::Zero(d));
    const auto shape = hn::Sub(hn::Add(p.squared, hn::Mul(constant(2.0), hn::Mul(p.distance, p.sum))),
                               hn::Mul(constant(3.0), hn::Mul(p.difference, p.difference)));
    const auto lens = hn::Div(hn::Mul(constant(k_pi / 12.0), hn::Mul(hn::Mul(depth, depth), shape)), p.distance);
    p.volume = hn::Mul(p.weight, hn::IfThenElse(p.contained, ball, lens));
    return p;
  }

  /// PairForce::cones.
  HWY_INLINE void add_along_cones(const Pairs& p) {
    const Lanes d;
    const auto zero = hn::Zero(d);
    Vector na_x, na_y, na_z, nb_x, nb_y, nb_z;
    hn::LoadInterleaved3(d, axis_a_[p.first].data(), na_x, na_y, na_z);
    hn::LoadInterleaved3(d, axis_b_[p.first].data(), nb_x, nb_y, nb_z);
    // Number of the two spheres that have an axis: 0, 1 or 2.
    const auto axes = hn::Add(hn::Add(hn::Add(hn::Mul(na_x, na_x), hn::Mul(na_y, na_y)), hn::Mul(na_z, na_z)),
                              hn::Add(hn::Add(hn::Mul(nb_x, nb_x), hn::Mul(nb_y, nb_y)), hn::Mul(nb_z, nb_z)));
    const auto none = hn::Lt(axes, constant(0.5)), both = hn::Gt(axes, constant(1.5));
    const auto along_axes = hn::IfThenElse(both, constant(0.5), constant(1.0));
    // Concentric spheres exert no force along the line of centres: it would have no direction.
    const auto along_line = hn::IfThenElse(hn::Gt(p.distance, zero), hn::Div(constant(1.0), p.distance), zero);
    const auto direction = [&](Eigen::Index k, Vector n_a, Vector line) HWY_ATTR {
      const auto n = hn::Sub(n_a, rotated(k, nb_x, nb_y, nb_z));
      return hn::IfThenElse(none, hn::Mul(along_line, line), hn::Mul(along_axes, n));
    };
    const auto u_x = direction(0, na_x, p.x), u_y = direction(1, na_y, p.y), u_z = direction(2, na_z, p.z);
    // The overlap's first moment about `about`. Its centre divides the line from A's centre to B's in the ratio of
    // the caps' volumes: (V_a p_a + V_b p_b) / (V_a + V_b), with V_a that of the cap of A's sphere.
    const auto height = hn::Max(hn::Sub(p.r1, plane(p)), zero);
    const auto cap = hn::Mul(constant(std::numbers::pi / 3.0),
                             hn::Mul(hn::Mul(height, height), hn::Sub(hn::Mul(constant(3.0), p.r1), height)));
    const auto of_a =
        hn::IfThenElse(p.contained, hn::IfThenElse(hn::Lt(p.r1, p.r2), p.volume, zero), hn::Mul(p.weight, cap));
    const auto mx = hn::Sub(hn::Mul(p.volume, p.ax), hn::Mul(of_a, p.x)),
               my = hn::Sub(hn::Mul(p.volume, p.ay), hn::Mul(of_a, p.y)),
               mz = hn::Sub(hn::Mul(p.volume, p.az), hn::Mul(of_a, p.z));
    add_wrench(p, hn::Mul(p.volume, u_x), hn::Mul(p.volume, u_y), hn::Mul(p.volume, u_z),
               hn::Sub(hn::Mul(my, u_z), hn::Mul(mz, u_y)), hn::Sub(hn::Mul(mz, u_x), hn::Mul(mx, u_z)),
               hn::Sub(hn::Mul(mx, u_y), hn::Mul(my, u_x)));
  }

  /// PairForce::volume and gradient.
  HWY_INLINE void add_along_centres(const Pairs& p) {
    const auto zero = hn::Zero(Lanes());
    const auto magnitude = law_ == PairForce::gradient ? gradient_and_moments(p) : p.volume;
    // Concentric spheres exert no force.
    const auto factor = hn::IfThenElse(hn::Gt(p.distance, zero), hn::Div(magnitude, p.distance), zero);
    const auto fx = hn::Mul(factor, p.x), fy = hn::Mul(factor, p.y), fz = hn::Mul(factor, p.z);
    // The force acts along the line of centres, so any point on it may be the end of the arm: here B's centre.
    add_wrench(p, fx, fy, fz, hn::Sub(hn::Mul(p.ay, fz), hn::Mul(p.az, fy)),
               hn::Sub(hn::Mul(p.az, fx), hn::Mul(p.ax, fz)), hn::Sub(hn::Mul(p.ax, fy), hn::Mul(p.ay, fx)));
  }

  /// Adds the overlaps' moments. @return the magnitude of their volumes' gradients
  HWY_INLINE Vector gradient_and_moments(const Pairs& p) {
    const auto zero = hn::Zero(Lanes()), to_plane = plane(p);
    const auto disc = hn::Max(hn::Sub(hn::Mul(p.r1, p.r1), hn::Mul(to_plane, to_plane)), zero);
    const auto crossing = hn::Mul(p.weight, hn::Mul(constant(std::numbers::pi), disc));
    // Middle of the overlap: centre of the disc, or of the sphere inside the other. It is B's centre plus `back`
    // times the vector (x, y, z) from A's centre to B's.
    const auto in_b = hn::IfThenElse(hn::Lt(p.r1, p.r2), constant(-1.0), zero);
    const auto back = hn::IfThenElse(p.contained, in_b, hn::Sub(hn::Div(to_plane, p.distance), constant(1.0)));
    const auto mx = hn::Add(p.ax, hn::Mul(back, p.x)), my = hn::Add(p.ay, hn::Mul(back, p.y)),
               mz = hn::Add(p.az, hn::Mul(back, p.z));
    add_to(p, k_first_moment, hn::Mul(p.volume, mx));
    add_to(p, k_first_moment + 1, hn::Mul(p.volume, my));
    add_to(p, k_first_moment + 2, hn::Mul(p.volume, mz));
    add_to(p, k_second_moment, hn::Mul(p.volume, hn::Add(hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)), hn::Mul(mz, mz))));
    return hn::IfThenElse(hn::Or(p.contained, hn::Ge(p.distance, p.sum)), zero, crossing);
  }

  PairForce law_;
  const Pose& X_AB_;
  Eigen::Vector3d about_;
  std::size_t filled_ = 0;
  std::uint64_t overlapping_ = 0;
  Sphere a_[k_batch], b_[k_batch];
  double weight_[k_batch];
  Eigen::Vector3d axis_a_[k_batch], axis_b_[k_batch];
  HWY_ALIGN double total_[k_outputs][k_lanes] = {};
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ist
HWY_AFTER_NAMESPACE();
