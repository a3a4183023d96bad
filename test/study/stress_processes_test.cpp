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

namespace sixdof::study {
namespace {

using stability::Verdict;

enum class Way {
  abort,
  loop,
  memory,
  exit,
  none
};

/// Ends at the first pose that is far from the origin.
template <Way way>
class Deadly : public Query {
 public:
  Deadly(const Mesh&, const Mesh&, const Settings&) {}
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
std::unique_ptr<Algorithm> deadly() {
  return make_algorithm<Deadly<way>>({.name = "deadly", .version = "1", .summary = "", .answers = {.collide = true}});
}

StressCell run(const Algorithm& algorithm, const char* family, double silence_s = 20.0) {
  const StressPlan plan{.algorithms = {&algorithm},
                        .families = {&stability::find_family(family)},
                        .effort = {.generations = 0},
                        .silence_s = silence_s,
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
  expect(run(*deadly<Way::abort>(), "offset"), Verdict::crashed);
  expect(run(*deadly<Way::loop>(), "offset", 0.5), Verdict::hung);
}

TEST(StressProcesses, AllMemoryTakenEndsACell) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "their shadow memory counts";
#endif
  const StressCell memory = run(*deadly<Way::memory>(), "offset");
  EXPECT_EQ(memory.worst.verdict, Verdict::out_of_memory) << memory.worst.words;
}

TEST(StressProcesses, AnEndWithoutAnAnswerIsACrash) {
  const StressCell cell = run(*deadly<Way::exit>(), "offset");
  EXPECT_EQ(cell.worst.verdict, Verdict::crashed) << cell.worst.words;
}

TEST(StressProcesses, AFaultEndsItsCellOnly) {
  const std::unique_ptr<Algorithm> bad = deadly<Way::abort>(), good = make_exact_algorithm();
  const StressPlan plan{.algorithms = {bad.get(), good.get()},
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
  EXPECT_EQ(cells[3].algorithm, good.get());
}

TEST(StressProcesses, GivesWhatOneProcessGives) {
  const std::unique_ptr<Algorithm> exact = make_exact_algorithm();
  const stability::Family& family = stability::find_family("motion");
  const StressWatch nobody{.begins_case = [](const CaseId&) {}, .prepares = [] {}, .asks = [](const Pose&) {}};
  const StressCell here = run_cell(family, *exact, {}, 1, nobody), there = run(*exact, "motion");
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
  const std::unique_ptr<Algorithm> loop = deadly<Way::loop>();
  const StressPlan plan{.algorithms = {loop.get()}, .families = {&stability::find_family("offset")}, .effort = {}};
  EXPECT_THROW(run_stress(plan, [](std::size_t, std::size_t) { throw Interrupted("enough"); }), Interrupted);
}

}  // namespace
}  // namespace sixdof::study
