#include <sixdof/algorithm/ist/prototype.h>

#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/ist/clearance_model.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof::ist {
namespace {

/// Each start alone has the prototype that it has beside others, in whatever slot.
TEST(FindPrototypes, DoNotDependOnTheOtherStarts) {
  const Mesh mesh = load_model("torus-knot-2k");
  const Tree tree(mesh);
  const FreeSpace space{tree, SphereIndex(mesh.diagonal())};
  std::vector<Start> starts;
  for (std::size_t i = 0; i < mesh.vertices().size(); i += 17) {
    starts.push_back({mesh.vertices()[i] + 0.01 * (mesh.center() - mesh.vertices()[i]), 0.1 * mesh.diagonal()});
  }
  ASSERT_GT(starts.size(), 2 * ClearanceModels::k_slots);
  const std::vector<Prototype> together = find_prototypes(space, starts, 100);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Prototype alone = find_prototypes(space, {&starts[i], 1}, 100 + i).front();
    EXPECT_EQ(together[i].position, alone.position) << i;
    EXPECT_EQ(together[i].clearance, alone.clearance) << i;
    EXPECT_EQ(together[i].order, 100 + i);
    EXPECT_GE(together[i].clearance, 0.0);
  }
}

TEST(FindPrototypes, DiscardStartsWithoutTheClearanceTheyNeed) {
  const Mesh mesh = load_model("torus-200");
  const Tree tree(mesh);
  const FreeSpace space{tree, SphereIndex(mesh.diagonal())};
  const Eigen::Vector3d on_surface = mesh.vertices()[0];
  const std::vector<Start> starts{{on_surface, 1.0, 0.5}, {on_surface, 1.0, 0.0}};
  for (const Prototype& prototype : find_prototypes(space, starts, 0)) EXPECT_EQ(prototype.clearance, 0.0);
}

}  // namespace
}  // namespace sixdof::ist
