#include <sixdof/query/registry.h>

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

class EmptyQuery final : public Query {
 public:
  EmptyQuery(const Mesh&, const Mesh&, const Settings&) {}
};

std::unique_ptr<Algorithm> named(const std::string& name) { return make_algorithm<EmptyQuery>({.name = name}); }

TEST(Status, HasWords) {
  EXPECT_EQ(to_string(Status::ok), "ok");
  EXPECT_EQ(to_string(Status::non_finite), "non_finite");
  EXPECT_EQ(to_string(Status::crashed), "crashed");
  EXPECT_EQ(to_string(Status::timed_out), "timed_out");
  EXPECT_EQ(to_string(Status::out_of_memory), "out_of_memory");
}

TEST(Registry, FindsByNameAndListsTheOthers) {
  Registry registry;
  registry.add(named("first"));
  registry.add(named("second-2"));
  EXPECT_EQ(registry.find("second-2").traits().name, "second-2");
  EXPECT_THAT([&] { registry.find("third"); },
              ::testing::ThrowsMessage<BadArgument>(::testing::HasSubstr("there are first, second-2")));
}

TEST(Registry, RefusesANameTwiceAndInvalidNames) {
  Registry registry;
  registry.add(named("first"));
  for (const char* name : {"first", "", "First", "a/b", "a b"}) {
    EXPECT_THROW(registry.add(named(name)), BadArgument) << name;
  }
  EXPECT_EQ(registry.all().size(), 1u);
}

TEST(Registry, GivesItsAlgorithmsAway) {
  Registry registry;
  registry.add(named("first"));
  registry.add(named("second"));
  const auto taken = registry.take();
  EXPECT_EQ(taken.at(1)->traits().name, "second");
  EXPECT_TRUE(registry.all().empty());
  registry.add(named("first"));
}

TEST(Registry, RefusesANullPointer) {
  Registry registry;
  EXPECT_THROW(registry.add(nullptr), BadArgument);
}

TEST(Registry, RefusesSweepsOfUnlikeLength) {
  const auto with_sweeps = [](std::vector<std::string> second) {
    const Parameter count = Parameter::count("voxels", "voxels", "1", 1, 9);
    Parameter other = count.swept(std::move(second));
    other.name = "points";
    return make_algorithm<EmptyQuery>({.name = "swept", .parameters = {count.swept({"1", "2"}), count, other}});
  };
  Registry registry;
  EXPECT_THROW(registry.add(with_sweeps({"1", "2", "3"})), BadArgument);
  EXPECT_NO_THROW(registry.add(with_sweeps({"3", "4"})));
}

/// What an algorithm does not override.
TEST(Query, AnswersNothingByDefault) {
  const Mesh mesh = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const auto algorithm = named("empty");
  const auto query = algorithm->prepare(mesh, mesh, algorithm->settings());
  EXPECT_EQ(query->collide(Pose{}).status, Status::unsupported);
  EXPECT_EQ(query->distance(Pose{}).status, Status::unsupported);
  EXPECT_EQ(query->respond(Pose{}).status, Status::unsupported);
  EXPECT_TRUE(query->work().empty());
}

TEST(Response, MovesItsTorqueWithTheReferencePoint) {
  // A force f at p has torque (p - c) x f about c.
  const Eigen::Vector3d p(0.3, -0.8, 1.1), f(2.0, 0.5, -0.7), c(1.0, 0.4, 0.2), d(-0.6, 2.0, 0.9);
  Response response;
  response.force = f;
  response.torque = (p - c).cross(f);
  response.reference = c;
  EXPECT_TRUE(response.about(d).torque.isApprox((p - d).cross(f), 1e-15));
}

}  // namespace
}  // namespace sixdof
