#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/cast_check.h"
#include "bench/study/set_agreement.h"

/// Whether algorithms find the first contacts of bodies that move, and where not.

namespace sixdof::study {

/// A motion with an answer that is a fault (is_fault()), or without one.
struct CastDifference {
  std::string algorithm;
  MotionKind kind = MotionKind::translation;
  double percent = 0.0;   ///< By what part of A's diagonal B moves.
  std::size_t place = 0;  ///< Among the motions of this kind and step.
  ImpactVerdict verdict = ImpactVerdict::failed;
  std::string answer, truth;  ///< "t 0.25", "no contact", a status with its words; "t 0.5", "no contact".
  std::string command;        ///< `sixdof query ...` of the motion.
};

/// The answers of one algorithm to the motions of one kind and step.
struct CastAnswers {
  std::string algorithm;
  MotionKind kind = MotionKind::translation;
  double percent = 0.0;
  bench::CastCounts counts;
};

struct PairCasts {
  std::string pair;
  std::vector<CastAnswers> answers;         ///< By kind, step, algorithm.
  std::vector<std::string> refusals;        ///< Of algorithms that cannot use the meshes, and are left out.
  std::vector<CastDifference> differences;  ///< In the same order.

  /// Sums over kinds and steps, in the order of the algorithms.
  std::vector<CastAnswers> totals() const;
};

/// How many kinds of motion and steps there are.
inline constexpr std::size_t k_cast_groups = k_motion_kinds.size() * k_motion_steps.size();

/// Asks every algorithm for the first contacts of all kinds of motion and steps (generation/motions.h) from the poses
/// of contact that `cache` draws. Starts are as they are typed: they differ from the set's poses by some roundings.
/// @param wanted algorithms that answer casts @param meshes of the pair, for the commands
/// @param run a step is one algorithm on one kind and step @throws BadArgument without poses of contact; Interrupted
PairCasts compare_casts(bench::PairCache& cache, const CatalogueEntry& pair, const MeshWords& meshes,
                        const std::vector<AskedAlgorithm>& wanted, std::uint64_t seed, const RunOptions& run = {});

/// What `sixdof query` takes behind its meshes and algorithm: "--pose '...' --motion '...'". The same bits, if the
/// start has those of a TypedPose and the reference is the centre of B's box.
std::string motion_words(const Motion& motion);

}  // namespace sixdof::study
