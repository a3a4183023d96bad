// A series of `sixdof quality -o` is read back; damaged and foreign files are refused.

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/query/registry.h>
#include <sixdof/report/series.h>
#include <sixdof/scenario/evaluation.h>

namespace sixdof::report {
namespace {

class SeriesFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path = std::filesystem::temp_directory_path() /
           (std::string("sixdof-series-") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".h5");
  }
  void TearDown() override { std::filesystem::remove(path); }

  std::filesystem::path path;
};

TEST_F(SeriesFile, IsReadAsItWasRecorded) {
  Registry registry;
  register_core_algorithms(registry);
  const Algorithm& vps = registry.find("vps");
  const auto scenario = make_scenario("II", scenario_settings("II"));
  Settings settings = vps.settings();
  settings.set_all({"voxel_size=0.05", "point_spacing=0.05"});
  const auto query = vps.prepare(scenario->a(), scenario->b(), settings);
  const Recording recording = record(*scenario, *query, 128);
  write_series(path, *scenario, recording, IdealLaw::depth, {"vps", "1", settings.to_string(), "shape"}, {});

  const Series series = read_series(path);
  EXPECT_EQ(series.scenario, "II");
  EXPECT_EQ(series.algorithm, "vps");
  EXPECT_EQ(series.rate_hz, k_haptic_rate_hz);
  ASSERT_EQ(series.force.size(), 128u);
  for (std::size_t k = 0; k < 128; ++k) {
    EXPECT_EQ(series.force[k][1], recording.forces[k].y());
    EXPECT_EQ(series.torque[k][2], recording.torques[k].z());
  }
  EXPECT_EQ(series.penalty, recording.penalties);
  EXPECT_EQ(series.time_ns, recording.times_ns);
  EXPECT_EQ(series.ideal_penalty, std::vector<double>(128, 10.0)) << "R + r - rho";
  EXPECT_EQ(series.reference_length, 30.0);
  ASSERT_EQ(series.spectra.size(), 10u) << "two magnitudes, their errors, six components";
  EXPECT_EQ(series.spectra[9].first, "torque_z_signal");
  for (const auto& [name, intensity] : series.spectra) {
    EXPECT_EQ(intensity.size(), series.times.size() * series.frequencies.size()) << name;
  }
}

TEST_F(SeriesFile, OthersAreRefused) {
  EXPECT_THROW(read_series(path), BadFile);
  std::ofstream(path) << "no HDF5";
  EXPECT_THROW(read_series(path), BadFile);
}

}  // namespace
}  // namespace sixdof::report
