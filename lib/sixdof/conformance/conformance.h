#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <sixdof/conformance/declaration.h>
#include <sixdof/query/algorithm.h>

/// The conformance kit as GoogleTest cases, which hold an algorithm to the rules of query/README.md. `sixdof conform`
/// runs the same checks without GoogleTest. A test program links sixdof::conformance and GTest::gtest_main, and has a
/// line per algorithm:
///
///     SIXDOF_CONFORMANCE("mine", {.distance_error = 1e-9});                  // made by a Registrar of the program
///     SIXDOF_CONFORMANCE(make_my_algorithm, {.collide = Meaning::bodies});   // made by a function
///
/// The cases are called `Algorithms/Conformance.Of/NAME_CHECK`, with '_' for the '-' of the name; README.md lists the
/// checks. A message names the meshes and the pose, and ends with a line `sixdof query ...` that asks the same.

namespace sixdof::conformance {

/// Where the algorithm comes from: the name of one that a Registrar of the program makes, or a function.
class Source {
 public:
  /// An algorithm that a Registrar makes.
  Source(const char* name) : name_(name) {}  // NOLINT(google-explicit-constructor): reads as a value
  /// One that a function makes.
  template <class Make>
  requires std::is_invocable_r_v<std::unique_ptr<Algorithm>, Make> Source(Make maker)
      : make_(std::move(maker)) {}  // NOLINT(google-explicit-constructor)

  /// @throws BadArgument if no Registrar makes an algorithm of the name
  std::unique_ptr<Algorithm> make() const;

 private:
  std::string name_;
  std::function<std::unique_ptr<Algorithm>()> make_;
};

/// Adds the cases of one algorithm, before main(). Nothing is made until GoogleTest begins.
bool add_algorithm(Source source, Declaration declaration);
/// The same with what declaration_of() has for the algorithm's name.
bool add_algorithm(Source source);

}  // namespace sixdof::conformance

/// Joins two words; for SIXDOF_CONFORMANCE alone.
#define SIXDOF_CONFORMANCE_JOIN_(a, b) a##b
/// A name for each use; for SIXDOF_CONFORMANCE alone.
#define SIXDOF_CONFORMANCE_NAME_(number) SIXDOF_CONFORMANCE_JOIN_(k_sixdof_conformance_, number)

/// At namespace scope: SIXDOF_CONFORMANCE(source) or SIXDOF_CONFORMANCE(source, {members of a Declaration}).
#define SIXDOF_CONFORMANCE(source, ...)                                      \
  [[maybe_unused]] static const bool SIXDOF_CONFORMANCE_NAME_(__COUNTER__) = \
      ::sixdof::conformance::add_algorithm(source __VA_OPT__(, ) __VA_ARGS__)
