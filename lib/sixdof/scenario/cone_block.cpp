#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <sixdof/scenario/kinds.h>
#include <sixdof/scenario/normals.h>
#include <sixdof/scenario/plane.h>

namespace sixdof {
namespace {

struct Shape {
  double height, radius, block_length, block_height, block_width, depth, overshoot;
  int facets;
  RoundParts round;

  explicit Shape(const Settings& s)
      : height(s.number("cone_height")),
        radius(s.number("cone_radius")),
        block_length(s.number("block_length")),
        block_height(s.number("block_height")),
        block_width(s.number("block_width")),
        depth(s.number("depth")),
        overshoot(s.number("overshoot")),
        facets(static_cast<int>(s.number("facets"))),
        round(round_parts_of(s)) {
    const double tip = depth * radius / height;
    require(depth < height, "the cone sinks in completely: depth must be below cone_height");
    require(overshoot > tip, "the path must start beside the block: overshoot must exceed the tip's radius");
    // Somewhere leaving upwards must be shorter than leaving over an end.
    const double flank = std::sqrt(1.0 + std::pow(radius / height, 2));
    require(block_length > 2.0 * std::max({tip, depth * flank - tip, reach_of_end()}),
            "the tip is never wholly over the block and away from its ends: block_length is too small");
    require(0.5 * block_width > tip + std::min(depth, 0.5 * block_height),
            "the block's long edges are too near the tip: block_width is too small");
  }

  /// Lowest height above the apex that is inside the block.
  double bottom() const { return std::max(0.0, depth - block_height); }

  /// Distance of the axis from an end at which that end stops to be the nearest face of any part of the flank: the most
  /// of the depth below top or bottom plus the flank's radius. Both are linear, with a kink half-way between the faces.
  double reach_of_end() const {
    const auto reach = [&](double s) {
      const double below_top = depth - s;
      return std::min(below_top, block_height - below_top) + radius / height * s;
    };
    const double half_way = std::max(bottom(), depth - 0.5 * block_height);
    return std::max({reach(bottom()), reach(half_way), reach(depth)});
  }
};

/// Scenarios Ia (thick block) and Ib (thin plate): a cone, apex down, slides along a block at a constant depth.
///
/// A's frame: x along the block, y up, z across; the block is [0, L] x [-h, 0] x [-w/2, w/2]. B's frame: apex at the
/// origin, axis +y. Pose: translation by (x, -depth, 0), x from -overshoot to L + overshoot. Reference point: middle of
/// the cone's bounding box. README.md derives the ideal models.
class ConeBlock final : public Scenario {
 public:
  ConeBlock(Description description, const Shape& shape)
      : Scenario(std::move(description),
                 box_solid({0.0, -shape.block_height, -0.5 * shape.block_width},
                           {shape.block_length, 0.0, 0.5 * shape.block_width}, "block"),
                 cone_solid(shape.radius, shape.height, shape.facets, shape.round, "cone")),
        shape_(shape),
        slope_(shape.radius / shape.height),
        tip_(slope_ * shape.depth),
        bottom_(shape.bottom()),
        end_reach_(shape.reach_of_end()) {}

  Pose pose(double progress) const override {
    return {Eigen::Matrix3d::Identity(), {apex_x(progress), -shape_.depth, 0.0}};
  }

  bool in_window(double progress) const override {
    const double x = apex_x(progress);
    const double to_end = std::min(x, shape_.block_length - x);
    return to_end >= std::max(tip_, end_reach_) && depth(x) == shape_.depth;
  }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const double x = apex_x(progress);
    switch (law) {
      case IdealLaw::depth:
        return upwards(depth(x));
      case IdealLaw::volume:
        return upwards(volume(x));
      case IdealLaw::gradient:
        return wrench(volume(x), gradient(x));
      case IdealLaw::energy:
        return wrench(volume(x), volume(x) * gradient(x));
      case IdealLaw::traction:
      case IdealLaw::wall_traction:
        return wrench(depth(x), traction(x, law == IdealLaw::wall_traction));
      case IdealLaw::normals:
        return normals(x);
      case IdealLaw::descent:
        return descent_of(x);
      // "p ~ delta" and "V ~ delta^3": constant while the bodies overlap.
      case IdealLaw::paper_depth:
        return upwards(depth(x) > 0.0 ? shape_.depth : 0.0);
      case IdealLaw::paper_volume:
        if (name() == "Ib") return std::nullopt;
        return upwards(depth(x) > 0.0 ? std::pow(shape_.depth, 3) : 0.0);
    }
    return std::nullopt;
  }

 private:
  double apex_x(double progress) const {
    return -shape_.overshoot + progress * (shape_.block_length + 2.0 * shape_.overshoot);
  }

  static IdealWrench upwards(double magnitude) { return {magnitude, {0.0, magnitude, 0.0}, Eigen::Vector3d::Zero()}; }

