#include <sixdof/generation/slope_bounds.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof {
namespace {

/// Areas as floats, their sums and slopes are rounded by far less than this share of the areas.
constexpr double k_rounding = 1e-6;

/// Triangles closer than this sine to the line of motion are as good as along it: nothing comes in or goes out through
/// them but strips this share of the way wide. Within a gap that changes the volume by less than 1e-12 way^2 times the
/// length of their edges, far below what hits are certified to (k_volume_tolerance).
constexpr double k_least_sine = 1e-12;

/// The largest of two lines, rising from the begin and falling to the end of a way, and where they meet.
struct Meeting {
  double value;
  double at;
};

Meeting meet(double begin, double rise, double end, double fall, double way) {
  if (!(rise + fall > 0.0)) return begin > end ? Meeting{begin, 0.0} : Meeting{end, way};
  const double at = std::clamp((end + fall * way - begin) / (rise + fall), 0.0, way);
  return {std::max({begin + rise * at, begin, end}), at};
}

}  // namespace

VolumePeak volume_peak(const OverlapSample& outer, const OverlapSample& inner, std::span<const SlopeRange> ranges) {
  const std::size_t n = ranges.size();
  const double part = (outer.s - inner.s) / static_cast<double>(n);
  // Bounds at the parts' ends, from the inner sample and then from both.
  double to_inner = 0.0;
  for (const SlopeRange& range : ranges) to_inner += part * range.low;
  double begin = outer.volume;
  VolumePeak peak = outer.volume > inner.volume ? VolumePeak{outer.volume, outer.s} : VolumePeak{inner.volume, inner.s};
  for (std::size_t j = 0; j < n; ++j) {
    to_inner -= part * ranges[j].low;
    const double from_inner = j + 1 == n ? inner.volume : inner.volume - to_inner;
    const double end = std::min(begin + part * ranges[j].high, from_inner);
    const Meeting top = meet(begin, ranges[j].high, end, -ranges[j].low, part);
    if (top.value > peak.volume) peak = {top.value, outer.s - part * static_cast<double>(j) - top.at};
    begin = end;
  }
  return peak;
}

void SlopeBounds::Change::accumulate() {
  for (std::size_t j = 1; j < k_parts; ++j) {
    raised_since_outer[j] += raised_since_outer[j - 1];
    lowered_since_outer[j] += lowered_since_outer[j - 1];
    raised_until_inner[k_parts - 1 - j] += raised_until_inner[k_parts - j];
    lowered_until_inner[k_parts - 1 - j] += lowered_until_inner[k_parts - j];
  }
}

void SlopeBounds::Body::clear() {
  ++round_;
  marked_.clear();
}

SlopeBounds::Mark& SlopeBounds::Body::mark(std::uint32_t triangle, std::span<const Eigen::Vector3d> areas,
                                           const Eigen::Vector3d& outwards) {
  Mark& mark = marks_[triangle];
  if (mark.round != round_) {
    const double area = areas[triangle].dot(outwards);
    const double least = k_least_sine * areas[triangle].lpNorm<1>();
    const int side = area > least ? 1 : area < -least ? -1 : 0;
    mark = {static_cast<float>(std::abs(area)), round_, Stay::none(), Stay::none(), static_cast<std::int8_t>(side)};
    marked_.push_back(triangle);
  }
  return mark;
}

SlopeBounds::Change SlopeBounds::Body::change() const {
  Change change;
  for (const std::uint32_t t : marked_) {
    const Mark& mark = marks_[t];
    const auto area = static_cast<double>(mark.area);
    if (mark.raising.any()) {
      change.raised_since_outer[mark.raising.first] += area;
      change.raised_until_inner[mark.raising.last] += area;
    }
    if (mark.lowering.any()) {
      change.lowered_since_outer[mark.lowering.first] += area;
      change.lowered_until_inner[mark.lowering.last] += area;
    }
  }
  change.accumulate();
  return change;
}

std::array<SlopeRange, SlopeBounds::k_parts> SlopeBounds::bound(const SweptCandidates& swept,
                                                                std::span<const Eigen::Vector3d> areas_a,
                                                                std::span<const Eigen::Vector3d> areas_b,
                                                                const Eigen::Vector3d& outwards_A,
                                                                const Eigen::Vector3d& outwards_B, double first,
                                                                double last, double outer_slope, double inner_slope) {
  a_.clear();
  b_.clear();
  const double parts_per_share = static_cast<double>(k_parts) / (last - first);
  const auto part = [&](float share) {
    const double at = (static_cast<double>(share) - first) * parts_per_share;
    return static_cast<std::uint8_t>(std::clamp(at, 0.0, static_cast<double>(k_parts - 1)));
  };
  for (std::size_t i = 0; i < swept.pairs.size(); ++i) {
    if (swept.first[i] > last || swept.last[i] < first) continue;
    Mark& a = a_.mark(swept.pairs[i].a, areas_a, outwards_A);
    Mark& b = b_.mark(swept.pairs[i].b, areas_b, outwards_B);
    const Stay stay{part(swept.first[i]), part(swept.last[i])};
    const auto extend = [&](Stay& known) {
      known = {std::min(known.first, stay.first), std::max(known.last, stay.last)};
    };
    const int both = a.side * b.side;
    if (both < 0) {
      extend(a.raising);
      extend(b.raising);
    } else if (both > 0) {
      extend(a.lowering);
      extend(b.lowering);
    }
  }
  const Change of_a = a_.change(), of_b = b_.change();
  const auto least = [](double x, double y) { return (1.0 + k_rounding) * std::min(x, y); };
  std::array<SlopeRange, k_parts> ranges;
  for (std::size_t j = 0; j < k_parts; ++j) {
    ranges[j].high = std::min(outer_slope + least(of_a.raised_since_outer[j], of_b.raised_since_outer[j]),
                              inner_slope + least(of_a.lowered_until_inner[j], of_b.lowered_until_inner[j]));
    ranges[j].low = std::max(outer_slope - least(of_a.lowered_since_outer[j], of_b.lowered_since_outer[j]),
                             inner_slope - least(of_a.raised_until_inner[j], of_b.raised_until_inner[j]));
  }
  return ranges;
}

}  // namespace sixdof
