#pragma once

#include <string_view>

namespace sixdof {

/// How a query ended. Every query ends as exactly one of these, and each is counted.
enum class Status {
  ok,
  unsupported,  ///< The algorithm does not answer this kind of query.
  failed,       ///< The algorithm gave up, threw, or returned something that is no answer.
  non_finite,   ///< The algorithm returned, or was given, a NaN or an infinity.
};

std::string_view to_string(Status status);

/// A value, or why there is none. `value` is meaningful only if ok(); Query::diagnosis() has the words for a failure.
template <class T>
struct Outcome {
  Status status = Status::unsupported;
  T value{};

  Outcome() = default;
  Outcome(Status why) : status(why) {}                      // NOLINT(google-explicit-constructor): reads as a value
  Outcome(T answer) : status(Status::ok), value(answer) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return status == Status::ok; }
};

}  // namespace sixdof
