#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::bench {

/// What rows are made of, fetched when a row first asks for it and kept for the next: meshes, sets, samples of buckets,
/// prepared structures. Counts what it fetched.
class Stock {
 public:
  Stock(std::size_t sample, std::uint64_t seed) : sample_(sample), seed_(seed) {}

  /// @throws what load_model() throws
  const Mesh& mesh(const std::string& model);

  /// Checks that the set belongs to the pair's meshes when it takes the sample.
  /// @throws BadFile, BadArgument
  const BucketSample& bucket(const CatalogueEntry& set, BucketKey key);

  /// The exact volume law's answers to the first poses of a bucket's sample, the truth that all algorithms' responses
  /// to it are compared with. Measured once, at the first call: at least BucketSample::k_run of them, and up to
  /// k_most_true while `seconds` last. A sample's runs stand in random order, so its first poses are a fair part of it.
  /// To be called before a row fetches its own structure, which preparing the exact one might drop.
  const std::vector<Response>& true_responses(const CatalogueEntry& set, BucketKey key, double seconds);

  /// Enough for a mean.
  static constexpr std::size_t k_most_true = 256;

  /// @throws what Algorithm::prepare() throws
  Query& query(const Algorithm& algorithm, const Settings& settings, const std::string& a, const std::string& b);

  /// Builds anew, keeping nothing: for timing.
  std::unique_ptr<Query> prepare(const Algorithm& algorithm, const Settings& settings, const Mesh& a, const Mesh& b);

  struct Counts {
    std::size_t sets_opened = 0;
    std::size_t buckets_read = 0;
    std::size_t meshes_loaded = 0;
    std::size_t structures_prepared = 0;
  };
  const Counts& counts() const { return counts_; }

  /// ("mesh:elephant", content hash), ("set:elephant", content hash): of everything that was used.
  std::vector<std::pair<std::string, std::string>> hashes() const;

  /// Prepared structures are kept while they take no more than this together; the least recently used go first.
  static constexpr std::size_t k_most_structure_bytes = std::size_t{2} << 30;
  /// Samples are kept while they have no more poses than this together (about 400 MB).
  static constexpr std::size_t k_most_poses = 4'000'000;

 private:
  const ConfigurationSet& set(const CatalogueEntry& set);

  struct Prepared {
    std::string key;
    std::unique_ptr<Query> query;
    std::size_t bytes = 0;
  };

  std::size_t sample_;
  std::uint64_t seed_;
  Counts counts_;
  std::map<std::string, std::unique_ptr<const Mesh>> meshes_;
  std::map<std::string, std::unique_ptr<const ConfigurationSet>> sets_;  ///< By pair.
  std::map<std::pair<std::string, BucketKey>, BucketSample> buckets_;    ///< By pair and key.
  std::size_t poses_ = 0;
  std::map<std::pair<std::string, BucketKey>, std::vector<Response>> true_responses_;  ///< By pair and key.
  std::list<Prepared> prepared_;                                                       ///< Most recently used first.
};

}  // namespace sixdof::bench
