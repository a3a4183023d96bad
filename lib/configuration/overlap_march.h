#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <sixdof/configuration/slope_bounds.h>

namespace sixdof {

/// The overlap at travel s.
struct OverlapSample {
  double s = 0.0;
  double volume = 0.0;
  double slope = 0.0;  ///< Derivative of the volume by the way in, -dV/ds.
};

/// Lengths and volumes in the meshes' unit.
struct MarchLimits {
  double resolution = 0.0;  ///< Gaps no longer than this are not looked into.
  double tolerance = 0.0;   ///< |volume - aim| allowed in a hit; the search ends at k_content of it.
};

/// Walks inwards along one ray from contact, and meets aims for the first time; see VolumeGenerator.
class OverlapMarch {
 public:
  using Measure = std::function<OverlapSample(double s)>;
  /// Bounds on the slopes at this travel and everywhere further out.
  using Bounds = std::function<SlopeBounds(double s)>;

  OverlapMarch(Measure measure, Bounds bounds, double contact, const MarchLimits& limits);

  /// The first hit of an aim. Aims ascend from call to call. Nothing if the volume stays below down to s = 0.
  /// @throws Error if the measurements are those of no continuous function
  std::optional<OverlapSample> advance(double aim);

  int measurements() const { return measurements_; }

  /// Share of the tolerance with which the search is content: room for oracles that round differently.
  static constexpr double k_content = 0.1;

 private:
  void insert(double s);
  bool closed(const OverlapSample& outer, const OverlapSample& inner, double aim) const;
  double next(double aim) const;
  double divide(const OverlapSample& outer, const OverlapSample& inner, double aim) const;
  std::optional<double> refine(const OverlapSample& outer, const OverlapSample& inner, double aim);

  Measure measure_;
  Bounds bounds_;
  const double contact_;
  const MarchLimits limits_;
  const double content_;
  OverlapSample front_;               ///< No hit of the current aim further out.
  std::vector<OverlapSample> inner_;  ///< Samples further in, the outermost last.
  int measurements_ = 0;
  int refinements_ = 0;
};

}  // namespace sixdof
