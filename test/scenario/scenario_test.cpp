#include <sixdof/scenario/scenario.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/query/variant.h>

namespace sixdof {
namespace {

constexpr double k_coarse_slope = 1e-4;     // of a slope from a finite step
constexpr double k_near_rounding = 1e-12;   // of lengths of order 100
constexpr double k_five_digits = 5e-6;      // of a published value in five digits
constexpr double k_slope_error = 1e-6;      // of a slope from a central difference
constexpr double k_torque_rounding = 1e-7;  // relative: of a quadrature times an arm
constexpr double k_volume_rounding = 1e-9;  // of volumes of order 1,000, or relative

constexpr double k_pi = std::numbers::pi;
constexpr double k_rounding = 1e-12;

TEST(Scenario, EveryOneIsComplete) {
  ASSERT_EQ(scenario_names().size(), 5u);
  for (const std::string& name : scenario_names()) {
    const auto scenario = make_scenario(name);
    EXPECT_EQ(scenario->name(), name);
    EXPECT_FALSE(scenario->description().purpose.empty());
    EXPECT_FALSE(scenario->description().rules.empty());
    EXPECT_TRUE(scenario->a().solid());
    EXPECT_TRUE(scenario->b().solid());
    EXPECT_TRUE(scenario->a().topology().manifold);
    EXPECT_TRUE(scenario->b().topology().manifold);
    for (const IdealLaw law : all_ideal_laws()) {
      const bool there = scenario->ideal(law, 0.37).has_value();
      EXPECT_EQ(there, !(name == "Ib" && law == IdealLaw::paper_volume)) << name << ' ' << to_string(law);
      for (const double s : {0.0, 0.011, 0.37, 0.5, 0.93, 1.0}) {
        const auto ideal = scenario->ideal(law, s);
        ASSERT_EQ(ideal.has_value(), there);
        if (!ideal) continue;
        EXPECT_TRUE(std::isfinite(ideal->penalty) && ideal->force.allFinite() && ideal->torque.allFinite());
      }
    }
    for (const double s : {0.0, 0.37, 1.0}) {
      const Pose pose = scenario->pose(s);
      EXPECT_TRUE((pose.R * pose.R.transpose()).isIdentity(k_rounding));
      EXPECT_NEAR(pose.R.determinant(), 1.0, k_rounding);
    }
  }
}

TEST(Scenario, StepsCoverThePath) {
  const auto open = make_scenario("Ia");
  EXPECT_EQ(open->steps(5), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
  const auto closed = make_scenario("II");
  EXPECT_EQ(closed->steps(4), (std::vector<double>{0.125, 0.375, 0.625, 0.875}));
  EXPECT_THROW(open->steps(1), BadArgument);
  for (const std::string& name : scenario_names()) {
    const auto scenario = make_scenario(name);
    const double gap = (scenario->pose(0.0).t - scenario->pose(1.0).t).norm();
    EXPECT_EQ(gap < k_rounding, scenario->description().closed) << name;
  }
}

TEST(Scenario, LawsHaveWords) {
  const Traits by_depth{.name = "theirs", .law = ResponseLaw::depth};
  const Traits by_volume{.name = "theirs", .law = ResponseLaw::volume};
  const Traits unknown{.name = "theirs"};
  for (const IdealLaw law : all_ideal_laws()) EXPECT_EQ(parse_ideal_law(to_string(law), unknown), law);
  EXPECT_EQ(parse_ideal_law("own", by_depth), IdealLaw::depth);
  EXPECT_EQ(parse_ideal_law("own", by_volume), IdealLaw::volume);
  EXPECT_EQ(parse_ideal_law("paper", by_depth), IdealLaw::paper_depth);
  EXPECT_EQ(parse_ideal_law("paper", by_volume), IdealLaw::paper_volume);
  EXPECT_THROW(parse_ideal_law("paper", unknown), BadArgument);
  EXPECT_THROW(parse_ideal_law("own", unknown), BadArgument);
  EXPECT_THROW(parse_ideal_law("areas", by_depth), BadArgument);
}

/// Where the limit of an algorithm's wrench is known, it is judged by that, and by no law of magnitude.
TEST(Scenario, KnowsTheLimitsOfThisProjectsAlgorithms) {
  for (const auto& [name, declared, own] : {std::tuple{"exact", ResponseLaw::volume, IdealLaw::gradient},
                                            {"vps", ResponseLaw::depth, IdealLaw::traction},
                                            {"vps-field", ResponseLaw::way_out, IdealLaw::wall_traction},
                                            {"ist", ResponseLaw::volume, IdealLaw::normals},
                                            {"ist-descent", ResponseLaw::volume, IdealLaw::descent}}) {
    const Traits traits{.name = name, .law = declared};
    EXPECT_EQ(own_law(traits), own) << name;
    EXPECT_EQ(own_law({.name = variant_name(name, {"some=value"}), .law = declared}), own) << name;
    EXPECT_EQ(parse_ideal_law("paper", traits), is_of_depth(declared) ? IdealLaw::paper_depth : IdealLaw::paper_volume);
  }
}

TEST(Scenario, RefusesUnknownNames) {
  EXPECT_THROW(make_scenario("V"), BadArgument);
  EXPECT_THROW(scenario_settings("i"), BadArgument);
}

/// Every limit on lengths, from both sides. With the defaults the cone's tip has radius 10 and a flank of sqrt(1.25).
TEST(Scenario, RefusesContradictionsAndNothingElse) {
  struct Limit {
    const char* scenario;
    std::vector<std::string> others;
    const char* length;
    double accepted, refused;
  };
  const std::vector<Limit> limits{
      {"Ia", {}, "depth", 59.9, 60.1},
      {"Ia", {}, "overshoot", 10.1, 9.9},
      {"Ib", {}, "block_length", 24.8, 24.6},                  // 2 (20 sqrt(1.25) - 10)
      {"Ia", {}, "block_length", 35.2, 34.8},                  // twice from where the ends give no torque
      {"Ia", {"cone_radius=60"}, "block_length", 40.2, 39.8},  // twice the tip's radius
      {"Ia", {}, "block_width", 50.2, 49.8},                   // tip and half of the height
      {"Ia", {"block_height=60"}, "block_width", 60.2, 59.8},  // tip and depth
      {"II", {}, "orbit_radius", 59.9, 60.1},
      {"II", {"sphere_radius=25", "cylinder_length=200"}, "orbit_radius", 30.1, 29.9},
      {"II", {"cylinder_radius=25", "cylinder_length=200"}, "orbit_radius", 30.1, 29.9},
      {"II", {}, "cylinder_length", 64.8, 64.6},         // 2 (sqrt(500) + 10)
      {"III", {}, "square_side", 28.2, 28.4},            // its diagonal in the block's depth
      {"III", {"width=70"}, "square_side", 24.6, 24.9},  // and in half of its width
      {"III", {"width=100", "rotation_degrees=1"}, "round_radius", 19.9, 20.1},
      {"III", {}, "round_radius", 14.5, 14.7},  // rotates into the block's side
      {"III", {}, "rotation_degrees", 41.3, 41.5},
      {"IV", {"square_side=12"}, "orbit_radius", 5.9, 6.1},    // half the side
      {"IV", {"round_radius=2.5"}, "orbit_radius", 4.9, 5.1},  // the diameter
      {"IV", {"square_side=24"}, "orbit_radius", 7.9, 8.1},    // walls beside the square hole
      {"IV", {"round_radius=13"}, "orbit_radius", 6.9, 7.1},   // walls beside the round hole
      {"IV", {"width=70", "square_side=24"}, "orbit_radius", 5.4, 5.6},
  };
  for (const Limit& limit : limits) {
    Settings settings = scenario_settings(limit.scenario);
    settings.set("facets", "256");  // vertices of equal-area polygons are 1e-4 outside their circles
    settings.set_all(limit.others);
    settings.set(limit.length, std::to_string(limit.accepted));
    EXPECT_NO_THROW(make_scenario(limit.scenario, settings)) << limit.scenario << ' ' << limit.length;
    settings.set(limit.length, std::to_string(limit.refused));
    EXPECT_THROW(make_scenario(limit.scenario, settings), BadArgument) << limit.scenario << ' ' << limit.length;
  }
}

TEST(Scenario, ConeIsWhereTheDocumentationSays) {
  const auto thick = make_scenario("Ia");
  EXPECT_EQ(thick->a().box().min(), Eigen::Vector3d(0.0, -30.0, -187.5));
  EXPECT_EQ(thick->a().box().max(), Eigen::Vector3d(900.0, 0.0, 187.5));
  EXPECT_EQ(thick->pose(0.0).t, Eigen::Vector3d(-30.0, -20.0, 0.0));
  EXPECT_TRUE(thick->pose(1.0).t.isApprox(Eigen::Vector3d(930.0, -20.0, 0.0), k_rounding));
  EXPECT_EQ(thick->description().reference_b, Eigen::Vector3d(0.0, 30.0, 0.0));
  EXPECT_EQ(make_scenario("Ib")->a().box().min().y(), -0.2);
}

/// Past an end the shortest displacement is perpendicular to the flank: the part of the tip's radius over the block
/// times the cosine of the half angle.
TEST(Scenario, ConeGetsShallowerAtTheEnds) {
  const auto scenario = make_scenario("Ia");
  const auto depth_at = [&](double x) { return scenario->ideal(IdealLaw::depth, (x + 30.0) / 960.0)->penalty; };
  const double cosine = 60.0 / std::hypot(60.0, 30.0);
  for (const double over : {0.7, 5.0, 19.0, 22.3}) {
    EXPECT_NEAR(depth_at(over - 10.0), over * cosine, k_near_rounding) << over;
    EXPECT_NEAR(depth_at(910.0 - over), over * cosine, k_near_rounding) << over;
  }
  EXPECT_EQ(depth_at(12.4), 20.0);  // 22.4 cosine = 20.03
  EXPECT_EQ(depth_at(-10.1), 0.0);
}

/// In the window the whole tip is over the block, the shortest displacement out of it is upwards, and no part of the
/// tip is nearer to an end than to top and bottom.
TEST(Scenario, WindowOfTheConeEndsWhereAnEndBeginsToMatter) {
  const auto inside = [](const Scenario& scenario, double x) { return scenario.in_window((x + 30.0) / 960.0); };
  // Half-way between top and bottom, 15 from both, the cone has the radius 2.5.
  const auto slender = make_scenario("Ia");
  Settings settings = scenario_settings("Ia");
  settings.set("cone_radius", "60");  // tip of radius 20
  const auto wide = make_scenario("Ia", settings);
  const auto thin = make_scenario("Ib");  // upwards is shorter from x = 20 sqrt(1.25) - 10 = 12.36 on
  for (const auto& [scenario, end] :
       {std::pair(slender.get(), 17.5), std::pair(wide.get(), 20.0), std::pair(thin.get(), 12.36)}) {
    EXPECT_FALSE(inside(*scenario, end - 0.1));
    EXPECT_TRUE(inside(*scenario, end + 0.1));
    EXPECT_TRUE(inside(*scenario, 900.0 - end - 0.1));
    EXPECT_FALSE(inside(*scenario, 900.0 - end + 0.1));
  }
}

TEST(Scenario, EndsGiveTheConeATorqueOutsideTheWindowOnly) {
  const auto scenario = make_scenario("Ia");
  for (const IdealLaw law : {IdealLaw::traction, IdealLaw::wall_traction, IdealLaw::normals}) {
    const auto torque_at = [&](double x) {
      const auto ideal = scenario->ideal(law, (x + 30.0) / 960.0);
      return ideal->torque.norm() / (ideal->force.norm() * scenario->description().reference_length);
    };
    for (const double end : {17.4, 900.0 - 17.4}) EXPECT_GT(torque_at(end), 1e-6) << to_string(law);
    for (const double inside : {17.6, 450.0, 900.0 - 17.6}) EXPECT_LT(torque_at(inside), 1e-12) << to_string(law);
  }
}

TEST(Scenario, PaperFormulasOfTheConeAreAsPrinted) {
  const auto thick = make_scenario("Ia");
  EXPECT_EQ(thick->ideal(IdealLaw::paper_depth, 0.4)->force, Eigen::Vector3d(0.0, 20.0, 0.0));
  EXPECT_EQ(thick->ideal(IdealLaw::paper_volume, 0.4)->force, Eigen::Vector3d(0.0, 8000.0, 0.0));
  constexpr double k_just_touching = (30.0 - 9.95) / 960.0;  // 0.05 of the tip over the block
  EXPECT_EQ(thick->ideal(IdealLaw::paper_depth, k_just_touching)->penalty, 20.0);
  EXPECT_EQ(thick->ideal(IdealLaw::paper_volume, k_just_touching)->penalty, 8000.0);
  EXPECT_EQ(thick->ideal(IdealLaw::paper_depth, 0.0)->penalty, 0.0);
  EXPECT_EQ(thick->ideal(IdealLaw::paper_volume, 1.0)->penalty, 0.0);
}

TEST(Scenario, ConeHasTheClosedFormWhereItsTipIsOverTheBlock) {
  const auto thick = make_scenario("Ia");
  for (const double s : {0.05, 0.31, 0.5, 0.9}) {
    ASSERT_TRUE(thick->in_window(s));
    EXPECT_NEAR(thick->ideal(IdealLaw::volume, s)->penalty, k_pi * 8000.0 / 12.0, k_volume_rounding);
    // dV / d delta = pi delta^2 / 4, straight up, no torque.
    const auto gradient = thick->ideal(IdealLaw::gradient, s);
    EXPECT_TRUE(gradient->force.isApprox(Eigen::Vector3d(0.0, k_pi * 100.0, 0.0), k_rounding));
    EXPECT_LT(gradient->torque.norm(), 1e-9);
    EXPECT_EQ(thick->ideal(IdealLaw::depth, s)->force, Eigen::Vector3d(0, 20, 0));
    const auto energy = thick->ideal(IdealLaw::energy, s);
    EXPECT_TRUE(energy->force.isApprox(gradient->force * gradient->penalty, k_rounding));
  }
  EXPECT_FALSE(thick->in_window(0.04));
  EXPECT_FALSE(thick->in_window(0.96));

  const auto thin = make_scenario("Ib");
  EXPECT_NEAR(thin->ideal(IdealLaw::volume, 0.5)->penalty, k_pi / 12.0 * (8000.0 - std::pow(19.8, 3)),
              k_volume_rounding);
  EXPECT_NEAR(thin->ideal(IdealLaw::gradient, 0.5)->force.y(), k_pi / 4.0 * (400.0 - 19.8 * 19.8), k_volume_rounding);
  EXPECT_EQ(thin->ideal(IdealLaw::depth, 0.5)->penalty, 20.0);
}

TEST(Scenario, ConeLeavesTheBlockOnBothSidesAlike) {
  for (const char* name : {"Ia", "Ib"}) {
    const auto scenario = make_scenario(name);
    for (const IdealLaw law : all_ideal_laws()) {
      if (!scenario->ideal(law, 0.0)) continue;
      for (const double s : {0.0, 0.0213, 0.026, 0.03, 0.035, 0.041, 0.044, 0.05}) {
        const auto front = scenario->ideal(law, s);
        const auto back = scenario->ideal(law, 1.0 - s);
        const double scale = scenario->ideal(law, 0.5)->force.norm();
        EXPECT_NEAR(front->force.y(), back->force.y(), k_volume_rounding * scale)
            << name << ' ' << to_string(law) << ' ' << s;
        EXPECT_NEAR(front->force.x(), -back->force.x(), k_volume_rounding * scale)
            << name << ' ' << to_string(law) << ' ' << s;
        EXPECT_NEAR(front->torque.z(), -back->torque.z(), k_torque_rounding * scale)
            << name << ' ' << to_string(law) << ' ' << s;
      }
      EXPECT_EQ(scenario->ideal(law, 0.0)->force.norm(), 0.0);
    }
  }
}

/// The force along the path is minus the slope of V.
TEST(Scenario, GradientIsTheSlopeOfTheVolumeAlongThePath) {
  for (const char* name : {"Ia", "Ib", "IV"}) {
    const auto scenario = make_scenario(name);
    const double step = 1e-6;
    for (const double s : {0.0213, 0.026, 0.033, 0.041, 0.1, 0.17, 0.62, 0.9646, 0.975}) {
      const double slope = (scenario->ideal(IdealLaw::volume, s + step)->penalty -
                            scenario->ideal(IdealLaw::volume, s - step)->penalty) /
                           (2.0 * step);
      const Eigen::Vector3d speed = (scenario->pose(s + step).t - scenario->pose(s - step).t) / (2.0 * step);
      const double power = scenario->ideal(IdealLaw::gradient, s)->force.dot(speed);
      const double scale = scenario->ideal(IdealLaw::gradient, s)->force.norm() * speed.norm();
      EXPECT_NEAR(power, -slope, k_slope_error * scale + k_slope_error) << name << ' ' << s;
    }
  }
}

/// Another depth of the same cone gives the vertical part, another orbit the radial one.
TEST(Scenario, GradientIsTheSlopeOfTheVolumeAcrossThePath) {
  const auto slope = [](const char* name, const char* length, double at, double s) {
    const double step = 1e-3;
    const auto volume = [&](double value) {
      Settings settings = scenario_settings(name);
      settings.set(length, std::to_string(value));
      return make_scenario(name, settings)->ideal(IdealLaw::volume, s)->penalty;
    };
    return (volume(at + step) - volume(at - step)) / (2.0 * step);
  };
  for (const double s : {0.026, 0.033, 0.041, 0.4}) {
    EXPECT_NEAR(make_scenario("Ia")->ideal(IdealLaw::gradient, s)->force.y(), slope("Ia", "depth", 20.0, s),
                k_coarse_slope);
    EXPECT_NEAR(make_scenario("Ib")->ideal(IdealLaw::gradient, s)->force.y(), slope("Ib", "depth", 20.0, s),
                k_coarse_slope);
  }
  EXPECT_NEAR(make_scenario("II")->ideal(IdealLaw::gradient, 0.3)->force.norm(),
              -slope("II", "orbit_radius", 50.0, 0.3), k_coarse_slope);
}

TEST(Scenario, SphereHasTheKnownVolume) {
  // For radii 1 and orbit 5/3, by quadrature elsewhere: 0.22778; here 30 times as large.
  const auto scenario = make_scenario("II");
  EXPECT_NEAR(scenario->ideal(IdealLaw::volume, 0.1)->penalty / 27000.0, 0.22778, k_five_digits);
  EXPECT_EQ(scenario->ideal(IdealLaw::depth, 0.1)->penalty, 10.0);
  EXPECT_EQ(scenario->ideal(IdealLaw::paper_depth, 0.1)->penalty, 50.0);
  EXPECT_EQ(scenario->ideal(IdealLaw::paper_volume, 0.1)->penalty, 1.0);
  EXPECT_NEAR(scenario->ideal(IdealLaw::paper_volume, 0.1)->force.norm(), 1.0, k_rounding);
  EXPECT_NEAR(scenario->ideal(IdealLaw::volume, 0.1)->force.norm() / scenario->ideal(IdealLaw::volume, 0.1)->penalty,
              1.0, k_rounding);
  EXPECT_TRUE(scenario->ideal(IdealLaw::energy, 0.1)
                  ->force.isApprox(
                      scenario->ideal(IdealLaw::volume, 0.1)->penalty * scenario->ideal(IdealLaw::gradient, 0.1)->force,
                      k_rounding));
  const Eigen::Vector3d outwards(std::cos(0.2 * k_pi), std::sin(0.2 * k_pi), 0.0);
  for (const IdealLaw law : all_ideal_laws()) {
    const auto ideal = scenario->ideal(law, 0.1);
    EXPECT_TRUE(ideal->force.normalized().isApprox(outwards, k_rounding)) << to_string(law);
    EXPECT_EQ(ideal->torque, Eigen::Vector3d::Zero());
  }
}

/// Traction of smooth bodies as the sum over a fine grid of surface elements, an independent computation.
TEST(Scenario, TractionIsTheSumOverTheSurface) {
  const auto scenario = make_scenario("II");
  const int count = 800;
  double pins = 0.0;
  double walls = 0.0;
  for (int i = 0; i < count; ++i) {
    const double z = 30.0 * (2.0 * (i + 0.5) / count - 1.0);
    for (int j = 0; j < 2 * count; ++j) {
      const double angle = k_pi * (j + 0.5) / count;
      const double q = std::sqrt(900.0 - z * z);
      const double x = 50.0 + q * std::cos(angle);
      const double d = 30.0 - std::hypot(x, q * std::sin(angle));
      if (d <= 0.0) continue;
      const double element = 30.0 * (60.0 / count) * (k_pi / count);
      pins += d * element * -q * std::cos(angle) / 30.0;
      walls += d * element * x / std::hypot(x, q * std::sin(angle));
    }
  }
  constexpr double k_grid = 1e-4;
  EXPECT_NEAR(scenario->ideal(IdealLaw::traction, 0.0)->force.x() / pins, 1.0, k_grid);
  EXPECT_NEAR(scenario->ideal(IdealLaw::wall_traction, 0.0)->force.x() / walls, 1.0, k_grid);
}

TEST(Scenario, ConeTractionIsTheSumOverTheSurface) {
  const int count = 700;
  for (const char* name : {"Ia", "Ib"}) {
    const auto scenario = make_scenario(name);
    const double thickness = -scenario->a().box().min().y();
    for (const double s : {0.022, 0.033, 0.047, 0.5, 0.963}) {
      const double apex = scenario->pose(s).t.x();
      const double bottom = std::max(0.0, 20.0 - thickness);
      const double flank = std::sqrt(1.25);
      Eigen::Vector3d along_cone = Eigen::Vector3d::Zero();
      Eigen::Vector3d along_wall = Eigen::Vector3d::Zero();
      double cone_torque = 0.0;
      for (int i = 0; i < count; ++i) {
        const double up = bottom + (20.0 - bottom) * (i + 0.5) / count;
        for (int j = 0; j < count; ++j) {
          const double angle = 2.0 * k_pi * (j + 0.5) / count;
          const double x = apex + 0.5 * up * std::cos(angle);
          const double y = up - 20.0;
          const double d = std::min({-y, thickness + y, x, 900.0 - x});
          if (d <= 0.0) continue;
          const double element = (20.0 - bottom) / count * flank * 0.5 * up * 2.0 * k_pi / count;
          const Eigen::Vector3d inward(-std::cos(angle) / flank, 0.5 / flank, -std::sin(angle) / flank);
          const Eigen::Vector3d wall(d == x           ? -1.0
                                     : d == 900.0 - x ? 1.0
                                                      : 0.0,
                                     d == x || d == 900.0 - x ? 0.0 : (d == -y ? 1.0 : -1.0), 0.0);
          along_cone += d * element * inward;
          along_wall += d * element * wall;
          cone_torque += d * element * ((x - apex) * inward.y() - (up - 30.0) * inward.x());
        }
      }
      const auto cone = scenario->ideal(IdealLaw::traction, s);
      const auto wall = scenario->ideal(IdealLaw::wall_traction, s);
      const double scale = scenario->ideal(IdealLaw::traction, 0.5)->force.norm();
      constexpr double k_grid = 2e-3;  // elements cut by an edge or by the change of the nearest face
      EXPECT_NEAR(cone->force.x(), along_cone.x(), k_grid * scale) << name << ' ' << s;
      EXPECT_NEAR(cone->force.y(), along_cone.y(), k_grid * scale) << name << ' ' << s;
      EXPECT_NEAR(cone->torque.z(), cone_torque, k_grid * scale * 30.0) << name << ' ' << s;
      const double wall_scale = std::max(scale, along_wall.norm());
      EXPECT_NEAR(wall->force.x(), along_wall.x(), k_grid * wall_scale) << name << ' ' << s;
      EXPECT_NEAR(wall->force.y(), along_wall.y(), 2.0 * k_grid * wall_scale) << name << ' ' << s;
    }
  }
}

}  // namespace
}  // namespace sixdof
