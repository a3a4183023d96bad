#include <sixdof/process/spare_process.h>

#include <latch>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "script.h"

namespace sixdof {
namespace {

using test::cone;
using test::script;
using test::torus;

/// Its distances are the number of its process.
std::unique_ptr<Algorithm> says_its_process(const std::string& can, ProcessLimits limits) {
  return script(R"(echo "{\"distance\": $$}")", limits, R"({"prepared":true})", can);
}

/// The processes of pairs that are prepared one after the other.
std::vector<double> processes(const std::string& can, ProcessLimits limits) {
  const auto algorithm = says_its_process(can, limits);
  std::vector<double> list;
  for (int i = 0; i < 3; ++i) {
    const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
    list.push_back(query->distance(Pose()).value.distance);
  }
  return list;
}

TEST(SpareProcess, APairMayTakeTheProcessOfTheOneBefore) {
  const std::vector<double> same = processes("\"again\"", {.reuse = true});
  EXPECT_EQ(same[0], same[1]);
  EXPECT_EQ(same[0], same[2]);
  for (const std::vector<double>& each : {processes("\"again\"", {}), processes("", {.reuse = true})}) {
    EXPECT_NE(each[0], each[1]);
    EXPECT_NE(each[1], each[2]);
  }
}

TEST(SpareProcess, TwoPairsAtATimeHaveTwoProcesses) {
  const auto algorithm = says_its_process("\"again\"", {.reuse = true});
  const auto first = algorithm->prepare(torus(), cone(), algorithm->settings());
  const auto second = algorithm->prepare(torus(), torus(), algorithm->settings());
  EXPECT_NE(first->distance(Pose()).value.distance, second->distance(Pose()).value.distance);
}

TEST(SpareProcess, PairsThatAreOneSetTakeTheProcessesOfTheSetBefore) {
  const auto algorithm = says_its_process("\"again\"", {.reuse = true});
  std::set<double> found;
  for (int i = 0; i < 3; ++i) {
    const auto first = algorithm->prepare(torus(), cone(), algorithm->settings());
    const auto second = algorithm->prepare(torus(), torus(), algorithm->settings());
    found.insert({first->distance(Pose()).value.distance, second->distance(Pose()).value.distance});
  }
  EXPECT_EQ(found.size(), 2);
}

TEST(SpareProcess, AProcessOfAnotherThreadIsNotTaken) {
  // It would end with that thread, in the middle of a query.
  const auto algorithm = says_its_process("\"again\"", {.reuse = true});
  double of_thread = 0.0;
  std::latch is_spare(1), may_end(1);
  std::jthread thread([&] {
    of_thread = algorithm->prepare(torus(), cone(), algorithm->settings())->distance(Pose()).value.distance;
    is_spare.count_down();
    may_end.wait();
  });
  is_spare.wait();
  const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
  const double first = query->distance(Pose()).value.distance;
  may_end.count_down();
  thread.join();
  EXPECT_NE(first, of_thread);
  EXPECT_EQ(query->distance(Pose()).value.distance, first);
}

TEST(SpareProcess, AProcessThatReadsFilesAgainSeesTheNextPair) {
  // The size of the vertices of A, from its file.
  const auto algorithm = script(R"(echo "{\"distance\": $(wc -c </proc/self/fd/3 | tr -d ' ')}")", {.reuse = true},
                                R"({"prepared":true})", "\"again\"");
  for (const Mesh* const mesh : {&torus(), &cone(), &torus()}) {
    const auto query = algorithm->prepare(*mesh, *mesh, algorithm->settings());
    EXPECT_EQ(query->distance(Pose()).value.distance, 24.0 * static_cast<double>(mesh->vertices().size()));
  }
}

TEST(SpareProcess, ARefusalOfASecondPairIsAskedOfANewProcess) {
  // The second prepare of a process fails, for what the first has left behind.
  const std::string leaky =
      R"sh('"$(if [ -z "$full" ]; then echo "{\"prepared\":true}"; else echo "{\"error\":\"full\"}"; fi)"; full='1)sh";
  const auto algorithm = script(R"(echo "{\"distance\": $$}")", {.reuse = true}, leaky, "\"again\"");
  std::vector<double> list;
  for (int i = 0; i < 2; ++i) {
    const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
    list.push_back(query->distance(Pose()).value.distance);
  }
  EXPECT_NE(list[0], list[1]);
}

TEST(SpareProcess, AProcessThatWasEndedIsNotTakenAgain) {
  const auto algorithm = script(R"(case $line in *collide*) exit 1;; *) echo "{\"distance\": $$}";; esac)",
                                {.reuse = true}, R"({"prepared":true})", "\"again\"");
  double first = 0.0;
  {
    const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
    first = query->distance(Pose()).value.distance;
    EXPECT_EQ(query->collide(Pose()).status, Status::crashed);
    EXPECT_NE(query->distance(Pose()).value.distance, first);
  }
  const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
  EXPECT_NE(query->distance(Pose()).value.distance, first);
}

}  // namespace
}  // namespace sixdof
