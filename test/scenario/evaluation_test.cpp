#include <sixdof/scenario/evaluation.h>

#include <unistd.h>

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/measure/spectrum.h>
#include <sixdof/scenario/scenario.h>

#include "ideal_query.h"

namespace sixdof {
namespace {

constexpr double k_slope_left = 1e-3;  // what a slope leaves of a jump after the halvings

using test::IdealQuery;

constexpr double k_rounding = 1e-9;

std::map<std::string, double> by_name(const Measures& measures) { return {measures.begin(), measures.end()}; }

TEST(Evaluation, AnIdealAnswerIsPerfect) {
  for (const std::string& name : scenario_names()) {
    const auto scenario = make_scenario(name);
    for (const IdealLaw law : {IdealLaw::depth, IdealLaw::volume}) {
      IdealQuery query(*scenario, law);
      const Recording recording = record(*scenario, query, 200);
      const auto m = by_name(evaluate(*scenario, recording, law));
      const bool by_torque = name == "III";
      const std::string which = by_torque ? "T" : "F";
      EXPECT_NEAR(m.at("sigma_" + which), 0.0, k_rounding) << name;
      EXPECT_NEAR(m.at("gamma_" + which + "_deg"), 0.0, k_rounding) << name;
      EXPECT_NEAR(m.at("nu_" + which), 1.0, k_rounding) << name;
      EXPECT_NEAR(m.at("noise_" + which), 0.0, k_rounding) << name;
      EXPECT_NEAR(m.at("gain_" + which), 1.0, k_rounding) << name;
      EXPECT_EQ(m.at("misses"), 0.0) << name;
      EXPECT_EQ(m.at("false_contacts"), 0.0) << name;
      EXPECT_EQ(m.at("failed"), 0.0) << name;
      EXPECT_EQ(m.count("sigma_" + std::string(by_torque ? "F" : "T")),
                name == "IV" && law == IdealLaw::volume ? 1u : 0u);
      EXPECT_EQ(m.count("leakage"), name == "IV" && law == IdealLaw::volume ? 0u : 1u);
      EXPECT_EQ(m.count("loop_work"), scenario->description().closed ? 1u : 0u);
      EXPECT_EQ(m.count("sigma_F_all"), name[0] == 'I' && name.size() == 2 && name != "II" && name != "IV" ? 1u : 0u);
      for (const auto& [key, value] : m) {
        EXPECT_NE(find_metric(key), nullptr) << key;
        EXPECT_TRUE(std::isfinite(value)) << key;
      }
      if (name == "II") {
        EXPECT_NEAR(m.at("loop_work"), 0.0, k_rounding);
      }
    }
  }
}

TEST(Evaluation, WindowAndWholePathAreDistinguished) {
  const auto scenario = make_scenario("Ia");
  IdealQuery query(*scenario, IdealLaw::volume);
  const Recording recording = record(*scenario, query, 961);  // one step per unit of length
  const auto m = by_name(evaluate(*scenario, recording, IdealLaw::volume));
  EXPECT_EQ(m.at("skipped"), 0.0);
  // The tip of radius 10 is off the block for x in [-30, -10] and [910, 930].
  EXPECT_EQ(m.at("skipped_all"), 42.0);
}

TEST(Evaluation, FailedStepsAreCountedAndLeftOut) {
  const auto scenario = make_scenario("II");
  IdealQuery query(*scenario, IdealLaw::volume);
  Recording recording = record(*scenario, query, 100);
  const std::map<std::size_t, Status> failures{{7, Status::failed},       {8, Status::non_finite},
                                               {60, Status::unsupported}, {61, Status::crashed},
                                               {70, Status::crashed},     {71, Status::timed_out}};
  for (const auto& [k, status] : failures) {
    recording.status[k] = status;
    recording.forces[k].setZero();
  }
  const auto m = by_name(evaluate(*scenario, recording, IdealLaw::volume));
  EXPECT_EQ(m.at("failed"), 6.0);
  EXPECT_EQ(m.at("crashed"), 2.0);
  EXPECT_EQ(m.at("timed_out"), 1.0);
  EXPECT_EQ(m.count("out_of_memory"), 0u) << "absent for none";
  EXPECT_EQ(m.at("misses"), 0.0);
  EXPECT_NEAR(m.at("sigma_F"), 0.0, k_rounding);
  EXPECT_GT(m.at("noise_F"), 1e-3);  // failed steps are zero in the spectrum
}

/// An unwanted torque of 3 about the reference in II, an unwanted force in III, over the wanted part, scaled by the
/// scenario's reference length: 30 in II, 20 in III.
TEST(Evaluation, LeakageIsScaledByTheReferenceLength) {
  const auto orbit = make_scenario("II");
  IdealQuery twisting(*orbit, IdealLaw::depth, [](Response& r, double, std::size_t) { r.torque.x() += 3.0; });
  const auto twisted = by_name(evaluate(*orbit, record(*orbit, twisting, 40), IdealLaw::depth));
  EXPECT_NEAR(twisted.at("leakage"), 3.0 / (10.0 * 30.0), k_rounding);
  const auto rotation = make_scenario("III");
  IdealQuery pushing(*rotation, IdealLaw::depth,
                     [](Response& r, double, std::size_t) { r.force.x() = 0.25 * r.torque.z(); });
  const auto pushed = by_name(evaluate(*rotation, record(*rotation, pushing, 40), IdealLaw::depth));
  EXPECT_NEAR(pushed.at("leakage"), 0.25 * 20.0, k_rounding);
}

/// By some laws the ideal torque of a plate is 1e-13, by rounding: nothing is measured relative to it.
TEST(Evaluation, IdealsOfRoundingAreNone) {
  const auto plate = make_scenario("Ib");
  IdealQuery query(*plate, IdealLaw::normals, [](Response& r, double, std::size_t) { r.torque.x() += 3.0; });
  const Recording recording = record(*plate, query, 500);
  const auto ideal = plate->ideal(IdealLaw::normals, 0.5);
  ASSERT_GT(ideal->torque.norm(), 0.0) << "then this test shows nothing";
  const auto m = by_name(evaluate(*plate, recording, IdealLaw::normals));
  for (const char* const measure : {"sigma_T", "gamma_T_deg", "nu_T", "noise_T"}) EXPECT_EQ(m.count(measure), 0u);
  EXPECT_NEAR(m.at("leakage"), 3.0 / (ideal->force.norm() * plate->description().reference_length), k_rounding);
  EXPECT_EQ(m.count("sigma_T_all"), 1u) << "at the ends of the plate there is a torque";
}

/// In IV the measured penalty is the square of the ideal, in III it is three times the ideal.
TEST(Evaluation, PenaltyIsComparedWithItsIdeal) {
  const auto orbit = make_scenario("IV");
  IdealQuery squared(*orbit, IdealLaw::volume, [](Response& r, double, std::size_t) { r.penalty *= r.penalty; });
  const Recording recording = record(*orbit, squared, 64);
  double largest = 0.0, squares = 0.0, fourth = 0.0, difference = 0.0;
  std::vector<double> ideal;
  for (const double progress : recording.progress) ideal.push_back(orbit->ideal(IdealLaw::volume, progress)->penalty);
  for (const double v : ideal) largest = std::max(largest, v);
  for (const double v : ideal) {
    const double x = v / largest;
    squares += x * x;
    fourth += x * x * x * x;
    difference += (x - x * x) * (x - x * x);
  }
  const auto m = by_name(evaluate(*orbit, recording, IdealLaw::volume));
  EXPECT_NEAR(m.at("sigma_q"), std::sqrt(difference / 64.0), k_rounding);
  EXPECT_NEAR(m.at("nu_q"), fourth / squares, k_rounding);
  EXPECT_GT(m.at("sigma_q"), 1e-3) << "V changes along the path";

  const auto rotation = make_scenario("III");
  IdealQuery tripled(*rotation, IdealLaw::depth, [](Response& r, double, std::size_t) { r.penalty *= 3.0; });
  const auto n = by_name(evaluate(*rotation, record(*rotation, tripled, 64), IdealLaw::depth));
  EXPECT_NEAR(n.at("gain_q"), 3.0, k_rounding);
  EXPECT_NEAR(n.at("sigma_q"), 0.0, k_rounding);
  EXPECT_NEAR(n.at("sigma_gain_q"), 0.0, k_rounding);
  EXPECT_NEAR(n.at("nu_direction_T"), 1.0, k_rounding);
  EXPECT_EQ(n.count("nu_direction_F"), 0u) << "no force in III";
  IdealQuery printed(*rotation, IdealLaw::paper_depth, [](Response& r, double, std::size_t) { r.penalty *= -2.0; });
  const auto p = by_name(evaluate(*rotation, record(*rotation, printed, 64), IdealLaw::paper_depth));
  EXPECT_NEAR(p.at("gain_q"), 2.0, k_rounding) << "the printed formula is negative";
}

TEST(Evaluation, RefusesALawWithoutIdeal) {
  const auto scenario = make_scenario("Ib");
  IdealQuery query(*scenario, IdealLaw::volume);
  const Recording recording = record(*scenario, query, 10);
  EXPECT_THROW(evaluate(*scenario, recording, IdealLaw::paper_volume), BadArgument);
}

TEST(Evaluation, JumpsAreFoundBetweenSteps) {
  const auto scenario = make_scenario("II");
  IdealQuery smooth(*scenario, IdealLaw::volume);
  const auto none = by_name(evaluate_jumps(*scenario, smooth, record(*scenario, smooth, 100), IdealLaw::volume));
  EXPECT_LT(none.at("jump_F"), 1e-3);
  EXPECT_EQ(none.count("jump_T"), 0u);
  IdealQuery step(*scenario, IdealLaw::volume, [](Response& r, double progress, std::size_t) {
    if (progress > 0.3141) r.force *= 0.8;
  });
  const auto jump = by_name(evaluate_jumps(*scenario, step, record(*scenario, step, 100), IdealLaw::volume));
  EXPECT_NEAR(jump.at("jump_F"), 0.2, k_slope_left);
}

TEST(SeriesFile, HoldsTheRecording) {
  const auto scenario = make_scenario("III");
  IdealQuery query(*scenario, IdealLaw::volume, [](Response& r, double, std::size_t) { r.torque *= 3.0; });
  const Recording recording = record(*scenario, query, 150);
  const Measures measures = evaluate(*scenario, recording, IdealLaw::volume);
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sixdof_series_test" + std::to_string(::getpid()) + ".h5");
  write_series(path, *scenario, recording, IdealLaw::volume, {"ideal", "1", "x=2", "facets=96"}, measures);
  {
    const hdf5::Session session;
    const hdf5::File file = hdf5::File::open(path);
    EXPECT_EQ(file.read_string("/", "format"), "sixdof-series");
    EXPECT_EQ(file.read_string("/", "scenario"), "III");
    EXPECT_EQ(file.read_string("/", "law"), "volume");
    EXPECT_EQ(file.read_string("/", "settings"), "x=2");
    EXPECT_NEAR(file.read_attribute<double>("/", "gain_T"), 3.0, k_rounding);
    EXPECT_EQ(file.matrix_size("/torque"), std::pair(std::size_t{150}, std::size_t{3}));
    EXPECT_EQ(file.read_matrix("/torque")[3 * 149 + 2], recording.torques[149].z());
    EXPECT_NEAR(file.read_matrix("/ideal_torque")[3 * 149 + 2] * 3.0, recording.torques[149].z(), k_rounding * 1e4);
    EXPECT_EQ(file.matrix_size("/pose").second, 7u);
    EXPECT_EQ(file.read_values<std::int32_t>("/status"), std::vector<std::int32_t>(150, 0));
    // Rows start every 8 steps: (150 - 64) / 8 + 1 of them.
    for (const char* name : {"force_signal", "force_residual", "torque_signal", "torque_residual"}) {
      EXPECT_EQ(file.matrix_size(std::string("/spectrum/") + name),
                std::pair(std::size_t{11}, k_spectrum_window / 2 + 1));
    }
    std::vector<double> turning;
    for (const Eigen::Vector3d& v : recording.torques) turning.push_back(v.z());
    EXPECT_EQ(file.read_matrix("/spectrum/torque_z_signal"),
              short_time_spectrum(turning, 1000.0, k_spectrum_window, 8).intensity);
    for (const char* name : {"force_x_signal", "force_y_signal", "force_z_signal", "torque_x_signal"}) {
      EXPECT_EQ(file.read_matrix(std::string("/spectrum/") + name),
                std::vector<double>(11 * (k_spectrum_window / 2 + 1), 0.0));
    }
    EXPECT_EQ(file.read_attribute<double>("/", "reference_length"), 20.0);
    const std::vector<double> times = file.read_matrix("/spectrum/times");
    ASSERT_EQ(times.size(), 11u);
    EXPECT_NEAR(times[3], (3 * 8 + 32) * 1e-3, k_rounding);
    EXPECT_NEAR(file.read_matrix("/spectrum/frequencies").back(), 500.0, k_rounding);
    const Spectrogram diagram = short_time_spectrum(magnitudes(recording.torques), 1000.0, k_spectrum_window, 8);
    EXPECT_EQ(file.read_matrix("/spectrum/torque_signal"), diagram.intensity);
    // Three times the ideal: a gain without a residual.
    const std::vector<double> residual = file.read_matrix("/spectrum/torque_residual");
    EXPECT_LT(*std::max_element(residual.begin(), residual.end()), k_rounding * diagram.intensity.front());
    EXPECT_EQ(file.read_matrix("/spectrum/force_residual"), std::vector<double>(residual.size(), 0.0));
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace sixdof
