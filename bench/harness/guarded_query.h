#pragma once

#include <cmath>
#include <cstddef>
#include <exception>
#include <set>
#include <string>
#include <utility>

#include <sixdof/query/algorithm.h>

/// Whatever a query does wrong is one failed configuration with its words, and the row goes on.

namespace sixdof::bench {

inline bool is_finite(bool) { return true; }
inline bool is_finite(const Separation& answer) { return std::isfinite(answer.distance); }
/// A volume may be absent, which is NaN.
inline bool is_finite(const Response& answer) {
  return std::isfinite(answer.penalty) && !std::isinf(answer.volume) && answer.force.allFinite() &&
         answer.torque.allFinite() && answer.reference.allFinite();
}

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
    try {
      return ask_(X_AB);
    } catch (const std::exception& e) {
      failures_.add(X_AB, e.what());
    } catch (...) {
      failures_.add(X_AB, "an exception of unknown type was thrown");
    }
    return Status::failed;
  }

  /// Turns an answer that holds a NaN or an infinity into Status::non_finite, and counts one that is not ok.
  template <class T>
  void examine(const Pose& X_AB, Outcome<T>& answer) {
    if (answer.ok() && !is_finite(answer.value)) {
      answer = Status::non_finite;
      failures_.add(X_AB, "the answer is not finite");
    } else if (!answer.ok()) {
      failures_.add(X_AB, answer.status == Status::unsupported ? "unsupported" : query_.diagnosis());
    }
  }

  const Query& query() const { return query_; }

 private:
  const Query& query_;
  Ask ask_;
  Failures& failures_;
};

}  // namespace sixdof::bench
