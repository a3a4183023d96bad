#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include <sixdof/query/ask.h>

namespace sixdof::bench {

/// Configurations without an answer.
class Failures {
 public:
  /// Counts a configuration once, however often it is asked. Poses are told apart by their address.
  void add(const Pose& X_AB, std::string words) {
    if (poses_.insert(&X_AB).second && poses_.size() == 1) first_ = std::move(words);
  }
  std::size_t count() const { return poses_.size(); }
  const std::string& first() const { return first_; }  ///< Words of the first failure.

 private:
  std::set<const Pose*> poses_;
  std::string first_;
};

/// A prepared query and the question that a row asks it: a callable Pose -> Outcome.
template <class Ask>
class GuardedQuery {
 public:
  /// All arguments but `ask` outlive this object.
  GuardedQuery(const Query& query, Ask ask, Failures& failures) : query_(query), ask_(ask), failures_(failures) {}

  /// The answer, examined.
  auto ask(const Pose& X_AB) {
    auto answer = ask_timed(X_AB);
    examine(X_AB, answer);
    return answer;
  }

  /// For timed loops: an exception becomes Status::failed and counts as a failure. Costs nothing where none is thrown.
  auto ask_timed(const Pose& X_AB) -> decltype(std::declval<Ask&>()(X_AB)) {
    return ask_guarded([&] { return ask_(X_AB); }, counted(X_AB));
  }

  /// Turns an answer that holds a NaN or an infinity into Status::non_finite, and counts one that is not ok.
  template <class T>
  void examine(const Pose& X_AB, Outcome<T>& answer) {
    sixdof::examine(query_, answer, counted(X_AB));
  }

  const Query& query() const { return query_; }

 private:
  auto counted(const Pose& X_AB) {
    return [this, &X_AB](std::string words) { failures_.add(X_AB, std::move(words)); };
  }

  const Query& query_;
  Ask ask_;
  Failures& failures_;
};

}  // namespace sixdof::bench
