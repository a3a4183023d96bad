#include "bench/harness/outliers.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/all_algorithms.h"

namespace sixdof::bench {
namespace {

TEST(Outliers, CommandHasTheParametersThatAreNoDefault) {
  Registry registry;
  register_all_algorithms(registry);
  const Algorithm& vps = registry.find("vps");
  Settings settings = vps.settings();
  EXPECT_EQ(query_command("elephant", "my part.ply", vps, settings),
            "sixdof query --a elephant --b 'my part.ply' --algorithm vps");
  settings.set("voxel_size", "0.01");
  EXPECT_EQ(query_command("a", "b", vps, settings), "sixdof query --a a --b b --algorithm vps -p voxel_size=0.01");
}

TEST(Outliers, HaveTheResponseBesideThePose) {
  Outliers outliers{.a = "a", .b = "b", .command = "ask", .by_counter = {}};
  Response exact;
  exact.force = {1.0, 0.0, 0.0};
  exact.reference = {4.0, 5.0, 6.0};
  outliers.by_counter["gamma_max_F_deg"] = {
      .X_AB = Pose{.t = {0.1, 0.0, 0.0}},
      .response = ComparedResponse{.force = {0.0, 2.0, 0.0}, .torque = {0.0, 0.0, 3.0}, .exact = exact}};
  outliers.add("mismatch", std::nullopt);
  const nlohmann::json object = to_json_object(outliers);
  EXPECT_EQ(object.at("poses").size(), 1u);
  EXPECT_EQ(object.at("poses").at("gamma_max_F_deg"), "0.1 0 0 1 0 0 0");
  const nlohmann::json response = object.at("responses").at("gamma_max_F_deg");
  EXPECT_EQ(response.at("force"), (nlohmann::json{0.0, 2.0, 0.0}));
  EXPECT_EQ(response.at("torque"), (nlohmann::json{0.0, 0.0, 3.0}));
  EXPECT_EQ(response.at("exact_force"), (nlohmann::json{1.0, 0.0, 0.0}));
  EXPECT_EQ(response.at("reference"), (nlohmann::json{4.0, 5.0, 6.0}));
}

}  // namespace
}  // namespace sixdof::bench
