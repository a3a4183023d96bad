// What rows say of responses, first contacts and depths.

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/library_build.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/common/run_guarded.h"

#include "bench_program.h"

namespace sixdof {
namespace {

constexpr double k_set_tolerance = 1e-6;  // the set's tolerance, and rounding of the printed pose
constexpr double k_rounding = 1e-9;       // of a mean over the sample

using nlohmann::json;
using test::BenchProgram;
using test::row;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(BenchProgram, JudgesResponsesByTheirVolumeAndForce) {
  const json document = result("--sample 32 --benchmark_filter='^respond/.*/pair:torus-1k-cone-1k/volume:03$'");
  const json exact = row(document, "respond/algorithm:exact/pair:torus-1k-cone-1k/volume:03");
  EXPECT_EQ(exact.at("judged"), exact.at("configurations"));
  // The set's tolerance is 1e-9 of A's volume, and 3 % of it is the target.
  EXPECT_LE(exact.at("volume_error_max").get<double>(), 1e-9 / 0.03);
  EXPECT_EQ(exact.at("misses"), 0);
  for (const char* angle : {"gamma_F_deg", "gamma_max_F_deg", "gamma_T_deg", "gamma_max_T_deg"}) {
    EXPECT_EQ(exact.at(angle), 0) << angle;
  }
  EXPECT_EQ(exact.at("compared"), 32);
  for (const char* which : {"F", "T"}) {
    // The order of poses may change the rounding of answers.
    EXPECT_NEAR(exact.at(std::string("gain_") + which).get<double>(), 1.0, k_rounding) << which;
    EXPECT_LT(exact.at(std::string("magnitude_error_") + which), 1e-9) << which;
  }
  const json spheres = row(document, "respond/algorithm:ist/pair:torus-1k-cone-1k/volume:03");
  EXPECT_GT(spheres.at("magnitude_error_F"), 0.001);
  EXPECT_LT(spheres.at("magnitude_error_F"), 0.5);
  EXPECT_GT(spheres.at("gain_F"), 0.0);
  EXPECT_GT(spheres.at("gamma_F_deg"), 0.01);
  EXPECT_LT(spheres.at("gamma_F_deg"), 45);
  EXPECT_GT(spheres.at("gamma_max_F_deg"), spheres.at("gamma_F_deg"));
  EXPECT_GT(spheres.at("gamma_max_T_deg"), spheres.at("gamma_T_deg"));
}

TEST_F(BenchProgram, JudgesFirstContacts) {
  const std::string where = "/pair:torus-1k-cone-1k/motion:tumble/step:10";
  const json document = result("--sample 32 --benchmark_filter='^cast/algorithm:(exact|null|sampled)" + where + "$'");
  const json exact = row(document, "cast/algorithm:exact" + where);
  for (const char* count :
       {"failed", "mismatch", "early", "late_hits", "missed_hits", "phantom_hits", "false_starts"}) {
    EXPECT_EQ(exact.at(count), 0) << count;
  }
  EXPECT_GT(exact.at("hits"), 10);
  EXPECT_LE(exact.at("grazing"), 1);
  EXPECT_GE(exact.at("max_ns"), exact.at("p50_ns"));
  EXPECT_EQ(exact.at("sixdof").at("order"), "tumble/10");
  const json null = row(document, "cast/algorithm:null" + where);
  EXPECT_EQ(null.at("missed_hits"), null.at("hits"));
  EXPECT_EQ(null.at("mismatch"), null.at("hits"));
  EXPECT_EQ(row(document, "cast/algorithm:sampled" + where).at("failed"), 0);
}

TEST_F(BenchProgram, JudgesDepths) {
  const std::string where = "/pair:torus-1k-cone-1k/volume:03";
  const json document =
      result("--sample 8 --benchmark_filter='^depth/algorithm:(exact-depth|exact-penetration|fcl-contacts|null)" +
             where + "$'");
  for (const char* algorithm : {"exact-depth", "fcl-contacts"}) {
    const json found = row(document, fmt::format("depth/algorithm:{}{}", algorithm, where));
    EXPECT_EQ(found.at("failed"), 0);
    EXPECT_EQ(found.at("judged").get<double>() + found.at("open_depths").get<double>(), found.at("configurations"));
    EXPECT_GE(found.at("judged"), 1);
    EXPECT_LE(found.at("too_shallow").get<double>() + found.at("too_deep").get<double>(), found.at("judged"));
    EXPECT_GT(found.at("depth_ratio"), 0.0);
    EXPECT_LE(found.at("depth_of_ray"), 1.0 + 1e-6);
    EXPECT_FALSE(found.contains("mismatch"));  // neither says that it is the depth of the bodies
  }
  const json right = row(document, "depth/algorithm:exact-penetration" + where);
  EXPECT_EQ(right.at("mismatch"), 0);
  EXPECT_EQ(right.at("too_shallow"), 0);
  EXPECT_EQ(right.at("too_deep"), 0);
  const json null = row(document, "depth/algorithm:null" + where);
  EXPECT_EQ(null.at("missed_depths"), null.at("judged"));
  EXPECT_EQ(null.at("too_shallow"), null.at("judged"));
  EXPECT_EQ(null.at("too_shallow_max"), 1.0);
}

}  // namespace
}  // namespace sixdof
