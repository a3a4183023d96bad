#include "bench/study/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

using ::testing::ElementsAre;

class NoQuery final : public Query {
 public:
  NoQuery(const Mesh&, const Mesh&, const Settings&) {}
};

std::unique_ptr<Algorithm> algorithm() {
  const Parameter voxel = Parameter::number("voxel", "edge", "diagonal", "0.01", 1e-4, 0.5).swept({"0.1", "0.01"});
  const Parameter points = Parameter::count("points", "points", "10", 1, 1e6).swept({"10", "1000"});
  return make_algorithm<NoQuery>(
      {.name = "mine", .parameters = {voxel, Parameter::choice("law", "law", "a", {"a", "b"}), points}});
}

std::vector<std::string> settings_of(const std::vector<SweepPoint>& points) {
  std::vector<std::string> list;
  for (const SweepPoint& point : points) list.push_back(point.settings.to_string());
  return list;
}

TEST(Sweep, SetsAllParametersTogether) {
  const auto mine = algorithm();
  const auto points = sweep_points(*mine, {});
  EXPECT_THAT(settings_of(points), ElementsAre("voxel=0.1,law=a,points=10", "voxel=0.01,law=a,points=1000"));
  EXPECT_THAT(points[1].assignments, ElementsAre("voxel=0.01", "points=1000"));
}

TEST(Sweep, OfAnAlgorithmWithoutOneIsItsDefault) {
  const auto plain = make_algorithm<NoQuery>({.name = "plain"});
  const auto points = sweep_points(*plain, {});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].assignments.empty());
}

TEST(Sweep, IsReplacedByEveryCombinationOfGivenValues) {
  const auto mine = algorithm();
  const auto points = sweep_points(*mine, {parse_swept_values("mine:law=a,b"), parse_swept_values("other:x=1"),
                                           parse_swept_values("mine:points=5,7")});
  EXPECT_THAT(settings_of(points), ElementsAre("voxel=0.01,law=a,points=5", "voxel=0.01,law=a,points=7",
                                               "voxel=0.01,law=b,points=5", "voxel=0.01,law=b,points=7"));
}

TEST(Sweep, TriesWarmStartsWhereNothingElseIsChosen) {
  const Parameter warm_start = Parameter::choice("warm_start", "start from the last answer", "off", {"off", "on"});
  const Parameter steps = Parameter::count("steps", "steps", "1", 1, 9).swept({"1", "9"});
  const auto warm = make_algorithm<NoQuery>({.name = "warm", .parameters = {warm_start}});
  const auto swept = make_algorithm<NoQuery>({.name = "swept", .parameters = {steps, warm_start}});
  const auto mine = algorithm();
  const auto found = warm_starts({warm.get(), swept.get(), mine.get()}, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(settings_of(sweep_points(*warm, found)), ElementsAre("warm_start=on", "warm_start=off"));
  EXPECT_TRUE(warm_starts({warm.get()}, {parse_swept_values("warm:warm_start=on")}).empty());
}

TEST(Sweep, TriesThreadsFromTheMostToOne) {
  const Parameter threads = Parameter::count("threads", "threads of a query", "1", 1, 64);
  const Parameter warm_start = Parameter::choice("warm_start", "start from the last answer", "off", {"off", "on"});
  const Parameter steps = Parameter::count("steps", "steps", "1", 1, 9).swept({"1", "9"});
  const auto wide = make_algorithm<NoQuery>({.name = "wide", .parameters = {warm_start, threads}});
  const auto swept = make_algorithm<NoQuery>({.name = "swept", .parameters = {steps, threads}});
  const auto mine = algorithm();
  const std::vector<const Algorithm*> all{wide.get(), swept.get(), mine.get()};
  const auto settings = [&](std::vector<SweptValues> values, unsigned most) {
    for (const SweptValues& more : thread_counts(all, values, most)) values.push_back(more);
    return settings_of(sweep_points(*wide, values));
  };
  EXPECT_EQ(thread_counts(all, {}, 6).size(), 1u);
  EXPECT_THAT(settings({}, 6),
              ElementsAre("warm_start=off,threads=6", "warm_start=off,threads=3", "warm_start=off,threads=1"));
  EXPECT_THAT(settings({parse_swept_values("wide:warm_start=on")}, 2),
              ElementsAre("warm_start=on,threads=2", "warm_start=on,threads=1"));
  EXPECT_THAT(settings({parse_swept_values("wide:threads=5")}, 2), ElementsAre("warm_start=off,threads=5"));
  EXPECT_TRUE(thread_counts(all, {}, 1).empty());
}

TEST(Sweep, RefusesWhatItCannotRead) {
  const auto mine = algorithm();
  for (const char* text : {"", "mine", "mine:law", "mine:law=", "law=a,b"}) {
    EXPECT_THROW(parse_swept_values(text), BadArgument) << text;
  }
  EXPECT_THROW(sweep_points(*mine, {parse_swept_values("mine:voxel=7")}), BadArgument);
  EXPECT_THROW(sweep_points(*mine, {parse_swept_values("mine:none=7")}), BadArgument);
}

}  // namespace
}  // namespace sixdof::study
