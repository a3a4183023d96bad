#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <sixdof/generation/overlap_bounds.h>

namespace sixdof {

/// Lengths and volumes in the meshes' unit.
struct MarchLimits {
  double resolution = 0.0;  ///< Intervals no longer than this are not divided.
  double tolerance = 0.0;   ///< |volume - target| allowed in a hit. The search ends at k_converged times it.
  double first_step = 0.0;  ///< Displacement from contact to the first measurement.
  double rounding = 0.0;    ///< Largest error of a measured volume.
};

/// Searches one ray inwards from contact for the first translations at which volumes are met; see volume_generator.h.
class OverlapMarch {
 public:
  /// Measures at `s`, after the front has come to `front`.
  using Measure = std::function<OverlapMeasurement(double s, double front)>;
  /// An upper bound on the volume between two measurements. It is the smallest known one, or any that is not above
  /// `enough`.
  using Peak =
      std::function<VolumePeak(const OverlapMeasurement& outer, const OverlapMeasurement& inner, double enough)>;

  /// @param contact translation at which the surfaces meet first
  OverlapMarch(Measure measure, Peak peak, double contact, const MarchLimits& limits);

  /// The first hit of a target; nothing if the volume stays below it down to s = 0. Targets ascend from call to call.
  /// @throws BadMesh if volumes are rounded too coarsely for the tolerance; Error if the measurements are not those of
  /// a continuous function
  std::optional<OverlapMeasurement> advance(double target);

  /// |volume - target| at which the search ends, as a fraction of the tolerance: leaves room for oracles that round
  /// differently.
  static constexpr double k_converged = 0.1;

 private:
  void measure_at(double s);
  OverlapMeasurement pass();
  double next_translation(double target);
  double predicted_step(double target) const;
  std::optional<double> division(const OverlapMeasurement& inner, double target) const;
  std::optional<double> refine(const OverlapMeasurement& inner, double target);

  Measure measure_;
  Peak peak_;
  const double contact_;
  const MarchLimits limits_;
  const double converged_;
  std::vector<OverlapMeasurement> passed_;  ///< From contact inwards; the current target is not met up to the last.
  std::vector<OverlapMeasurement> inner_;   ///< Further inwards, the outermost last.
  int measurements_ = 0;
  int refinements_ = 0;  ///< For the current target.
  int short_steps_ = 0;  ///< Steps shorter than the resolution towards the current target.
};

}  // namespace sixdof
