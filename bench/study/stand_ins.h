#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include "bench/study/study_sample.h"
#include "bench/study/timing_rounds.h"

/// What it costs to ask about simpler bodies instead of the meshes: convex hulls, or the convex parts of a
/// decomposition.

namespace sixdof::study {

/// Answers about the stand-ins beside the truth of the meshes.
struct StandInErrors {
  struct Share {
    std::size_t wrong = 0, of = 0;
  };
  std::array<Share, 3> yes_no;  ///< By Nearness: stand-ins that touch where the meshes do not, or the other way round.
  /// Distance of the stand-ins minus that of the meshes, in diagonals of A, ascending; only where the meshes are apart.
  std::vector<double> bias;
  /// Of `exact` on the meshes and on the stand-ins, with the same poses in turn.
  TimingRounds yes_no_meshes, yes_no_stand_ins, distance_meshes, distance_stand_ins;

  double mean_bias() const;
  /// Of bias, nearest rank. @pre not empty
  double quantile(double share) const;
};

/// @param yes_no, distance samples of draw_verdict_sample()
/// @throws what `exact` throws for the bodies; Interrupted
StandInErrors measure_stand_ins(const Mesh& a, const Mesh& b, const Mesh& stand_in_a, const Mesh& stand_in_b,
                                const StudySample& yes_no, const StudySample& distance);

/// All parts in one mesh.
Mesh joined(const std::vector<Mesh>& parts, const std::string& name);

}  // namespace sixdof::study
