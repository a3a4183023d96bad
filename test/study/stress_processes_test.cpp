// A library that aborts, never returns or takes all memory ends its cell and nothing else.

#include "bench/study/stress_processes.h"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/query/registry.h>
#include "bench/study/stress_worker.h"

namespace sixdof::study {
namespace {

using stability::Verdict;

enum class Way {
  abort,
  loop,
  memory,
  exit
};

/// Ends at the first pose that is far from the origin.
template <Way way>
class Deadly : public Query {
 public:
  Deadly(const Mesh& /*a*/, const Mesh& /*b*/, const Settings& /*settings*/) {}
  Outcome<bool> collide(const Pose& X_AB) override {
    if (X_AB.t.norm() < 20.0) return false;
    if (way == Way::abort) std::abort();
    if (way == Way::exit) std::exit(0);
    if (way == Way::loop) {
      for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    }
    if (way == Way::memory) {
      for (std::vector<std::vector<double>> all;;) all.emplace_back(1'000'000, 1.0);
    }
    return false;
  }
};

template <Way way>
std::unique_ptr<Algorithm> deadly(const char* name) {
  return make_algorithm<Deadly<way>>({.name = name, .version = "1", .summary = "", .answers = {.collide = true}});
}

const Registry& algorithms() {
  static const Registry registry = [] {
    Registry all;
    all.add(make_exact_algorithm());
    all.add(deadly<Way::abort>("aborts"));
    all.add(deadly<Way::loop>("loops"));
    all.add(deadly<Way::memory>("allocates"));
    all.add(deadly<Way::exit>("exits"));
    return all;
  }();
  return registry;
}

StressCell run(const char* algorithm, const char* family, double timeout_s = 20.0) {
  const StressPlan plan{.algorithms = {&algorithms().find(algorithm)},
                        .families = {&stability::find_family(family)},
                        .effort = {.generations = 0},
                        .timeout_s = timeout_s,
                        .memory_bytes = 1.5e8};
  return run_stress(plan, [](std::size_t, std::size_t) {}).at(0);
}

TEST(StressProcesses, WaysToDieAreToldApartAndHaveTheirPose) {
  const auto expect = [](const StressCell& cell, Verdict verdict) {
    EXPECT_EQ(cell.worst.verdict, verdict) << cell.worst.words;
    const stability::Case member = make_case(*cell.family, cell.id);
    ASSERT_LT(cell.worst.shot, member.shots.size());
    EXPECT_GE(member.shots[cell.worst.shot].X_AB.t.norm(), 20.0);
  };
  expect(run("aborts", "offset"), Verdict::crashed);
  expect(run("loops", "offset", 0.5), Verdict::hung);
}

TEST(StressProcesses, AllMemoryTakenEndsACell) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "their shadow memory counts";
#endif
  const StressCell memory = run("allocates", "offset");
  EXPECT_EQ(memory.worst.verdict, Verdict::out_of_memory) << memory.worst.words;
}

TEST(StressProcesses, AnEndWithoutAnAnswerIsACrash) {
  const StressCell cell = run("exits", "offset");
  EXPECT_EQ(cell.worst.verdict, Verdict::crashed) << cell.worst.words;
}

TEST(StressProcesses, AFaultEndsItsCellOnly) {
  const Algorithm& good = algorithms().find("exact");
  const StressPlan plan{.algorithms = {&algorithms().find("aborts"), &good},
                        .families = {&stability::find_family("offset"), &stability::find_family("scale")},
                        .effort = {}};
  std::size_t last = 0;
  const std::vector<StressCell> cells = run_stress(plan, [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 4u);
    last = done;
  });
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(last, 4u);
  EXPECT_EQ(cells[0].worst.verdict, Verdict::crashed);
  EXPECT_EQ(cells[1].worst.verdict, Verdict::exact) << cells[1].worst.words;
  EXPECT_EQ(cells[3].worst.verdict, Verdict::exact) << cells[3].worst.words;
  EXPECT_EQ(cells[3].algorithm, &good);
}

TEST(StressProcesses, GivesWhatOneProcessGives) {
  const stability::Family& family = stability::find_family("motion");
  const StressWatch nobody{.begins_case = [](const CaseId&) {}, .prepares = [] {}, .asks = [](const Pose&) {}};
  const StressCell here = run_cell(family, algorithms().find("exact"), StressSettings::coarsest, {}, 1, nobody);
  const StressCell there = run("exact", "motion");
  EXPECT_EQ(here.cases, there.cases);
  EXPECT_EQ(here.worst.value, there.worst.value);
  EXPECT_EQ(here.worst.excess, there.worst.excess);
  EXPECT_EQ(here.worst.metric, there.worst.metric);
  EXPECT_EQ(here.worst.words, there.worst.words);
  EXPECT_EQ(here.settings, there.settings);
  EXPECT_EQ(here.id.field, there.id.field);
  EXPECT_EQ(here.id.genes, there.id.genes);
}

TEST(StressProcesses, WhatProgressThrowsEndsTheRun) {
  const StressPlan plan{
      .algorithms = {&algorithms().find("loops")}, .families = {&stability::find_family("offset")}, .effort = {}};
  const auto begin = std::chrono::steady_clock::now();
  const auto throw_while_it_runs = [&](std::size_t, std::size_t) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(200)) throw Interrupted("enough");
  };
  EXPECT_THROW(run_stress(plan, throw_while_it_runs), Interrupted);
}

}  // namespace
}  // namespace sixdof::study

int main(int argc, char** argv) {
  using namespace sixdof;
  const auto find = [](const std::string& name, const auto& /*external*/) -> const Algorithm& {
    return study::algorithms().find(name);
  };
  if (const auto code = study::run_stress_cell_if_asked(argc, argv, find)) return *code;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
