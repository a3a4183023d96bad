#include <sixdof/generation/overlap_bounds.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sixdof {
namespace {

/// Upper bound on the rounding of areas in single precision, their sums and slopes, as a fraction of the areas.
constexpr double k_rounding = 1e-6;

/// A triangle whose plane makes an angle with the ray of a sine below this counts as parallel to the ray: through it
/// only strips of this fraction of the displacement in width enter or leave. In an interval of length d that changes
/// the volume by less than 1e-12 d^2 times the length of the triangle's edges, far below the tolerance of hits
/// (k_volume_tolerance).
constexpr double k_least_sine = 1e-12;

/// The upper bound on a function on [0, length], and where it is attained: for one with the values `begin` and `end`
/// that rises by at most `rise` and falls by at most `fall` per length.
VolumePeak upper_bound(double begin, double rise, double end, double fall, double length) {
  if (!(rise + fall > 0.0)) return begin > end ? VolumePeak{begin, 0.0} : VolumePeak{end, length};
  const double at = std::clamp((end + fall * length - begin) / (rise + fall), 0.0, length);
  return {std::max({begin + rise * at, begin, end}), at};
}

/// Upper bound on the area of a section of a box by a plane with the normal `n` (unit, in the box's frame).
double largest_section(const Eigen::Vector3d& size, const Eigen::Vector3d& n) {
  double area = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double projected = size[(i + 1) % 3] * size[(i + 2) % 3];
    if (n[i] != 0.0) area = std::min(area, projected / std::abs(n[i]));
  }
  return area;
}

}  // namespace

double overlap_upper_bound(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB) {
  double bound = std::min(size_a.prod(), size_b.prod());
  for (Eigen::Index i = 0; i < 3; ++i) {
    bound = std::min(bound, size_b[i] * largest_section(size_a, R_AB.col(i)));
    bound = std::min(bound, size_a[i] * largest_section(size_b, R_AB.row(i).transpose()));
  }
  return bound;
}

VolumePeak volume_peak(const OverlapMeasurement& outer, const OverlapMeasurement& inner,
                       std::span<const SlopeRange> ranges) {
  const std::size_t n = ranges.size();
  const double part = (outer.s - inner.s) / static_cast<double>(n);
  // Upper bounds on the volume at the ends of the parts: from the inner measurement, then from both.
  double to_inner = 0.0;
  for (const SlopeRange& range : ranges) to_inner += part * range.low;
  double begin = outer.volume;
  VolumePeak peak = outer.volume > inner.volume ? VolumePeak{outer.volume, outer.s} : VolumePeak{inner.volume, inner.s};
  for (std::size_t j = 0; j < n; ++j) {
    to_inner -= part * ranges[j].low;
    const double from_inner = j + 1 == n ? inner.volume : inner.volume - to_inner;
    const double end = std::min(begin + part * ranges[j].high, from_inner);
    const VolumePeak top = upper_bound(begin, ranges[j].high, end, -ranges[j].low, part);
    if (top.volume > peak.volume) peak = {top.volume, outer.s - part * static_cast<double>(j) - top.s};
    begin = end;
  }
  return peak;
}

void SlopeBounds::Contacts::start(const Eigen::Vector3d& outwards) {
  if (outwards != outwards_) {
    outwards_ = outwards;
    ++ray_;
  }
  ++round_;
  touched_.clear();
}

std::span<const Eigen::Vector3d> SlopeBounds::Contacts::areas_of(std::uint32_t item) const {
  if (leaves_.empty()) return areas_.subspan(item, 1);
  const Tree::Child triangles = leaves_[item].child;
  return areas_.subspan(triangles.first(), triangles.count());
}

SlopeBounds::ItemContacts& SlopeBounds::Contacts::of(std::uint32_t item) {
  ItemContacts& contacts = contacts_[item];
  if (contacts.round == round_) return contacts;
  contacts.round = round_;
  touched_.push_back(item);
  if (contacts.ray != ray_) {
    contacts.ray = ray_;
    double ahead = 0.0, behind = 0.0;
    for (const Eigen::Vector3d& triangle : areas_of(item)) {
      const double area = triangle.dot(outwards_);
      const double least = k_least_sine * triangle.lpNorm<1>();
      if (area > least) ahead += area;
      if (area < -least) behind -= area;
    }
    contacts.side[0].area = static_cast<float>(ahead);
    contacts.side[1].area = static_cast<float>(behind);
    contacts.sides = (contacts.side[0].area > 0.0f ? 1u : 0u) | (contacts.side[1].area > 0.0f ? 2u : 0u);
  }
  for (Side& side : contacts.side) side.raising = side.lowering = PartRange::none();
  return contacts;
}

SlopeBounds::SlopeChange SlopeBounds::Contacts::change() const {
  SlopeChange change;
  const auto add = [&](const Side& side) {
    const auto area = static_cast<double>(side.area);
    if (side.raising.any()) {
      change.raised_since_outer[side.raising.first] += area;
      change.raised_until_inner[side.raising.last] += area;
    }
    if (side.lowering.any()) {
      change.lowered_since_outer[side.lowering.first] += area;
      change.lowered_until_inner[side.lowering.last] += area;
    }
  };
  for (const std::uint32_t item : touched_) {
    for (const Side& side : contacts_[item].side) add(side);
  }
  for (std::size_t j = 1; j < k_parts; ++j) {
    change.raised_since_outer[j] += change.raised_since_outer[j - 1];
    change.lowered_since_outer[j] += change.lowered_since_outer[j - 1];
    change.raised_until_inner[k_parts - 1 - j] += change.raised_until_inner[k_parts - j];
    change.lowered_until_inner[k_parts - 1 - j] += change.lowered_until_inner[k_parts - j];
  }
  return change;
}

std::array<SlopeRange, SlopeBounds::k_parts> SlopeBounds::bound(std::span<const SweptPair> swept,
                                                                const Eigen::Vector3d& outwards_A,
                                                                const Eigen::Vector3d& outwards_B, double first,
                                                                double last, double outer_slope, double inner_slope) {
  a_.start(outwards_A);
  b_.start(outwards_B);
  const double parts_per_fraction = static_cast<double>(k_parts) / (last - first);
  const auto part = [&](float fraction) {
    const double at = (static_cast<double>(fraction) - first) * parts_per_fraction;
    return static_cast<std::uint8_t>(std::clamp(at, 0.0, static_cast<double>(k_parts - 1)));
  };
  for (const SweptPair& pair : swept) {
    if (static_cast<double>(pair.first) > last || static_cast<double>(pair.last) < first) continue;
    ItemContacts& a = a_.of(pair.a);
    ItemContacts& b = b_.of(pair.b);
    const PartRange parts{part(pair.first), part(pair.last)};
    // Mostly one side of each: the loops cost fewer branches that no one can predict than four conditions.
    for (std::uint32_t x = a.sides; x != 0; x &= x - 1) {
      for (std::uint32_t y = b.sides; y != 0; y &= y - 1) {
        const int i = std::countr_zero(x), j = std::countr_zero(y);
        (i == j ? a.side[i].lowering : a.side[i].raising).extend(parts);
        (i == j ? b.side[j].lowering : b.side[j].raising).extend(parts);
      }
    }
  }
  const SlopeChange of_a = a_.change(), of_b = b_.change();
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
