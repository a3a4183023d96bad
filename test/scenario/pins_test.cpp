// Ideal models of III and IV against planar polygons that are clipped and rotated without their formulas.

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/scenario/kinds.h>
#include <sixdof/scenario/scenario.h>
#include <sixdof/scenario/solids.h>

namespace sixdof {
namespace {

constexpr double k_angle_rounding = 1e-14;     // radians
constexpr double k_clipped = 1e-10;            // of a polygon of this size, clipped
constexpr double k_near_rounding = 1e-12;      // of lengths of order 10
constexpr double k_two_digits = 0.01;          // of 19 %, in two digits
constexpr double k_quadrature = 1e-5;          // of the integral over the lens, or of a slope
constexpr double k_rounding_of_depth = 1e-13;  // of lengths of order 10
constexpr double k_slope_error = 1e-3;         // relative: of slopes from finite steps
constexpr double k_sum_rounding = 1e-9;        // of sums over the walls
constexpr double k_tessellation = 2e-2;        // of the round pin
constexpr double k_torque_rounding = 1e-8;     // of a volume of 4,000 times an arm of 20
constexpr double k_torque_tessellation = 0.2;  // of the round pin, times the arm of 20
constexpr double k_unit_rounding = 1e-15;      // of one sine

using Loop = std::vector<Eigen::Vector2d>;
constexpr double k_pi = std::numbers::pi;

double area(const Loop& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d& p = loop[i];
    const Eigen::Vector2d& q = loop[(i + 1) % loop.size()];
    sum += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return sum;
}

/// Sutherland and Hodgman: `subject` cut to the inside of the convex, counter-clockwise `window`.
Loop clip(Loop subject, const Loop& window) {
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Eigen::Vector2d from = window[i];
    const Eigen::Vector2d edge = window[(i + 1) % window.size()] - from;
    const auto inside = [&](const Eigen::Vector2d& p) {
      return edge.x() * (p.y() - from.y()) - edge.y() * (p.x() - from.x());
    };
    Loop kept;
    for (std::size_t j = 0; j < subject.size(); ++j) {
      const Eigen::Vector2d& p = subject[j];
      const Eigen::Vector2d& q = subject[(j + 1) % subject.size()];
      const double at_p = inside(p);
      const double at_q = inside(q);
      if (at_p >= 0.0) kept.push_back(p);
      if ((at_p >= 0.0) != (at_q >= 0.0)) kept.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
    subject = kept;
  }
  return subject;
}

Loop square(double side) {
  const double h = 0.5 * side;
  return {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
}

Loop transformed(Loop loop, double angle, const Eigen::Vector2d& shift) {
  const Eigen::Rotation2Dd rotation(angle);
  for (Eigen::Vector2d& p : loop) p = rotation * p + shift;
  return loop;
}

/// Volume of a pin of this outline outside a hole of the same outline.
double outside(const Loop& outline, double angle, const Eigen::Vector2d& shift) {
  return 40.0 * (area(outline) - area(clip(transformed(outline, angle, shift), outline)));
}

double slope(const std::function<double(double)>& f, double at) {
  const double step = 1e-5;
  return (f(at + step) - f(at - step)) / (2.0 * step);
}

TEST(RotatingPin, VolumeAgreesWithClipping) {
  const auto scenario = make_scenario("III");
  for (const double s : {0.0, 0.013, 0.2, 0.5, 0.77, 1.0}) {
    const double phi = s * k_pi / 6.0;
    const auto ideal = scenario->ideal(IdealLaw::volume, s);
    EXPECT_NEAR(ideal->penalty, outside(square(20.0), phi, Eigen::Vector2d::Zero()), k_clipped);
    EXPECT_EQ(ideal->force, Eigen::Vector3d::Zero());
    EXPECT_NEAR(ideal->torque.z(), ideal->penalty, k_near_rounding);
    if (s == 0.0) continue;
    const double dv = slope([](double x) { return outside(square(20.0), x, Eigen::Vector2d::Zero()); }, phi);
    EXPECT_NEAR(scenario->ideal(IdealLaw::gradient, s)->torque.z(), dv, k_quadrature * dv);
    EXPECT_NEAR(scenario->ideal(IdealLaw::energy, s)->torque.z(), dv * ideal->penalty,
                k_quadrature * dv * ideal->penalty);
  }
}

TEST(RotatingPin, DepthIsThatOfTheCorner) {
  const auto scenario = make_scenario("III");
  for (const double s : {0.0, 0.2, 0.6, 1.0}) {
    double highest = 0.0;
    for (const Eigen::Vector2d& p : transformed(square(20.0), s * k_pi / 6.0, Eigen::Vector2d::Zero())) {
      highest = std::max(highest, p.y());
    }
    EXPECT_NEAR(scenario->ideal(IdealLaw::depth, s)->penalty, highest - 10.0, k_rounding_of_depth);
  }
}

TEST(RotatingPin, ResponseIsZeroWhereThePinExactlyFits) {
  const auto scenario = make_scenario("III");
  for (const IdealLaw law : all_ideal_laws()) {
    if (law == IdealLaw::paper_depth) continue;
    constexpr double k_rounding = 1e-11;  // of some thousands, the torques' size
    EXPECT_LT(scenario->ideal(law, 0.0)->torque.norm(), k_rounding) << to_string(law);
    EXPECT_LT(scenario->ideal(law, 0.0)->force.norm(), k_rounding) << to_string(law);
  }
  EXPECT_FALSE(scenario->in_window(0.0));
  EXPECT_TRUE(scenario->in_window(1e-6));
}

TEST(RotatingPin, TractionIsThatOfTheRotatedSquare) {
  const auto scenario = make_scenario("III");
  for (const bool along_wall : {false, true}) {
    const auto ideal = scenario->ideal(along_wall ? IdealLaw::wall_traction : IdealLaw::traction, 0.7);
    const double angle = -0.7 * k_pi / 6.0;
    const PlaneWrench t = square_pin_traction(20.0, 40.0, angle, Eigen::Vector2d::Zero(), along_wall);
    EXPECT_GT(t.torque, 0.0);
    EXPECT_TRUE(ideal->torque.isApprox(Eigen::Vector3d(0.0, 0.0, t.torque), 1e-14));
    EXPECT_EQ(ideal->force, Eigen::Vector3d::Zero());
  }
}

TEST(RotatingPin, PoseRotatesTheSquarePinAboutItsHole) {
  const auto scenario = make_scenario("III");
  for (const double s : {0.0, 0.4, 1.0}) {
    const Pose pose = scenario->pose(s);
    EXPECT_TRUE((pose * scenario->description().reference_b).isApprox(Eigen::Vector3d(-20, 0, -20), 1e-14));
    // The round pin is outside the block's outline, and the plate on its top.
    EXPECT_LT((pose * Eigen::Vector3d(20, 0, -20)).x() + 10.1, -40.0);
    EXPECT_EQ((pose * Eigen::Vector3d(7, 3, 0)).z(), 0.0);
    // Clockwise by phi from 180 degrees.
    const Eigen::Vector3d x = pose.R * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(std::atan2(x.y(), x.x()), k_pi - s * k_pi / 6.0, k_angle_rounding);
  }
}

TEST(RotatingPin, PaperFormulasAreAsPrinted) {
  const auto scenario = make_scenario("III");
  const double phi = 0.6 * k_pi / 6.0;
  EXPECT_NEAR(scenario->ideal(IdealLaw::paper_depth, 0.6)->penalty, std::sin(phi / 2.0) - 1.0, k_unit_rounding);
  EXPECT_NEAR(scenario->ideal(IdealLaw::paper_depth, 0.6)->torque.z(), 1.0 - std::sin(phi / 2.0), k_unit_rounding);
  const double bulge = std::sqrt(2.0) * std::cos(k_pi / 4.0 - phi) - 1.0;
  EXPECT_NEAR(scenario->ideal(IdealLaw::paper_volume, 0.6)->penalty, bulge * bulge / std::tan(phi / 2.0),
              k_angle_rounding);
  // Proportionality to the true volume is lost by 19 % over the path.
  const auto ratio = [&](double s) {
    return scenario->ideal(IdealLaw::paper_volume, s)->penalty / scenario->ideal(IdealLaw::volume, s)->penalty;
  };
  EXPECT_NEAR(1.0 - ratio(1.0) / ratio(1e-6), 0.19, k_two_digits);
}

/// Every point of the pin's wall with its depth below the block's nearest face, on a grid.
struct Sum {
  Eigen::Vector3d pin = Eigen::Vector3d::Zero();  ///< Force x, y and torque along the pin's inward normals.
  Eigen::Vector3d wall = Eigen::Vector3d::Zero();
};

Sum sum_over_wall(const Loop& outline, double angle, const Eigen::Vector2d& shift,
                  const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& nearest_on_hole) {
  const int count = 8000;
  const int layers = 400;
  Sum sum;
  const Loop rotated = transformed(outline, angle, shift);
  for (std::size_t i = 0; i < rotated.size(); ++i) {
    const Eigen::Vector2d side = rotated[(i + 1) % rotated.size()] - rotated[i];
    const Eigen::Vector2d inward = Eigen::Vector2d(-side.y(), side.x()).normalized();
    const int pieces = std::max(4, count / static_cast<int>(rotated.size()));
    for (int j = 0; j < pieces; ++j) {
      const Eigen::Vector2d p = rotated[i] + side * ((j + 0.5) / pieces);
      const Eigen::Vector2d to_hole = nearest_on_hole(p) - p;
      const double planar = to_hole.norm();
      if (planar == 0.0) continue;
      for (int k = 0; k < layers; ++k) {
        const double z = 40.0 * (k + 0.5) / layers;
        const double d = std::min({planar, z, 40.0 - z});
        const double element = d * side.norm() / pieces * 40.0 / layers;
        const Eigen::Vector2d arm = p - shift;
        const auto add = [&](Eigen::Vector3d& to, const Eigen::Vector2d& n) {
          to += element * Eigen::Vector3d(n.x(), n.y(), arm.x() * n.y() - arm.y() * n.x());
        };
        add(sum.pin, inward);
        if (d == planar) add(sum.wall, to_hole / planar);
      }
    }
  }
  return sum;
}

void expect_traction(const PlaneWrench& t, const Eigen::Vector3d& sum, double scale, double grid) {
  EXPECT_NEAR(t.x, sum.x(), grid * scale);
  EXPECT_NEAR(t.y, sum.y(), grid * scale);
  EXPECT_NEAR(t.torque, sum.z(), grid * scale * 10.0);
}

TEST(PinTractionOfASquare, IsTheSumOverTheWall) {
  constexpr double k_grid = 1e-3;
  const auto nearest = [](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.cwiseMax(-10.0).cwiseMin(10.0)); };
  for (const auto& [angle, shift] :
       {std::pair(-0.31, Eigen::Vector2d(0, 0)), std::pair(0.0, Eigen::Vector2d(1.3, -1.9)),
        std::pair(0.2, Eigen::Vector2d(-0.7, 0.9))}) {
    const Sum sum = sum_over_wall(square(20.0), angle, shift, nearest);
    const double scale = std::max(sum.pin.head<2>().norm(), std::abs(sum.pin.z()) / 10.0);
    expect_traction(square_pin_traction(20.0, 40.0, angle, shift, false), sum.pin, scale, k_grid);
    expect_traction(square_pin_traction(20.0, 40.0, angle, shift, true), sum.wall, scale, k_grid);
  }
}

TEST(PinTractionOfACircle, IsTheSumOverTheWall) {
  const auto nearest = [](const Eigen::Vector2d& p) {
    return p.norm() > 10.0 ? Eigen::Vector2d(p.normalized() * 10.0) : p;
  };
  constexpr double k_grid = 5e-4;  // layers, and its facets
  const Eigen::Vector2d shift(-1.1, 1.7);
  const Sum sum = sum_over_wall(polygon(10.0, 1000, RoundParts::equal_area), 0.0, shift, nearest);
  expect_traction(round_pin_traction(10.0, 40.0, shift, false), sum.pin, sum.pin.head<2>().norm(), k_grid);
  expect_traction(round_pin_traction(10.0, 40.0, shift, true), sum.wall, sum.wall.head<2>().norm(), k_grid);
  EXPECT_EQ(round_pin_traction(10.0, 40.0, Eigen::Vector2d::Zero(), true).force().norm(), 0.0);
}

TEST(PinTraction, OpposesTheRotationWithoutAForce) {
  for (const bool along_wall : {false, true}) {
    const PlaneWrench t = square_pin_traction(20.0, 40.0, -0.4, Eigen::Vector2d::Zero(), along_wall);
    EXPECT_GT(t.torque, 0.0);
    EXPECT_LT(t.force().norm(), 1e-12 * t.torque);
  }
}

TEST(OrbitingPins, VolumeAgreesWithClipping) {
  const auto scenario = make_scenario("IV");
  const Loop circle = polygon(10.0, 1200, RoundParts::equal_area);
  for (const double s : {0.01, 0.17, 0.36, 0.55, 0.81}) {
    const Eigen::Vector2d d = scenario->pose(s).t.head<2>();
    const double v_square = outside(square(20.0), 0.0, d);
    const double v_round = outside(circle, 0.0, d);
    const auto ideal = scenario->ideal(IdealLaw::volume, s);
    EXPECT_NEAR(ideal->penalty, v_square + v_round, k_tessellation);  // facets
    EXPECT_TRUE(ideal->force.head<2>().isApprox(-(v_square + v_round) * d / 2.0, 1e-5));
    EXPECT_NEAR(ideal->torque.z(), -20.0 * (v_round - v_square) * d.y() / 2.0, k_torque_tessellation);
  }
}

TEST(OrbitingPins, GradientIsTheSlopeOfClippedVolumes) {
  const auto scenario = make_scenario("IV");
  const Loop circle = polygon(10.0, 1200, RoundParts::equal_area);
  for (const double s : {0.01, 0.17, 0.36, 0.55, 0.81}) {
    const Eigen::Vector2d d = scenario->pose(s).t.head<2>();
    const Eigen::Vector2d arm(20.0, 0.0);
    // The pins rotated by `angle` about the point between them, then shifted.
    const auto volume = [&](const Eigen::Vector2d& more, double angle) {
      const Eigen::Vector2d rotated = Eigen::Rotation2Dd(angle) * arm;
      return outside(square(20.0), angle, d + more - (rotated - arm)) +
             outside(circle, angle, d + more + (rotated - arm));
    };
    const auto gradient = scenario->ideal(IdealLaw::gradient, s);
    const double scale = gradient->force.norm();
    EXPECT_NEAR(gradient->force.x(), -slope([&](double x) { return volume({x, 0}, 0.0); }, 0.0), k_slope_error * scale);
    EXPECT_NEAR(gradient->force.y(), -slope([&](double y) { return volume({0, y}, 0.0); }, 0.0), k_slope_error * scale);
    EXPECT_NEAR(gradient->torque.z(),
                -slope(
                    [&](double t) {
                      return volume({0, 0}, t);
                    },
                    0.0),
                k_slope_error * scale * 20.0);
  }
}

TEST(OrbitingPins, ForcePointsBackToTheFit) {
  const auto scenario = make_scenario("IV");
  for (const double s : {0.03, 0.2, 0.44, 0.71, 0.9}) {
    const Eigen::Vector3d inwards = -scenario->pose(s).t.normalized();
    for (const IdealLaw law : {IdealLaw::depth, IdealLaw::volume, IdealLaw::paper_depth, IdealLaw::paper_volume}) {
      EXPECT_TRUE(scenario->ideal(law, s)->force.normalized().isApprox(inwards, 1e-12)) << to_string(law);
    }
    for (const IdealLaw law : {IdealLaw::gradient, IdealLaw::traction, IdealLaw::wall_traction}) {
      EXPECT_GT(scenario->ideal(law, s)->force.normalized().dot(inwards), 0.7) << to_string(law);
    }
    for (const IdealLaw law : {IdealLaw::depth, IdealLaw::paper_depth}) {
      EXPECT_EQ(scenario->ideal(law, s)->torque, Eigen::Vector3d::Zero());
      EXPECT_NEAR(scenario->ideal(law, s)->force.norm(), 2.0, k_near_rounding);
    }
    const auto printed = scenario->ideal(IdealLaw::paper_volume, s);
    EXPECT_EQ(printed->torque, Eigen::Vector3d::Zero());
    EXPECT_NEAR(printed->force.norm(), printed->penalty, k_clipped);
    const auto volume = scenario->ideal(IdealLaw::volume, s);
    const Eigen::Vector2d shift = scenario->pose(s).t.head<2>();
    const double v_square = 40.0 * (400.0 - (20.0 - std::abs(shift.x())) * (20.0 - std::abs(shift.y())));
    EXPECT_NEAR(volume->torque.z(), -20.0 * (volume->penalty - 2.0 * v_square) * shift.y() / 2.0, k_torque_rounding);
    const auto gradient = scenario->ideal(IdealLaw::gradient, s);
    const auto energy = scenario->ideal(IdealLaw::energy, s);
    EXPECT_TRUE(energy->force.isApprox(volume->penalty * gradient->force, 1e-12));
    EXPECT_TRUE(energy->torque.isApprox(volume->penalty * gradient->torque, 1e-12));
    // As printed: no length, an empty integral, the whole disc instead of the part outside.
    const Eigen::Vector2d d = scenario->pose(s).t.head<2>().cwiseAbs();
    EXPECT_NEAR(scenario->ideal(IdealLaw::paper_volume, s)->penalty,
                400.0 - (20.0 - d.x()) * (20.0 - d.y()) + k_pi * 100.0, k_clipped);
  }
}

/// With c other than 2 r the printed integral, from c/2 to r of r^2 - t^2, is not empty.
TEST(OrbitingPins, PaperIntegralIsAsPrinted) {
  Settings settings = scenario_settings("IV");
  settings.set("square_side", "14");
  const auto scenario = make_scenario("IV", settings);
  double integral = 0.0;
  const int count = 2000;
  for (int i = 0; i < count; ++i) {
    const double t = 7.0 + 3.0 * (i + 0.5) / count;
    integral += (100.0 - t * t) * 3.0 / count;
  }
  const Eigen::Vector2d d = scenario->pose(0.2).t.head<2>().cwiseAbs();
  EXPECT_NEAR(scenario->ideal(IdealLaw::paper_volume, 0.2)->penalty,
              196.0 - (14.0 - d.x()) * (14.0 - d.y()) + k_pi * 100.0 - 4.0 * integral, k_quadrature);
}

/// Tractions of the scenario are those of its pins, at their positions.
TEST(OrbitingPins, TractionIsThatOfItsPins) {
  const auto scenario = make_scenario("IV");
  const Eigen::Vector2d d = scenario->pose(0.17).t.head<2>();
  for (const bool along_wall : {false, true}) {
    const auto ideal = scenario->ideal(along_wall ? IdealLaw::wall_traction : IdealLaw::traction, 0.17);
    const PlaneWrench square = square_pin_traction(20.0, 40.0, 0.0, d, along_wall);
    const PlaneWrench round = round_pin_traction(10.0, 40.0, d, along_wall);
    EXPECT_TRUE(ideal->force.head<2>().isApprox(square.force() + round.force(), 1e-12));
    EXPECT_NEAR(ideal->torque.z(), square.torque + 20.0 * (round.y - square.y), k_sum_rounding);
    EXPECT_NEAR(round.torque, 0.0, k_sum_rounding);
    EXPECT_EQ(ideal->penalty, 2.0);
  }
}

}  // namespace
}  // namespace sixdof
