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

  /// Adds the pairs from `first` on, one per SIMD lane. Volumes are those of overlap_volume().
  HWY_INLINE void compute(std::size_t first) {
    const Lanes d;
    const std::size_t sums = first % k_lanes;
    const auto constant = [&](double value) HWY_ATTR { return hn::Set(d, value); };
    constexpr double k_pi = std::numbers::pi;
    const auto zero = hn::Zero(d), weight = hn::LoadU(d, weight_ + first);
    static_assert(sizeof(Sphere) == 4 * sizeof(double), "center x, y, z and radius");
    hn::Vec<Lanes> a_x, a_y, a_z, r1, b_x, b_y, b_z, r2;
    hn::LoadInterleaved4(d, &a_[first].center.x(), a_x, a_y, a_z, r1);
    hn::LoadInterleaved4(d, &b_[first].center.x(), b_x, b_y, b_z, r2);
    const auto rotated = [&](Eigen::Index k, auto v_x, auto v_y, auto v_z) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(constant(X_AB_.R(k, 0)), v_x), hn::Mul(constant(X_AB_.R(k, 1)), v_y)),
                     hn::Mul(constant(X_AB_.R(k, 2)), v_z));
    };
    const auto p_x = hn::Add(rotated(0, b_x, b_y, b_z), constant(X_AB_.t[0])),
               p_y = hn::Add(rotated(1, b_x, b_y, b_z), constant(X_AB_.t[1])),
               p_z = hn::Add(rotated(2, b_x, b_y, b_z), constant(X_AB_.t[2]));
    const auto x = hn::Sub(p_x, a_x), y = hn::Sub(p_y, a_y), z = hn::Sub(p_z, a_z);
    const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto distance = hn::Sqrt(squared), sum = hn::Add(r1, r2), difference = hn::Sub(r1, r2);
    const auto contained = hn::Le(distance, hn::Abs(difference));
    const auto smaller = hn::Min(r1, r2);
    const auto ball = hn::Mul(constant(4.0 / 3.0 * k_pi), hn::Mul(smaller, hn::Mul(smaller, smaller)));
    const auto depth = hn::Max(hn::Sub(sum, distance), zero);
    const auto shape = hn::Sub(hn::Add(squared, hn::Mul(constant(2.0), hn::Mul(distance, sum))),
                               hn::Mul(constant(3.0), hn::Mul(difference, difference)));
    const auto lens = hn::Div(hn::Mul(constant(k_pi / 12.0), hn::Mul(hn::Mul(depth, depth), shape)), distance);
    const auto volume = hn::Mul(weight, hn::IfThenElse(contained, ball, lens));
    const auto ax = hn::Sub(p_x, constant(about_.x())), ay = hn::Sub(p_y, constant(about_.y())),
               az = hn::Sub(p_z, constant(about_.z()));
    const auto add_to = [&](std::size_t i, auto value)
                            HWY_ATTR { hn::Store(hn::Add(hn::Load(d, total_[i] + sums), value), d, total_[i] + sums); };
    const auto overlap = hn::And(hn::Lt(distance, sum), hn::Gt(weight, zero));
    overlapping_ += hn::CountTrue(d, overlap);
    add_to(k_volume, volume);
    const auto add_wrench = [&](auto fx, auto fy, auto fz, auto mx, auto my, auto mz) HWY_ATTR {
      add_to(k_force, fx);
      add_to(k_force + 1, fy);
      add_to(k_force + 2, fz);
      add_to(k_moment, mx);
      add_to(k_moment + 1, my);
      add_to(k_moment + 2, mz);
    };
    // Distance from A's centre to the plane in which the spheres meet.
    const auto plane = [&]() HWY_ATTR {
      return hn::Div(hn::Add(squared, hn::Mul(difference, sum)), hn::Mul(constant(2.0), distance));
    };
    // Concentric spheres exert no force along the line of centres: it would have no direction.
    const auto apart = hn::Gt(distance, zero);
    if (law_ == PairForce::cones) {
      hn::Vec<Lanes> na_x, na_y, na_z, nb_x, nb_y, nb_z;
      hn::LoadInterleaved3(d, axis_a_[first].data(), na_x, na_y, na_z);
      hn::LoadInterleaved3(d, axis_b_[first].data(), nb_x, nb_y, nb_z);
      // Number of the two spheres that have an axis: 0, 1 or 2.
      const auto axes = hn::Add(hn::Add(hn::Add(hn::Mul(na_x, na_x), hn::Mul(na_y, na_y)), hn::Mul(na_z, na_z)),
                                hn::Add(hn::Add(hn::Mul(nb_x, nb_x), hn::Mul(nb_y, nb_y)), hn::Mul(nb_z, nb_z)));
      const auto none = hn::Lt(axes, constant(0.5)), both = hn::Gt(axes, constant(1.5));
      const auto along_axes = hn::IfThenElse(both, constant(0.5), constant(1.0));
      const auto along_line = hn::IfThenElse(apart, hn::Div(constant(1.0), distance), zero);
      const auto direction = [&](Eigen::Index k, auto n_a, auto line) HWY_ATTR {
        const auto n = hn::Sub(n_a, rotated(k, nb_x, nb_y, nb_z));
        return hn::IfThenElse(none, hn::Mul(along_line, line), hn::Mul(along_axes, n));
      };
      const auto u_x = direction(0, na_x, x), u_y = direction(1, na_y, y), u_z = direction(2, na_z, z);
      // The overlap's first moment about `about`. Its centre divides the line from A's centre to B's in the ratio of
      // the caps' volumes: (V_a p_a + V_b p_b) / (V_a + V_b), with V_a that of the cap of A's sphere.
      const auto height = hn::Max(hn::Sub(r1, plane()), zero);
      const auto cap =
          hn::Mul(constant(k_pi / 3.0), hn::Mul(hn::Mul(height, height), hn::Sub(hn::Mul(constant(3.0), r1), height)));
      const auto of_a = hn::IfThenElse(contained, hn::IfThenElse(hn::Lt(r1, r2), volume, zero), hn::Mul(weight, cap));
      const auto mx = hn::Sub(hn::Mul(volume, ax), hn::Mul(of_a, x)),
                 my = hn::Sub(hn::Mul(volume, ay), hn::Mul(of_a, y)),
                 mz = hn::Sub(hn::Mul(volume, az), hn::Mul(of_a, z));
      add_wrench(hn::Mul(volume, u_x), hn::Mul(volume, u_y), hn::Mul(volume, u_z),
                 hn::Sub(hn::Mul(my, u_z), hn::Mul(mz, u_y)), hn::Sub(hn::Mul(mz, u_x), hn::Mul(mx, u_z)),
                 hn::Sub(hn::Mul(mx, u_y), hn::Mul(my, u_x)));
      return;
    }
    auto magnitude = volume;
    if (law_ == PairForce::gradient) {
      const auto to_plane = plane();
      const auto disc = hn::Max(hn::Sub(hn::Mul(r1, r1), hn::Mul(to_plane, to_plane)), zero);
      const auto crossing = hn::Mul(weight, hn::Mul(constant(k_pi), disc));
      magnitude = hn::IfThenElse(hn::Or(contained, hn::Ge(distance, sum)), zero, crossing);
      // Middle of the overlap: centre of the disc, or of the sphere inside the other. It is B's centre plus `back`
      // times the vector (x, y, z) from A's centre to B's.
      const auto in_b = hn::IfThenElse(hn::Lt(r1, r2), constant(-1.0), zero);
      const auto back = hn::IfThenElse(contained, in_b, hn::Sub(hn::Div(to_plane, distance), constant(1.0)));
      const auto mx = hn::Add(ax, hn::Mul(back, x)), my = hn::Add(ay, hn::Mul(back, y)),
                 mz = hn::Add(az, hn::Mul(back, z));
      add_to(k_first_moment, hn::Mul(volume, mx));
      add_to(k_first_moment + 1, hn::Mul(volume, my));
      add_to(k_first_moment + 2, hn::Mul(volume, mz));
      add_to(k_second_moment, hn::Mul(volume, hn::Add(hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)), hn::Mul(mz, mz))));
    }
    const auto factor = hn::IfThenElse(apart, hn::Div(magnitude, distance), zero);
    const auto fx = hn::Mul(factor, x), fy = hn::Mul(factor, y), fz = hn::Mul(factor, z);
    // The force acts along the line of centres, so any point on it may be the end of the arm: here B's centre.
    add_wrench(fx, fy, fz, hn::Sub(hn::Mul(ay, fz), hn::Mul(az, fy)), hn::Sub(hn::Mul(az, fx), hn::Mul(ax, fz)),
               hn::Sub(hn::Mul(ax, fy), hn::Mul(ay, fx)));
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
