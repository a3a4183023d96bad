#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <sixdof/query/algorithm.h>
#include <sixdof/stability/case.h>

/// Asks an algorithm all that it answers on the shots of a case.
namespace sixdof::stability {

/// How queries are prepared: in this process, or wrapped by one that runs elsewhere.
using Prepare = std::function<std::unique_ptr<Query>(const Mesh& a, const Mesh& b)>;

template <class T>
struct Asked {
  Outcome<T> outcome;  ///< Status::unsupported if not asked.
  std::string words;
};

/// Settings for hard cases, whose small bodies are prepared by the hundred: of an algorithm that approximates the
/// bodies the coarsest value of each parameter that has a sweep; of others the defaults.
Settings coarse_settings(const Algorithm& algorithm);

struct Answers {
  Asked<bool> collide;
  Asked<Separation> distance;
  Asked<Response> respond;
  double seconds = 0.0;     ///< Processor time of the slowest of the three.
  double wall_seconds = 0;  ///< Wall time of the slowest of the three.
  bool refused = false;     ///< prepare() threw BadMesh or BadArgument, with `words`.
  bool prepare_threw = false;
  std::string words;
  double resolution = 0.0;  ///< That the algorithm declares for this pair (length); 0 if it does not approximate.
};

/// Processor time of the calling thread (seconds).
double thread_seconds();

/// Asks one query object.
Answers ask(Query& query, const QuerySet& kinds, const Pose& X_AB);

/// The length that an algorithm declares as its resolution, as the count "resolution" of its footprint; 0 if none.
double declared_resolution(const Query& query);

/// A query per pair of meshes, kept while the object lives.
class PreparedPairs {
 public:
  PreparedPairs(Prepare prepare, const Traits& traits)
      : prepare_(std::move(prepare)), kinds_(traits.answers), approximates_(traits.approximates) {}

  Answers ask(const Shot& shot);

 private:
  struct Pair {
    MeshPointer a, b;
    std::unique_ptr<Query> query;
    double resolution = 0.0;
    Answers failure;  ///< Where `query` is null.
  };
  Pair& pair_of(const Shot& shot);

  Prepare prepare_;
  QuerySet kinds_;
  bool approximates_;
  std::vector<Pair> pairs_;
};

}  // namespace sixdof::stability
