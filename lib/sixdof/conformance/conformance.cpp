#include <sixdof/conformance/conformance.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <iostream>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/subject.h>
#include <sixdof/query/registrar.h>
#include <sixdof/query/registry.h>

namespace sixdof::conformance {

std::unique_ptr<Algorithm> Source::make() const {
  if (make_) return make_();
  for (const auto& make : Registrar::makers()) {
    auto algorithm = make();
    if (algorithm->traits().name == name_) return algorithm;
  }
  throw BadArgument(fmt::format("SIXDOF_CONFORMANCE: no Registrar of this program makes an algorithm \"{}\"", name_));
}

namespace {

struct Added {
  Source source;
  Declaration declaration;
};

std::vector<Added>& added() {
  static std::vector<Added> list;
  return list;
}

/// What is known before anything is prepared: the algorithm's traits and the declaration.
void check_declaration(const Subject& subject);

constexpr Check k_declaration{"Declaration", always, check_declaration};

std::vector<const Check*> all_checks() {
  std::vector<const Check*> list{&k_declaration};
  for (const auto& room : {agreement_checks(), invariance_checks(), state_checks()}) {
    for (const Check& check : room) list.push_back(&check);
  }
  return list;
}

void check_declaration(const Subject& subject) {
  const Traits& traits = subject.traits();
  EXPECT_FALSE(traits.version.empty()) << "Traits::version is empty";
  EXPECT_FALSE(traits.summary.empty()) << "Traits::summary is empty";
  EXPECT_TRUE(traits.answers.collide || traits.answers.distance || traits.answers.respond)
      << "Traits::answers has no kind of query";
  EXPECT_EQ(traits.answers.respond, traits.law != ResponseLaw::none)
      << "Traits::law belongs to an algorithm that answers respond, and to no other";
  const std::vector<const Check*> checks = all_checks();
  for (const KnownFailure& known : subject.declared.known_failures) {
    const auto found = std::ranges::find(checks, known.check, [](const Check* check) { return check->name; });
    EXPECT_TRUE(found != checks.end() && (*found)->applies(traits.answers))
        << "known failure \"" << known.check << "\": no such check of this algorithm";
    EXPECT_NE(known.reason, "") << "known failure \"" << known.check << "\": no reason";
  }
}

/// A GoogleTest case: one check of one algorithm; or, without a check, why there is no algorithm.
struct Instance {
  std::shared_ptr<const Subject> subject;
  const Check* check = nullptr;
  std::string name;
  std::string problem;
};

/// GoogleTest names consist of letters, digits and '_'.
std::string test_name(std::string algorithm, const char* check) {
  std::ranges::replace_if(
      algorithm, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return algorithm + "_" + check;
}

/// Called when GoogleTest begins, after every Registrar of the program.
std::vector<Instance> make_instances() {
  std::vector<Instance> list;
  for (const Added& each : added()) {
    try {
      auto algorithm = each.source.make();
      // As the programs do: refuses names and sweeps that they cannot use.
      Registry registry;
      registry.add(each.source.make());
      const auto subject = std::make_shared<const Subject>(std::move(algorithm), each.declaration);
      for (const Check* check : all_checks()) {
        if (!check->applies(subject->traits().answers)) continue;
        list.push_back({subject, check, test_name(subject->traits().name, check->name), {}});
      }
    } catch (const std::exception& e) {
      list.push_back({nullptr, nullptr, fmt::format("Unusable_{}", list.size()), e.what()});
    }
  }
  return list;
}

/// Runs the check with its failures held back. @return the first failure, empty if the check passes
std::string first_failure_of(const Check& check, const Subject& subject) {
  ::testing::TestPartResultArray results;
  {
    const ::testing::ScopedFakeTestPartResultReporter held_back(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ALL_THREADS, &results);
    try {
      check.run(subject);
    } catch (const std::exception& e) {
      ADD_FAILURE() << "thrown: " << e.what();
    }
  }
  for (int i = 0; i < results.size(); ++i) {
    if (results.GetTestPartResult(i).failed()) return results.GetTestPartResult(i).message();
  }
  return {};
}

void run_known_failure(const Instance& instance, const KnownFailure& known) {
  const std::string failure = first_failure_of(*instance.check, *instance.subject);
  EXPECT_NE(failure, "") << instance.name << " is listed as known, but passes: " << known.reason;
  std::cout << "known failure: " << known.reason << (known.issue.empty() ? "" : " (" + known.issue + ")") << "\n"
            << failure << "\n";
}

class Conformance : public ::testing::TestWithParam<Instance> {};

std::ostream& operator<<(std::ostream& out, const Instance& instance) {
  if (instance.subject == nullptr) return out << instance.problem;
  return out << instance.subject->traits().name << " " << instance.subject->traits().version;
}

TEST_P(Conformance, Of) {
  const Instance& instance = GetParam();
  ASSERT_NE(instance.subject, nullptr) << instance.problem;
  const auto& known_failures = instance.subject->declared.known_failures;
  const auto known = std::ranges::find(known_failures, std::string(instance.check->name),
                                       [](const KnownFailure& k) { return k.check; });
  if (known != known_failures.end() && instance.check != &k_declaration) {
    run_known_failure(instance, *known);
  } else {
    instance.check->run(*instance.subject);
  }
}

/// A program may name no algorithm, for instance where an optional library is missing.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Conformance);
INSTANTIATE_TEST_SUITE_P(Algorithms, Conformance, ::testing::ValuesIn(make_instances()),
                         [](const auto& each) { return each.param.name; });

}  // namespace

bool add_algorithm(Source source, Declaration declaration) {
  added().push_back({std::move(source), std::move(declaration)});
  return true;
}

std::vector<std::string> check_names() {
  std::vector<std::string> names;
  for (const Check* check : all_checks()) names.emplace_back(check->name);
  return names;
}

}  // namespace sixdof::conformance
