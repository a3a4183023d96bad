#pragma once

#include <string>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof::study {

/// One setting of an algorithm that a study tries.
struct SweepPoint {
  Settings settings;
  /// What tells it from the others of its sweep: "voxel_size=0.01", in the order of the parameters; empty for an
  /// algorithm without a sweep.
  std::vector<std::string> assignments;
};

/// Values of a parameter that replace those of Parameter::sweep.
struct SweptValues {
  std::string algorithm, parameter;
  std::vector<std::string> values;
};

/// Reads "ALGORITHM:NAME=VALUE,VALUE,...". @throws BadArgument
SweptValues parse_swept_values(const std::string& text);

/// A warm start on and off (the slower is taken to be the finer), for the algorithms that have the parameter
/// `warm_start`, no sweep, and none among `values`.
std::vector<SweptValues> warm_starts(const std::vector<const Algorithm*>& algorithms,
                                     const std::vector<SweptValues>& values);

/// From `most` threads down to one by halves, for the algorithms that have the parameter `threads`, no sweep, and no
/// such values among `values`; none if `most` is 1.
std::vector<SweptValues> thread_counts(const std::vector<const Algorithm*>& algorithms,
                                       const std::vector<SweptValues>& values, unsigned most);

/// The points of an algorithm, from coarse to fine: the k-th values of all its sweeps together or, where `values` has
/// some of this algorithm, every combination of these, with defaults for what they do not name.
/// @throws BadArgument for a parameter that does not exist or a value that it does not allow
std::vector<SweepPoint> sweep_points(const Algorithm& algorithm, const std::vector<SweptValues>& values);

}  // namespace sixdof::study
