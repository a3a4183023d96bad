#include "bench/harness/query_command.h"

#include <gtest/gtest.h>

#include "bench/common/all_algorithms.h"

namespace sixdof::bench {
namespace {

TEST(QueryCommand, HasTheParametersThatAreNoDefault) {
  Registry registry;
  register_all_algorithms(registry);
  const Algorithm& vps = registry.find("vps");
  Settings settings = vps.settings();
  EXPECT_EQ(query_command("elephant", "my part.ply", vps, settings),
            "sixdof query --a elephant --b 'my part.ply' --algorithm vps");
  settings.set("voxel_size", "0.01");
  EXPECT_EQ(query_command("a", "b", vps, settings), "sixdof query --a a --b b --algorithm vps -p voxel_size=0.01");
}

TEST(QueryCommand, NamesTheProgramOfAnExternalAlgorithm) {
  Registry registry;
  const std::string command = "spheres=python3 " SIXDOF_SOURCE "/bench/external/example.py";
  register_all_algorithms(registry, {.external = {command}});
  const Algorithm& spheres = registry.find("spheres");
  EXPECT_EQ(query_command("a", "b", spheres, spheres.settings()),
            "sixdof query --a a --b b --algorithm spheres --external '" + command + "'");
  EXPECT_EQ(external_option(registry.find("exact")), "");
}

}  // namespace
}  // namespace sixdof::bench
