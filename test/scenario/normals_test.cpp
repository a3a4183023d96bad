#include <sixdof/scenario/normals.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <sixdof/scenario/scenario.h>

namespace sixdof {
namespace {

/// Of a sum over the middles of 160^3 or more cells, of which those at the border are in or out as a whole. Relative.
constexpr double k_grid = 0.02;
constexpr double k_rounding = 1e-9;  // relative, of a quadrature

/// Sum of f(p) dV over a grid of cells of a box; f gives the wrench of a unit of volume at p.
template <class F>
NormalsWrench grid_sum(const Eigen::AlignedBox3d& box, const Eigen::Vector3i& cells, const F& f) {
  NormalsWrench sum;
  const Eigen::Vector3d step = box.sizes().cwiseQuotient(cells.cast<double>());
  for (int x = 0; x < cells.x(); ++x) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int z = 0; z < cells.z(); ++z) {
        const Eigen::Vector3d p = box.min() + (Eigen::Vector3d(x, y, z).array() + 0.5).matrix().cwiseProduct(step);
        const NormalsWrench w = f(p);
        sum.force += w.force;
        sum.torque += w.torque;
      }
    }
  }
  sum.force *= step.prod();
  sum.torque *= step.prod();
  return sum;
}

void expect_near(const NormalsWrench& found, const NormalsWrench& expected, double length) {
  EXPECT_GT(expected.force.norm() + expected.torque.norm(), 0.0);
  const double force = expected.force.norm(), torque = expected.torque.norm();
  EXPECT_LE((found.force - expected.force).norm(), k_grid * std::max(force, torque / length));
  EXPECT_LE((found.torque - expected.torque).norm(), k_grid * std::max(torque, force * length));
}

/// The nearest of some faces: its distance and outward normal.
struct Nearest {
  double distance = 1e300;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  void consider(double d, const Eigen::Vector3d& n) {
    if (d < distance) {
      distance = d;
      normal = n;
    }
  }
};

/// Half the difference of the normals at `arm` from the reference point.
NormalsWrench half_difference(const Eigen::Vector3d& arm, const Nearest& a, const Nearest& b) {
  const Eigen::Vector3d force = 0.5 * (a.normal - b.normal);
  return {force, arm.cross(force)};
}

TEST(Normals, OfASquarePinIsTheSumOverItsIntersection) {
  constexpr double k_side = 20.0, k_length = 11.0, k_angle = -0.31;
  const Eigen::Vector2d shift(0.7, -1.1);
  const Eigen::Rotation2Dd to_pin(-k_angle);
  const auto density = [&](const Eigen::Vector3d& p) -> NormalsWrench {
    const Eigen::Vector2d q = to_pin * (p.head<2>() - shift);
    const Eigen::Vector2d in_pin = 0.5 * k_side - q.array().abs();
    const Eigen::Vector2d beyond = p.head<2>().cwiseAbs().array() - 0.5 * k_side;
    if (in_pin.minCoeff() < 0.0 || beyond.maxCoeff() < 0.0) return {};
    Nearest a, b;
    const Eigen::Vector2d out = beyond.cwiseMax(0.0).cwiseProduct(p.head<2>().cwiseSign());
    a.consider(out.norm(), -Eigen::Vector3d(out.x(), out.y(), 0.0).normalized());
    a.consider(-p.z(), Eigen::Vector3d::UnitZ());
    a.consider(p.z() + k_length, -Eigen::Vector3d::UnitZ());
    for (const int axis : {0, 1}) {
      Eigen::Vector2d n = Eigen::Vector2d::Zero();
      n[axis] = q[axis] > 0.0 ? 1.0 : -1.0;
      n = to_pin.inverse() * n;
      b.consider(in_pin[axis], {n.x(), n.y(), 0.0});
    }
    b.consider(p.z() + k_length, -Eigen::Vector3d::UnitZ());
    return half_difference(p - Eigen::Vector3d(shift.x(), shift.y(), -0.5 * k_length), a, b);
  };
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-16.0, -16.0, -k_length), Eigen::Vector3d(16.0, 16.0, 0.0));
  expect_near(square_pin_normals(k_side, k_length, k_angle, shift), grid_sum(box, {500, 500, 40}, density), k_side);
}

