#include <sixdof/conformance/conformance.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/conformance/checks.h>
#include <sixdof/conformance/declared.h>
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
  std::optional<Declaration> declaration;
};

std::vector<Added>& added() {
  static std::vector<Added> list;
  return list;
}

/// An algorithm with the subject that refers to it.
struct Candidate {
  Candidate(std::unique_ptr<Algorithm> made, Declaration declaration)
      : algorithm(std::move(made)),
        subject(*algorithm, std::move(declaration),
                {.program = own_command("sixdof"), .folder = ::testing::TempDir()}) {}

  const std::unique_ptr<Algorithm> algorithm;
  const Subject subject;
};

/// A GoogleTest case: one check of one algorithm; or, without a check, why there is no algorithm.
struct Instance {
  std::shared_ptr<const Candidate> candidate;
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
      const std::string name = algorithm->traits().name;
      const auto candidate = std::make_shared<const Candidate>(
          std::move(algorithm), each.declaration ? *each.declaration : declaration_of(name));
      for (const Check& check : all_checks()) {
        if (!applies(check, candidate->subject.traits().answers)) continue;
        list.push_back({candidate, &check, test_name(name, check.name), {}});
      }
    } catch (const std::exception& e) {
      list.push_back({nullptr, nullptr, fmt::format("Unusable_{}", list.size()), e.what()});
    }
  }
  return list;
}

class Conformance : public ::testing::TestWithParam<Instance> {};

std::ostream& operator<<(std::ostream& out, const Instance& instance) {
  if (instance.candidate == nullptr) return out << instance.problem;
  return out << instance.candidate->subject.traits().name << " " << instance.candidate->subject.traits().version;
}

TEST_P(Conformance, Of) {
  const Instance& instance = GetParam();
  ASSERT_NE(instance.candidate, nullptr) << instance.problem;
  const Finding found = run_check(*instance.check, instance.candidate->subject);
  if (found.verdict == Verdict::known_failure) {
    std::cout << "known failure: " << found.why << "\n" << to_string(found.failures.front()) << "\n";
    return;
  }
  for (const Failure& failure : found.failures) ADD_FAILURE() << to_string(failure);
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

bool add_algorithm(Source source) {
  added().push_back({std::move(source), std::nullopt});
  return true;
}

}  // namespace sixdof::conformance
