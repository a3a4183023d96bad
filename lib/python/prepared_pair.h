#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof::python {

/// What there is beside the answers to an array of poses.
struct Endings {
  std::vector<std::uint8_t> status;          ///< [pose], in the order of Status.
  std::map<std::size_t, std::string> words;  ///< Of the poses without an answer.
};

/// An algorithm prepared for one pair, which answers arrays of poses with one or several threads. Keeps the meshes.
class PreparedPair {
 public:
  /// Prepares one query. @throws what Algorithm::prepare() throws
  PreparedPair(std::shared_ptr<const Algorithm> algorithm, Settings settings, std::shared_ptr<const Mesh> a,
               std::shared_ptr<const Mesh> b);

  const Settings& settings() const { return settings_; }  ///< A value for each of its parameters.
  std::size_t prepared() const;                           ///< How many queries there are, one per thread so far.
  Footprint footprint() const;                            ///< Of one query.

  /// Asks `count` poses or motions. Calls from several threads wait for each other.
  /// @param ask (Query&, place) -> Outcome<Answer>; an exception or a value that is not finite becomes a failure
  /// @param store (place, const Answer&), for poses with an answer, from several threads
  /// @param threads 1: the calling thread asks in order; else poses are asked in no order by so many threads at most,
  /// each with a query of its own, prepared when first needed; 0: by as many as there are processors
  /// @param stop called now and then by the calling thread; true ends the work
  template <class Answer>
  Endings ask_all(std::size_t count, unsigned threads, const std::function<Outcome<Answer>(Query&, std::size_t)>& ask,
                  const std::function<void(std::size_t, const Answer&)>& store, const std::function<bool()>& stop);

 private:
  std::unique_ptr<Query> take();
  void give_back(std::unique_ptr<Query> query);

  const std::shared_ptr<const Algorithm> algorithm_;
  const Settings settings_;
  const std::shared_ptr<const Mesh> a_, b_;
  std::mutex one_call_;
  mutable std::mutex pool_mutex_;
  std::vector<std::unique_ptr<Query>> idle_;
  std::size_t made_ = 0;
};

}  // namespace sixdof::python
