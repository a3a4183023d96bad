#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench_program.h"

namespace sixdof {
namespace {

using nlohmann::json;
using test::BenchProgram;
using test::row;

const std::string k_where = "/pair:torus-1k-cone-1k/volume:03";

TEST_F(BenchProgram, JudgesContacts) {
  const json document =
      result("--sample 16 --benchmark_filter='^contacts/algorithm:(exact-contacts|fcl-contacts|null)" + k_where + "$'");
  const json exact = row(document, "contacts/algorithm:exact-contacts" + k_where);
  for (const char* count : {"failed", "non_finite", "mismatch", "off_bodies", "reversed_normals", "without_contact",
                            "exchange_flips", "moved_flips", "full_answers"}) {
    EXPECT_EQ(exact.at(count), 0) << count;
  }
  EXPECT_EQ(exact.at("judged"), 16);
  EXPECT_GT(exact.at("contacts_mean"), 5);
  EXPECT_LT(exact.at("contact_off_max"), 1e-9);
  EXPECT_LT(exact.at("contact_normal_deg"), 0.01);
  EXPECT_NEAR(exact.at("contact_depth_ratio"), 1.0, 1e-6);
  EXPECT_LT(exact.at("contact_force_deg"), 60);
  EXPECT_LT(exact.at("uncovered_max"), 0.05);
  EXPECT_LT(exact.at("exchange_points"), 1e-9);
  EXPECT_LT(exact.at("moved_points"), 1e-9);
  EXPECT_GE(exact.at("max_ns"), exact.at("p50_ns"));
  EXPECT_EQ(exact.at("sixdof").at("query"), "contacts");
  EXPECT_FALSE(exact.contains("step_normal_deg")) << "of motions only";

  const json null = row(document, "contacts/algorithm:null" + k_where);
  EXPECT_EQ(null.at("without_contact"), 16);
  EXPECT_EQ(null.at("mismatch"), 16);

  const json fcl = row(document, "contacts/algorithm:fcl-contacts" + k_where);
  EXPECT_EQ(fcl.at("without_contact"), 0);
  EXPECT_GT(fcl.at("contacts_mean"), 1);
}

TEST_F(BenchProgram, ContactsAlongMotions) {
  const std::string name = "contacts/algorithm:exact-contacts" + k_where + "/order:motion";
  const json motion = row(result("--sample 2 --benchmark_filter='^" + name + "$'"), name);
  EXPECT_EQ(motion.at("sixdof").at("order"), "motion");
  EXPECT_GT(motion.at("step_center_mean"), 0);
  EXPECT_LT(motion.at("step_center_max"), 0.01) << "B moves by 1e-4 of A's diagonal in a step";
  EXPECT_LT(motion.at("step_force_max_deg"), 5);
  EXPECT_GE(motion.at("step_points_max"), motion.at("step_points_mean"));
  EXPECT_FALSE(motion.contains("exchange_points"));
}

}  // namespace
}  // namespace sixdof
