// sixdof hulls, as a user types it.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/save.h>
#include "bench/common/run_guarded.h"

#include "../geometry/shapes.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;

constexpr double k_rounding = 1e-9;  // of a distance, in diagonals

class Hulls : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("SIXDOF_CACHE=" + path("cache") + " " + SIXDOF_PROGRAM + " hulls " + arguments);
  }
  json found(const std::string& arguments) const {
    const auto done = run(arguments + " --json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out);
  }
  std::string save(const std::string& name, const Mesh& mesh) const {
    save_mesh(mesh, path(name));
    return path(name);
  }
};

TEST_F(Hulls, OfConvexBodiesChangeNothing) {
  const std::string box = save("box.off", shapes::box({0.3, 0.4, 0.5}));
  const json result = found("--a " + box);
  EXPECT_EQ(result.at("false_yes").at("apart").at("wrong"), 0);
  EXPECT_EQ(result.at("false_yes").at("near").at("wrong"), 0);
  EXPECT_EQ(result.at("false_no").at("overlapping").at("wrong"), 0);
  EXPECT_GT(result.at("false_yes").at("apart").at("of"), 300);
  EXPECT_GT(result.at("false_no").at("overlapping").at("of"), 300);
  EXPECT_NEAR(result.at("bias").at("p05"), 0.0, k_rounding);
  EXPECT_NEAR(result.at("bias").at("p95"), 0.0, k_rounding);
}

TEST_F(Hulls, FillTheHoleOfATorus) {
  const json result = found("--a torus-1k --b torus-1k");
  EXPECT_GT(result.at("false_yes").at("apart").at("wrong"), 0);
  EXPECT_GT(result.at("false_yes").at("near").at("wrong"), 0);
  EXPECT_EQ(result.at("false_no").at("overlapping").at("wrong"), 0) << "a hull contains its mesh";
  EXPECT_LT(result.at("bias").at("mean"), 0.0);
  EXPECT_LT(result.at("bias").at("p95"), k_rounding);
  const auto text = run("--a torus-1k");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, ::testing::HasSubstr("false yes, 1 % of the size or more apart"));
}

TEST_F(Hulls, PartsOfADecompositionTakeTheirPlace) {
  // An L of two boxes that share a face, and both boxes alone.
  const Mesh foot = shapes::box({0.6, 0.2, 0.2}, {0.2, 0.0, 0.0}), leg = shapes::box({0.2, 0.2, 0.6}, {0.0, 0.0, 0.4});
  const std::string torus = path("torus.off");
  ASSERT_EQ(test::run_program(std::string(SIXDOF_PROGRAM) + " models make torus-1k -o " + torus).exit_code, 0);
  const json whole = found("--a " + torus + " --parts-a " + torus + " --parts-b " + torus);
  EXPECT_EQ(whole.at("false_yes").at("apart").at("wrong"), 0) << "the mesh as its own part";
  EXPECT_NEAR(whole.at("bias").at("mean"), 0.0, k_rounding);
  const json parts =
      found("--a " + torus + " --parts-a " + save("foot.off", foot) + " --parts-a " + save("leg.off", leg));
  EXPECT_EQ(parts.at("triangles").at("stand_in_a"), foot.triangles().size() + leg.triangles().size());
}

}  // namespace
}  // namespace sixdof
