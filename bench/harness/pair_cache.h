#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/base/error.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/depth_truth.h"
#include "bench/harness/hull_truth.h"

namespace sixdof::bench {

/// Thrown by a row that needs solids where a mesh is none: the row is left out and does not count as an error.
class NeedsSolid : public BadMesh {
 public:
  using BadMesh::BadMesh;
};

/// @throws NeedsSolid with the name of the mesh and Mesh::why_not_solid()
void require_solids(const Mesh& a, const Mesh& b);

struct LoadedMesh {
  Mesh mesh;
  std::string argument;  ///< Stands for the mesh on a command line: a model's name or a file.
};

/// Cache of pairs: meshes, configuration sets, samples of buckets and prepared queries, each fetched when a row first
/// asks for it.
class PairCache {
 public:
  /// Loads the mesh of a key (CatalogueEntry::a).
  using Loader = std::function<LoadedMesh(const std::string& key)>;

  /// @param sample configurations per bucket, 0 for all; @param seed of the samples
  PairCache(std::size_t sample, std::uint64_t seed, Loader load)
      : sample_(sample), seed_(seed), load_(std::move(load)) {}

  /// @throws what the loader throws
  const Mesh& mesh(const std::string& key);

  /// Keeps a mesh that is loaded already; does nothing if there is one of this key.
  void keep(const std::string& key, LoadedMesh mesh);

  /// Checks that the set belongs to the pair's meshes when it takes the sample.
  /// @throws BadFile, BadArgument
  const BucketSample& bucket(const CatalogueEntry& set, BucketKey key);

  /// Responses of the algorithm `exact` to the first poses of a bucket's sample: `count` of them, but at most
  /// k_most_exact, so that rows that ask the same configurations compare the same ones. Each is measured once. May drop
  /// prepared queries. The span is valid until the next call of exact_responses().
  /// @throws NeedsSolid
  std::span<const Response> exact_responses(const CatalogueEntry& set, BucketKey key, std::size_t count);

  /// Of the pair's convex hulls, which are made once. Valid while the cache lives. @throws BadMesh as HullTruth does
  HullTruth& hull_truth(const CatalogueEntry& set);

  /// Of the pair's meshes, by the laws of depth. Valid while the cache lives. @throws NeedsSolid
  DepthTruths& depth_truths(const CatalogueEntry& set);

  /// Enough for a mean.
  static constexpr std::size_t k_most_exact = 256;

  /// The reference is valid until the next call of query() or exact_responses(). @throws what prepare() throws
  Query& query(const Algorithm& algorithm, const Settings& settings, const std::string& a, const std::string& b);

  /// Whether query() would return without preparing.
  bool is_prepared(const Algorithm& algorithm, const Settings& settings, const std::string& a,
                   const std::string& b) const;

  /// Prepares anew and keeps nothing. @throws NeedsSolid, what Algorithm::prepare() throws, Error for a null pointer
  std::unique_ptr<Query> prepare(const Algorithm& algorithm, const Settings& settings, const Mesh& a, const Mesh& b);

  struct Counts {
    std::size_t sets_opened = 0;
    std::size_t buckets_read = 0;
    std::size_t meshes_loaded = 0;
    std::size_t structures_prepared = 0;
  };
  const Counts& counts() const { return counts_; }

  /// One line for each fetched mesh that intersects itself (mesh_warning.h).
  std::vector<std::string> warnings() const;

  /// ("mesh:elephant", content hash), ("set:elephant", content hash) of everything that was fetched.
  std::vector<std::pair<std::string, std::string>> hashes() const;

  /// Prepared queries are kept up to this total size; the least recently used go first.
  static constexpr std::size_t k_most_prepared_bytes = std::size_t{2} << 30;
  /// Samples are kept up to this total number of poses (about 400 MB).
  static constexpr std::size_t k_most_poses = 4'000'000;

 private:
  struct Prepared {
    std::string key;  ///< Algorithm, whether it is isolated, settings and meshes.
    std::unique_ptr<Query> query;
    std::size_t bytes = 0;
  };
  using PairBucket = std::pair<std::string, BucketKey>;  ///< Name of the pair and bucket.

  std::size_t sample_;
  std::uint64_t seed_;
  Loader load_;
  Counts counts_;
  std::map<std::string, std::unique_ptr<const LoadedMesh>> meshes_;      ///< By key.
  std::map<std::string, std::unique_ptr<const ConfigurationSet>> sets_;  ///< By name of the pair.
  std::map<PairBucket, BucketSample> buckets_;
  std::size_t poses_ = 0;  ///< In buckets_.
  std::map<PairBucket, std::vector<Response>> exact_responses_;
  std::map<std::string, std::unique_ptr<HullTruth>> hull_truths_;     ///< By name of the pair.
  std::map<std::string, std::unique_ptr<DepthTruths>> depth_truths_;  ///< By name of the pair.
  std::list<Prepared> prepared_;                                      ///< Most recently used first.
};

}  // namespace sixdof::bench