TEST(Normals, OfARoundPinIsTheSumOverItsIntersection) {
  constexpr double k_radius = 10.0, k_length = 13.0;
  const Eigen::Vector2d shift(1.2, -1.9);
  const auto density = [&](const Eigen::Vector3d& p) -> NormalsWrench {
    const Eigen::Vector2d q = p.head<2>() - shift;
    if (q.norm() > k_radius || p.head<2>().norm() < k_radius) return {};
    Nearest a, b;
    a.consider(p.head<2>().norm() - k_radius, -Eigen::Vector3d(p.x(), p.y(), 0.0).normalized());
    a.consider(-p.z(), Eigen::Vector3d::UnitZ());
    a.consider(p.z() + k_length, -Eigen::Vector3d::UnitZ());
    b.consider(k_radius - q.norm(), Eigen::Vector3d(q.x(), q.y(), 0.0).normalized());
    b.consider(p.z() + k_length, -Eigen::Vector3d::UnitZ());
    return half_difference(p - Eigen::Vector3d(shift.x(), shift.y(), -0.5 * k_length), a, b);
  };
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-13.0, -13.0, -k_length), Eigen::Vector3d(13.0, 13.0, 0.0));
  expect_near(round_pin_normals(k_radius, k_length, shift), grid_sum(box, {500, 500, 60}, density), k_radius);
}

/// A surface integral here, a sum over the volume there: the same by the divergence theorem.
TEST(Normals, OfAConeIsTheSumOverItsPartInTheBlock) {
  for (const auto& [before, beyond, bottom] :
       {std::tuple{30.0, 40.0, 0.0}, {3.1, 40.0, 0.0}, {-2.3, 40.0, 6.0}, {50.0, 4.7, 3.0}}) {
    const ConeInBlock shape{
        .slope = 0.5, .height = 60, .bottom = bottom, .top = 20.0, .before = before, .beyond = beyond};
    const auto density = [&](const Eigen::Vector3d& p) -> NormalsWrench {
      const double from_axis = std::hypot(p.x(), p.z());
      if (from_axis > shape.slope * p.y() || p.x() < -shape.before || p.x() > shape.beyond) return {};
      Nearest a, b;
      b.consider(0.0, Eigen::Vector3d(p.x() / from_axis, -shape.slope, p.z() / from_axis).normalized());
      return half_difference(p - Eigen::Vector3d(0.0, 0.5 * shape.height, 0.0), a, b);
    };
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-10.0, bottom, -10.0), Eigen::Vector3d(10.0, 20.0, 10.0));
    expect_near(cone_normals(shape), grid_sum(box, {201, 160, 200}, density), shape.height);
  }
}

TEST(Normals, OfASphereIsTheSumOverItsPartInTheCylinder) {
  constexpr double k_radius = 30.0, k_cylinder = 25.0, k_distance = 48.0;
  const auto density = [&](const Eigen::Vector3d& p) -> NormalsWrench {
    const Eigen::Vector3d arm = p - Eigen::Vector3d(k_distance, 0.0, 0.0);
    if (arm.norm() > k_radius || std::hypot(p.x(), p.y()) > k_cylinder) return {};
    Nearest a, b;
    b.consider(0.0, arm.normalized());
    return half_difference(arm, a, b);
  };
  const Eigen::AlignedBox3d box(Eigen::Vector3d(15.0, -25.0, -25.0), Eigen::Vector3d(27.0, 25.0, 25.0));
  const NormalsWrench sum = grid_sum(box, {200, 200, 200}, density);
  EXPECT_NEAR(sphere_normals(k_radius, k_cylinder, k_distance), sum.force.x(), k_grid * sum.force.x());
}

