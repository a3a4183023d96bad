#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/ask.h>

namespace sixdof::bench {

/// Configurations without an answer.
class Failures {
 public:
  /// Counts a configuration once, however often it is asked. Poses are told apart by their address.
  void add(const Pose& X_AB, std::string words) {
    if (!poses_.emplace(&X_AB, Status::failed).second || poses_.size() > 1) return;
    first_ = std::move(words);
    first_pose_ = X_AB;
  }
  /// The status of a configuration that was added; of several the last one.
  void set_status(const Pose& X_AB, Status status) { poses_.at(&X_AB) = status; }

  std::size_t count() const { return poses_.size(); }
  std::size_t count(Status status) const {
    const auto has_status = [status](const auto& entry) { return entry.second == status; };
    return static_cast<std::size_t>(std::ranges::count_if(poses_, has_status));
  }
  const std::string& first() const { return first_; }                    ///< Words of the first failure.
  const std::optional<Pose>& first_pose() const { return first_pose_; }  ///< Empty without failures.

 private:
  std::map<const Pose*, Status> poses_;
  std::string first_;
  std::optional<Pose> first_pose_;
};

/// A prepared query and the question that a row asks it: a callable Pose -> Outcome.
template <class Ask>
class GuardedQuery {
 public:
  /// What an Outcome of the question holds.
  using Answer = decltype(std::declval<Ask&>()(std::declval<const Pose&>()).value);

  /// All arguments but `ask` outlive this object.
  GuardedQuery(Query& query, Ask ask, Failures& failures)
      : query_(query), remote_(as_remote(query)), ask_(ask), failures_(failures) {}

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
    if (!answer.ok()) failures_.set_status(X_AB, answer.status);
  }

  /// Counts the poses that a process could not answer.
  void count(std::span<const Pose> poses, const std::vector<protocol::Failed>& failed) {
    for (const protocol::Failed& each : failed) {
      failures_.add(poses[each.place], each.words);
      failures_.set_status(poses[each.place], each.status);
    }
  }

  const Query& query() const { return query_; }
  /// The query if it runs in a process of its own, where it is timed; else null.
  RemoteQuery* remote() const { return remote_; }

 private:
  auto counted(const Pose& X_AB) {
    return [this, &X_AB](std::string words) { failures_.add(X_AB, std::move(words)); };
  }

  const Query& query_;
  RemoteQuery* remote_;
  Ask ask_;
  Failures& failures_;
};

}  // namespace sixdof::bench