  /// Everything is symmetric in z: force z and torque x, y are zero.
  static IdealWrench wrench(double penalty, const PlaneWrench& w) {
    return {penalty, {w.x, w.y, 0.0}, {0.0, 0.0, w.torque}};
  }

  /// Translational penetration depth: delta, out of the top, or the displacement past an end edge perpendicular to the
  /// cone's flank, which is the part of the tip's radius over the block times the cosine of the half angle.
  double depth(double x) const {
    const double over = std::min(x, shape_.block_length - x) + tip_;
    const double cosine = 1.0 / std::sqrt(1.0 + slope_ * slope_);
    return std::clamp(over * cosine, 0.0, shape_.depth);
  }

  /// Disc of the cone at height s above the apex, cut to the block's length. Moment about the cone's axis.
  DiscPart section(double s, double x) const {
    const DiscPart from_start = disc_part(slope_ * s, -x);
    const DiscPart past_end = disc_part(slope_ * s, shape_.block_length - x);
    return {from_start.area - past_end.area, from_start.moment_x - past_end.moment_x};
  }

  /// Limits of the smooth pieces of section(s): a piece ends at the height s where the disc first reaches an end.
  std::vector<double> smooth_pieces(double x) const {
    std::vector<double> cuts{bottom_, shape_.depth};
    for (const double reach : {std::abs(x) / slope_, std::abs(shape_.block_length - x) / slope_}) {
      if (reach > bottom_ && reach < shape_.depth) cuts.push_back(reach);
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  double volume(double x) const {
    double sum = 0.0;
    const std::vector<double> cuts = smooth_pieces(x);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      sum += integrate_chords([&](double s) { return section(s, x).area; }, cuts[i], cuts[i + 1]);
    }
    return sum;
  }

  /// -grad V = integral of A's normal over the part of A's surface inside B: top, bottom and both ends.
  PlaneWrench gradient(double x) const {
    const double reference = 0.5 * shape_.height;  // above the apex
    const DiscPart top = section(shape_.depth, x);
    const DiscPart bottom = section(bottom_, x);
    PlaneWrench sum{0.0, top.area - bottom.area, top.moment_x - bottom.moment_x};
    for (const bool far_end : {false, true}) {
      const double offset = std::abs(far_end ? shape_.block_length - x : x);
      const double normal = far_end ? 1.0 : -1.0;
      const double from = std::max(bottom_, offset / slope_);
      const auto chord = [&](double s) {
        const double r = slope_ * s;
        return 2.0 * std::sqrt(std::max(0.0, (r - offset) * (r + offset)));
      };
      sum.x += normal * integrate_chords(chord, from, shape_.depth);
      sum.torque -= normal * integrate_chords([&](double s) { return (s - reference) * chord(s); }, from, shape_.depth);
    }
    return sum;
  }

  /// Integral over the cone's flank inside the block of the depth below the nearest face.
  PlaneWrench traction(double x, bool along_wall) const {
    // The inner integral has kinks at heights that are not known in closed form; more panels do not lower the error.
    constexpr int k_panels = 8;
    std::vector<double> cuts = smooth_pieces(x);
    const double half_way = shape_.depth - 0.5 * shape_.block_height;  // between the block's bottom and top
    if (half_way > bottom_) cuts.push_back(half_way);
    for (int i = 1; i < k_panels; ++i) cuts.push_back(bottom_ + (shape_.depth - bottom_) * i / k_panels);
    std::sort(cuts.begin(), cuts.end());
    PlaneWrench sum;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      sum += integrate_wrench([&](double s) { return ring_traction(s, x, along_wall); }, cuts[i], cuts[i + 1]);
    }
    return sum;
  }

  /// About a point near the intersection: its moments about the reference point would lose its size to rounding.
  IdealWrench descent_of(double x) const {
    const double from = std::max(-tip_, -x), to = std::min(tip_, shape_.block_length - x);
    const Eigen::Vector2d near(0.5 * (from + to), shape_.depth);  // across the cone's axis, and above the apex
    const auto over_height = [&](const auto& f) {
      const std::vector<double> cuts = smooth_pieces(x);
      double sum = 0.0;
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) sum += integrate_chords(f, cuts[i], cuts[i + 1]);
      return sum;
    };
    const auto area = [&](double s) { return section(s, x).area; };
    /// Integral of the squared distance from the vertical through `near`.
    const auto polar = [&](double s) {
      const double r = slope_ * s;
      const auto across = [&](double at) {
        const double half = std::sqrt(std::max(0.0, (r - at) * (r + at)));
        return 2.0 * half * ((at - near.x()) * (at - near.x()) + half * half / 3.0);
      };
      return integrate_chords(across, std::max(-r, -x), std::min(r, shape_.block_length - x));
    };
    const OverlapMoments moments{
        over_height(area),
        {over_height([&](double s) { return section(s, x).moment_x - near.x() * area(s); }),
         over_height([&](double s) { return (s - near.y()) * area(s); }), 0.0},
        over_height([&](double s) { return polar(s) + (s - near.y()) * (s - near.y()) * area(s); })};
    const Eigen::Vector3d arm(near.x(), near.y() - 0.5 * shape_.height, 0.0);
    return descent(wrench(volume(x), gradient(x)), moments, arm);
  }

