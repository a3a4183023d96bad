#include <sixdof/configuration/set_meshes.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>

#include "folder_test.h"
#include "shapes.h"

namespace sixdof {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const Mesh k_part = test::tetrahedron_mesh({0, 0, 0}, 1.7);
const Mesh k_changed = test::tetrahedron_mesh({0, 0, 0}, 0.9);

/// The working directory is the test's folder.
class SetMeshes : public test::FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::create_directories(folder_ / "parts");
    fs::create_directories(folder_ / "sets");
    fs::current_path(folder_);
    save_mesh(k_part, "parts/part.ply");
    wanted_ = identify(load_model("parts/part.ply"), "parts/part.ply");
  }
  void TearDown() override {
    fs::current_path(before_);
    FolderTest::TearDown();
  }
  std::string found() const { return find_mesh(wanted_, set_).hash(); }

  const fs::path before_ = fs::current_path();
  const fs::path set_ = "sets/set.h5";
  MeshIdentity wanted_;
};

TEST_F(SetMeshes, IdentityOfAFileSaysWhereItIs) {
  EXPECT_EQ(wanted_.name, "part");
  EXPECT_EQ(wanted_.hash, k_part.hash());
  EXPECT_EQ(wanted_.path, "parts/part.ply");
  EXPECT_TRUE(fs::equivalent(wanted_.absolute_path, folder_ / "parts/part.ply"));
  const MeshIdentity model = identify(load_model("cone-1k"), "cone-1k");
  EXPECT_EQ(model.name, "cone-1k");
  EXPECT_EQ(model.path + model.absolute_path, "");
}

TEST_F(SetMeshes, AreFoundWhereTheyWereAndWhereTheyMayHaveMovedTo) {
  EXPECT_EQ(found(), k_part.hash());
  fs::create_directories("elsewhere");
  fs::current_path("elsewhere");
  EXPECT_EQ(found(), k_part.hash()) << "by the absolute path";
  fs::current_path("..");
  for (const char* const moved : {"sets/part.ply", "sets/parts/part.ply"}) {
    fs::create_directories("sets/parts");
    fs::rename("parts/part.ply", moved);
    EXPECT_EQ(found(), k_part.hash()) << moved;
    EXPECT_EQ(find_mesh(wanted_, set_).name(), "part");
    fs::rename(moved, "parts/part.ply");
  }
}

TEST_F(SetMeshes, TheHashDecidesBetweenFilesOfOneName) {
  fs::rename("parts/part.ply", "sets/part.ply");
  save_mesh(k_changed, "parts/part.ply");
  EXPECT_EQ(found(), k_part.hash());
  // A file that only has the name says nothing about the mesh.
  save_mesh(k_changed, "sets/part.ply");
  EXPECT_THAT([&] { found(); }, ThrowsMessage<BadFile>(AllOf(HasSubstr("sets/set.h5: mesh part: parts/part.ply"),
                                                             HasSubstr(k_part.hash()), HasSubstr(k_changed.hash()))));
}

TEST_F(SetMeshes, SaysWhereItLookedForAMeshThatIsMissing) {
  fs::remove("parts/part.ply");
  EXPECT_THAT([&] { found(); },
              ThrowsMessage<BadFile>(AllOf(HasSubstr("sets/set.h5: mesh part: no file parts/part.ply or "
                                                     "sets/parts/part.ply or /"),
                                           HasSubstr("--a or --b says where it is"))));
  std::ofstream("parts/part.ply") << "ply\n";
  EXPECT_THAT([&] { found(); }, ThrowsMessage<BadFile>(HasSubstr("mesh part: parts/part.ply: ")));
}

TEST_F(SetMeshes, ACallerMayKnowBetter) {
  save_mesh(k_changed, "parts/changed.ply");
  EXPECT_EQ(find_mesh(wanted_, set_, "./parts/part.ply").name(), "part");
  EXPECT_THAT([&] { find_mesh(wanted_, set_, "parts/changed.ply"); },
              ThrowsMessage<BadFile>(HasSubstr("mesh part: parts/changed.ply has content hash " + k_changed.hash())));
}

TEST_F(SetMeshes, WithoutAPathAreModels) {
  const Mesh cone = load_model("cone-1k");
  MeshIdentity model{.name = "cone-1k", .hash = cone.hash()};
  EXPECT_EQ(find_mesh(model, set_).hash(), cone.hash());
  // A file that was a copy of a model.
  model.path = "lost/cone-1k.ply";
  EXPECT_EQ(find_mesh(model, set_).hash(), cone.hash());
  model = {.name = "cone-1k", .hash = k_part.hash()};
  EXPECT_THAT([&] { find_mesh(model, set_); }, ThrowsMessage<BadFile>(HasSubstr(k_part.hash())));
  model.hash.clear();
  EXPECT_EQ(find_mesh(model, set_).hash(), cone.hash());
  EXPECT_THAT([&] { find_mesh({.name = "conee"}, set_); },
              ThrowsMessage<BadArgument>(AllOf(HasSubstr("sets/set.h5: mesh conee: "), HasSubstr("--a or --b"))));
}

}  // namespace
}  // namespace sixdof