TEST(Moments, OfPinsAreTheSumsOverTheirIntersections) {
  constexpr double k_side = 20.0, k_length = 11.0, k_angle = 0.23;
  const Eigen::Vector2d shift(0.7, -1.1);
  const Eigen::Rotation2Dd to_pin(-k_angle);
  for (const bool square : {true, false}) {
    constexpr int k_cells = 1600;
    OverlapMoments sum;
    for (int i = 0; i < k_cells; ++i) {
      for (int j = 0; j < k_cells; ++j) {
        const Eigen::Vector2d p = (Eigen::Vector2d(i, j).array() + 0.5) * (32.0 / k_cells) - 16.0;
        const Eigen::Vector2d arm = p - shift;
        const bool inside = square ? (to_pin * arm).cwiseAbs().maxCoeff() < 0.5 * k_side : arm.norm() < 0.5 * k_side;
        const bool in_hole = square ? p.cwiseAbs().maxCoeff() < 0.5 * k_side : p.norm() < 0.5 * k_side;
        if (!inside || in_hole) continue;
        const double volume = k_length * 32.0 * 32.0 / (k_cells * k_cells);
        sum.volume += volume;
        sum.first += volume * Eigen::Vector3d(arm.x(), arm.y(), 0.0);
        sum.second += volume * (arm.squaredNorm() + k_length * k_length / 12.0);
      }
    }
    const OverlapMoments found = square ? square_pin_moments(k_side, k_length, k_angle, shift)
                                        : round_pin_moments(0.5 * k_side, k_length, shift);
    EXPECT_NEAR(found.volume, sum.volume, k_grid * sum.volume);
    EXPECT_LE((found.first - sum.first).norm(), k_grid * sum.volume * k_side);
    EXPECT_NEAR(found.second, sum.second, k_grid * sum.second);
    // Moved there and back, and a size that does not depend on the reference point.
    const Eigen::Vector3d arm(3.0, -2.0, 5.0), force(1.0, 2.0, -0.5), torque(7.0, -4.0, 2.0);
    EXPECT_NEAR(found.moved(arm).moved(-arm).second, found.second, k_rounding * found.second * 100.0);
    EXPECT_NEAR(found.moved(arm).gradient_norm(force, torque + arm.cross(force)), found.gradient_norm(force, torque),
                k_rounding * found.gradient_norm(force, torque));
  }
}

/// In the window the overlap is symmetric about the cone's axis: no moment about its centroid.
TEST(Moments, MakeTheDescentOfAConeVertical) {
  const auto scenario = make_scenario("Ia");
  const auto volume = scenario->ideal(IdealLaw::volume, 0.4), descent = scenario->ideal(IdealLaw::descent, 0.4);
  EXPECT_LE((descent->force - volume->force).norm(), k_rounding * volume->force.norm());
  // Half over the end the force is inclined, and the size of the wrench is still V.
  const auto end = scenario->ideal(IdealLaw::descent, 30.0 / 960.0);
  EXPECT_LT(end->force.x(), -0.1 * end->penalty);
  EXPECT_GT(end->force.norm(), 0.9 * end->penalty);
  EXPECT_LE(end->force.norm(), end->penalty * (1.0 + k_rounding));
}

/// Two equal spheres would be their own mirror images: the part of A's normals is then that of B's. A sphere and a
/// cylinder of one radius differ, but not by much, and both parts push outwards.
TEST(Normals, AreHalfATractionAndAsMuchOfTheOtherBody) {
  const auto scenario = make_scenario("II");
  const double whole = scenario->ideal(IdealLaw::normals, 0.1)->force.norm();
  const double of_a = 0.5 * scenario->ideal(IdealLaw::traction, 0.1)->force.norm();
  EXPECT_GT(whole, 1.8 * of_a);
  EXPECT_LT(whole, 2.2 * of_a);
  EXPECT_LT(whole, scenario->ideal(IdealLaw::volume, 0.1)->force.norm()) << "normals of one direction would give V";
}

/// In III the parts of A's and B's normals: the first is half the traction, the second twists less.
TEST(Normals, OfARotatingPinPullItBack) {
  const auto scenario = make_scenario("III");
  for (const double progress : {0.2, 0.6, 1.0}) {
    const auto ideal = scenario->ideal(IdealLaw::normals, progress);
    const double traction = scenario->ideal(IdealLaw::traction, progress)->torque.z();
    EXPECT_GT(ideal->torque.z(), 0.5 * traction * (1.0 - k_rounding));
    EXPECT_LE(ideal->force.head<2>().norm(), k_rounding * ideal->penalty);
    EXPECT_GT(ideal->force.z(), 0.0) << "the pin's end pushes upwards";
  }
}

}  // namespace
}  // namespace sixdof