  /// The part of n_A is half the traction: both are integrals of the gradient of the depth below A's surface.
  IdealWrench normals(double x) const {
    const NormalsWrench of_b = cone_normals({.slope = slope_,
                                             .height = shape_.height,
                                             .bottom = bottom_,
                                             .top = shape_.depth,
                                             .before = x,
                                             .beyond = shape_.block_length - x});
    IdealWrench sum = wrench(volume(x), 0.5 * traction(x, false));
    sum.force += of_b.force;
    sum.torque += of_b.torque;
    return sum;
  }

  /// Traction of the flank's ring at height s above the apex, per unit of s.
  PlaneWrench ring_traction(double s, double x, bool along_wall) const {
    const double below_top = shape_.depth - s;
    const double above_bottom = shape_.block_height - below_top;
    const double vertical = std::min(below_top, above_bottom);
    const double r = slope_ * s;
    const double flank = std::sqrt(1.0 + slope_ * slope_);
    const double arm_y = s - 0.5 * shape_.height;
    // Angles at which an end face becomes the nearest face, or at which the block ends.
    std::vector<double> angles{0.0, std::numbers::pi};
    for (const double at_x : {0.0, vertical, shape_.block_length - vertical, shape_.block_length}) {
      const double cosine = r > 0.0 ? (at_x - x) / r : 2.0;
      if (std::abs(cosine) < 1.0) angles.push_back(std::acos(cosine));
    }
    std::sort(angles.begin(), angles.end());
    PlaneWrench sum;
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
      const double from = angles[i];
      const double to = angles[i + 1];
      const double middle = x + r * std::cos(0.5 * (from + to));
      if (middle <= 0.0 || middle >= shape_.block_length) continue;
      // One face is the nearest on the whole piece.
      const double to_start = middle;
      const double to_end = shape_.block_length - middle;
      const bool start = to_start < std::min(vertical, to_end);
      const bool end = !start && to_end < vertical;
      const auto element = [&](double angle) {
        const double arm_x = r * std::cos(angle);
        const double d = start ? x + arm_x : end ? shape_.block_length - x - arm_x : vertical;
        double nx = -std::cos(angle) / flank;  // inward normal of the cone
        double ny = slope_ / flank;
        if (along_wall) {
          nx = start ? -1.0 : end ? 1.0 : 0.0;
          ny = start || end ? 0.0 : below_top <= above_bottom ? 1.0 : -1.0;
        }
        return PlaneWrench::of({arm_x, arm_y}, {d * nx, d * ny});
      };
      sum += integrate_wrench(element, from, to);
    }
    // Both sides of the plane z = 0; area element r flank dangle ds.
    return 2.0 * r * flank * sum;
  }

  Shape shape_;
  double slope_;      ///< radius / height of the cone
  double tip_;        ///< radius of the cone in the plane of the block's top
  double bottom_;     ///< lowest s inside the block, s: height above the apex
  double end_reach_;  ///< See Shape::reach_of_end().
};

}  // namespace

Settings cone_block_settings(bool thin) {
  return settings_with_round_parts({
      length_parameter("cone_height", "height H of the cone", "60"),
      length_parameter("cone_radius", "radius r of the cone's base", "30"),
      length_parameter("block_length", "length L of the block along the path", "900"),
      length_parameter("block_height", "thickness h of the block", thin ? "0.2" : "30"),
      length_parameter("block_width", "width of the block across the path", "375"),
      length_parameter("depth", "how far the apex is below the block's top, delta", "20"),
      length_parameter("overshoot", "path before and behind the block, a", "30"),
  });
}

std::unique_ptr<Scenario> make_cone_block(const Settings& settings, bool thin) {
  const Shape shape(settings);
  const std::vector<std::string> rules{
      "The block is a closed solid; an algorithm may not be told which face the cone came through.",
      "Force and torque are those on the cone, about the middle of its bounding box.",
      "Plain measures are taken where the tip is over the block and nearer to its top or bottom than to an end; the "
      "suffix _all means the whole path."};
  ConeBlock::Description description{
      thin ? "Ib" : "Ia",
      thin ? "Does a plate far thinner than the penetration still push back, or does the cone tunnel through it?"
           : "Does a sharp tip that slides over a flat face feel a constant force along the face's normal?",
      rules,
      {0.0, 0.5 * shape.height, 0.0},
      shape.radius,
      false};
  return std::make_unique<ConeBlock>(std::move(description), shape);
}

}  // namespace sixdof
