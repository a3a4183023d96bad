#include <sixdof/conformance/checks.h>

#include <cstddef>
#include <exception>
#include <iterator>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/conformance/poses.h>

namespace sixdof::conformance {
namespace {

std::vector<Answers> ask_all(const Subject& subject, Query& query, const std::vector<Case>& cases) {
  std::vector<Answers> answers;
  for (const Case& each : cases) answers.push_back(subject.ask(query, each.pose.X_AB));
  return answers;
}

/// Answers `again` must repeat `first`, case by case.
void expect_all_repeated(const Subject& subject, const Pair& pair, const std::vector<Answers>& first,
                         const std::vector<Answers>& again, Findings& findings) {
  for (std::size_t i = 0; i < pair.cases.size(); ++i) {
    expect_repeated(subject, first[i], again[i], {subject, pair.a, pair.b, pair.cases[i].pose}, findings);
  }
}

/// No answer to a pose that is not finite, with words; the next pose is answered as before.
void check_poses_not_finite(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs(subject.traits().body).front();
  const auto query = subject.prepare(pair.a, pair.b);
  const Case& good = pair.cases.front();
  const Answers before = subject.ask(*query, good.pose.X_AB);
  constexpr const char* k_not_finite[] = {"a NaN in t", "an infinity in R", "R of NaN"};
  std::vector<Pose> bad(std::size(k_not_finite), good.pose.X_AB);
  bad[0].t.y() = std::numeric_limits<double>::quiet_NaN();
  bad[1].R(0, 1) = std::numeric_limits<double>::infinity();
  bad[2].R.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const Kind kind : k_kinds) {
    if (!subject.answers(kind)) continue;
    for (std::size_t i = 0; i < bad.size(); ++i) {
      const Answers answers = subject.ask(*query, kind, bad[i]);
      const Status status = answers.status(kind);
      const std::string asked = fmt::format("{} at a pose with {}", to_string(kind), k_not_finite[i]);
      if (status != Status::failed && status != Status::non_finite) {
        findings.fail(fmt::format("{}: status {}; it should be failed or non_finite", asked, to_string(status)));
      }
      if (answers.words.empty()) findings.fail(fmt::format("{}: no words", asked));
    }
    expect_repeated(subject, before, subject.ask(*query, good.pose.X_AB), {subject, pair.a, pair.b, good.pose},
                    findings);
  }
}

void check_unsupported(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs(subject.traits().body).front();
  const auto query = subject.prepare(pair.a, pair.b);
  for (const Case& each : pair.cases) {
    for (const Kind kind : k_kinds) {
      if (subject.answers(kind)) continue;
      const Status status = subject.ask(*query, kind, each.pose.X_AB).status(kind);
      if (status == Status::unsupported) continue;
      findings.fail(fmt::format("{}: status {}; the traits say that this kind is not answered", to_string(kind),
                                to_string(status)),
                    {subject, pair.a, pair.b, each.pose});
    }
    subject.ask(*query, each.pose.X_AB);
  }
}

void check_repeated_queries(const Subject& subject, Findings& findings) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto query = subject.prepare(pair.a, pair.b);
    const std::vector<Answers> first = ask_all(subject, *query, pair.cases);
    // Other poses come before each than the first time.
    for (std::size_t i = pair.cases.size(); i-- > 0;) {
      const TypedPose& pose = pair.cases[i].pose;
      expect_repeated(subject, first[i], subject.ask(*query, pose.X_AB), {subject, pair.a, pair.b, pose}, findings);
    }
  }
}

void check_fresh_queries(const Subject& subject, Findings& findings) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto query = subject.prepare(pair.a, pair.b);
    const std::vector<Answers> first = ask_all(subject, *query, pair.cases);
    for (const std::size_t i : {pair.cases.size() - 1, pair.cases.size() / 2}) {
      const TypedPose& pose = pair.cases[i].pose;
      const auto fresh = subject.prepare(pair.a, pair.b);
      expect_repeated(subject, first[i], subject.ask(*fresh, pose.X_AB), {subject, pair.a, pair.b, pose}, findings);
    }
  }
}

/// Each thread prepares and asks a query of its own, several of one pair at the same time.
void check_threads(const Subject& subject, Findings& findings) {
  constexpr std::size_t k_threads_of_a_pair = 2;
  for (const Pair* pair : {&pairs(subject.traits().body)[0], &pairs(subject.traits().body)[3]}) {
    const auto query = subject.prepare(pair->a, pair->b);
    const std::vector<Answers> alone = ask_all(subject, *query, pair->cases);
    std::vector<std::vector<Answers>> found(2 * k_threads_of_a_pair);
    std::vector<std::string> thrown(found.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < found.size(); ++i) {
      threads.emplace_back([&, i] {
        try {
          const auto own = subject.prepare(pair->a, pair->b);
          for (int round = 0; round < 3; ++round) found[i] = ask_all(subject, *own, pair->cases);
        } catch (const std::exception& e) {
          thrown[i] = fmt::format("thrown in a thread: {}", e.what());
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!thrown[i].empty()) {
        findings.fail(thrown[i]);
      } else {
        expect_all_repeated(subject, *pair, alone, found[i], findings);
      }
    }
  }
}

/// One mesh object as A and B, and two equal ones.
void check_same_mesh(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs(subject.traits().body).front();
  const Mesh copy = pair.a;
  const auto shared = subject.prepare(pair.a, pair.a), two = subject.prepare(pair.a, copy);
  const double diagonal = pair.a.diagonal();
  for (const double reach : {0.3, 0.6, 1.2}) {
    const TypedPose pose = TypedPose::of({generic_motion(21).R, reach * diagonal * Eigen::Vector3d(0.48, 0.6, 0.64)});
    expect_repeated(subject, subject.ask(*two, pose.X_AB), subject.ask(*shared, pose.X_AB),
                    {subject, pair.a, pair.a, pose}, findings);
  }
}

/// Settings need not outlive prepare(). They are moved away, so that whoever kept a reference finds no parameter.
void check_moved_settings(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs(subject.traits().body).front();
  const auto query = subject.prepare(pair.a, pair.b);
  Settings settings = subject.settings;
  const auto other = subject.algorithm.prepare(pair.a, pair.b, settings);
  const Settings elsewhere = std::exchange(settings, Settings());
  expect_all_repeated(subject, pair, ask_all(subject, *query, pair.cases), ask_all(subject, *other, pair.cases),
                      findings);
}

constexpr Check k_checks[] = {
    {"PosesNotFinite", Needs::nothing, check_poses_not_finite},
    {"Unsupported", Needs::a_missing_kind, check_unsupported},
    {"RepeatedQueries", Needs::nothing, check_repeated_queries},
    {"FreshQueries", Needs::nothing, check_fresh_queries},
    {"Threads", Needs::nothing, check_threads},
    {"SameMesh", Needs::nothing, check_same_mesh},
    {"MovedSettings", Needs::nothing, check_moved_settings},
};

}  // namespace

std::span<const Check> state_checks() { return k_checks; }

}  // namespace sixdof::conformance
