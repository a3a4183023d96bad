#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/geometry/typed_pose.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/pair_cache.h"
#include "bench/harness/query_kind.h"

/// Whether algorithms give the answers that a configuration set is made for, and where not. Those about convex hulls
/// are compared with the truth of the hulls (bench/harness/hull_truth.h) at the same poses.

namespace sixdof::study {

/// An algorithm with its settings.
struct AskedAlgorithm {
  const Algorithm* algorithm = nullptr;
  Settings settings;
};

/// The meshes of a pair as words of a command line: names of models or files.
struct MeshWords {
  std::string a, b;
};

/// A configuration whose answer is not the set's truth, or that got none.
struct Difference {
  std::string algorithm;
  BucketKey bucket;
  std::uint64_t cell = 0;  ///< Place in the grid (BucketSample::cells).
  bench::QueryKind question = bench::QueryKind::collide;
  std::string answer, truth;  ///< "yes", "no", a distance, or a status with its words.
  TypedPose pose;
  std::string command;  ///< `sixdof query ...` at the pose.
};

/// The answers of one algorithm to one bucket. Yes/no of bucket 0, where the bodies touch, is counted and not judged.
struct AnswerCounts {
  std::string algorithm;
  std::size_t yes = 0;
  std::size_t judged_collide = 0, wrong_collide = 0;
  std::size_t judged_distance = 0, wrong_distance = 0;  ///< Beyond the tolerance (bench/harness/judge.h).
  std::size_t failed = 0;                               ///< Questions without an answer.
  double largest_distance_error = 0.0;                  ///< In A's diagonals.
};

struct BucketAgreement {
  BucketKey bucket;
  std::size_t configurations = 0;
  std::size_t split = 0;  ///< Configurations where not all algorithms about the meshes say the same yes or no.
  std::vector<AnswerCounts> algorithms;
};

struct PairAgreement {
  std::string pair;
  std::vector<BucketAgreement> buckets;
  std::vector<std::string> refusals;    ///< Of algorithms that cannot use the meshes, and are left out: "NAME: words".
  std::vector<Difference> differences;  ///< By bucket, algorithm, question, and order of drawing.

  /// Sums over the buckets, in the order of the algorithms.
  std::vector<AnswerCounts> totals() const;
  std::size_t configurations() const;
};

/// The algorithms that can be prepared for the pair; the words of the others go to `refusals`.
std::vector<AskedAlgorithm> usable(bench::PairCache& cache, const CatalogueEntry& pair,
                                   const std::vector<AskedAlgorithm>& algorithms, std::vector<std::string>& refusals);

/// Asks yes/no and distance of every algorithm, as far as it answers them, at the configurations that `cache` draws of
/// each bucket. Poses are asked as they are typed: they differ from the set's by some roundings.
/// @param meshes of the pair, for the commands
/// @param run a step is one question of one algorithm to one bucket; one thread is used @throws Interrupted
PairAgreement compare_with_set(bench::PairCache& cache, const CatalogueEntry& pair, const MeshWords& meshes,
                               const std::vector<AskedAlgorithm>& wanted, const RunOptions& run = {});

}  // namespace sixdof::study
