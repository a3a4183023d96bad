#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <sixdof/generation/slope_bounds.h>

namespace sixdof {

/// Lengths and volumes in the meshes' unit.
struct MarchLimits {
  double resolution = 0.0;    ///< Gaps no longer than this are not looked into.
  double tolerance = 0.0;     ///< |volume - target| allowed in a hit; the search ends at k_content of it.
  double first_stride = 0.0;  ///< Where to measure first, behind contact.
};

/// Walks inwards along one ray from contact, and meets targets for the first time; see VolumeGenerator.
class OverlapMarch {
 public:
  /// @param s where to measure
  /// @param outer no measurement or peak will be asked for further out
  using Measure = std::function<OverlapSample(double s, double outer)>;
  /// The largest volume possible in a gap between two measurements.
  using Peak = std::function<VolumePeak(const OverlapSample& outer, const OverlapSample& inner)>;

  OverlapMarch(Measure measure, Peak peak, double contact, const MarchLimits& limits);

  /// The first hit of a target. Targets ascend from call to call. Nothing if the volume stays below down to s = 0.
  /// @throws Error if the measurements are those of no continuous function
  std::optional<OverlapSample> advance(double target);

  int measurements() const { return measurements_; }

  /// Share of the tolerance with which the search is content: room for oracles that round differently.
  static constexpr double k_content = 0.1;

 private:
  void insert(double s);
  OverlapSample pass();
  double next(double target);
  double expected(double target) const;
  std::optional<double> doubt(const OverlapSample& inner, double target) const;
  std::optional<double> refine(const OverlapSample& inner, double target);

  Measure measure_;
  Peak peak_;
  const double contact_;
  const MarchLimits limits_;
  const double content_;
  std::vector<OverlapSample> passed_;  ///< From contact on; no hit of the current target up to the last.
  std::vector<OverlapSample> inner_;   ///< Samples further in, the outermost last.
  int measurements_ = 0;
  int refinements_ = 0;  ///< Of the current target.
  int approaches_ = 0;   ///< Steps shorter than the resolution towards the current target.
};

}  // namespace sixdof
