#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <sixdof/scenario/kinds.h>
#include <sixdof/scenario/normals.h>
#include <sixdof/scenario/plane.h>

namespace sixdof {
namespace {

// Scenarios III and IV: a plate with a square and a round pin, and a block with the matching holes.
//
// A's frame: the block's top is z = 0, its middle on the z axis; square hole at (-b/4, 0), round hole at (+b/4, 0).
// B's frame is the same for the plate, whose underside lies ON the block's top along both paths: a superfluous contact
// that must not act. README.md derives the ideal models.

constexpr const char* k_superfluous = "The plate lies on the block all along: that contact must not act.";

PinsShape shape_of(const Settings& s) {
  return {.width = s.number("width"),
          .depth = s.number("depth"),
          .square_side = s.number("square_side"),
          .round_radius = s.number("round_radius"),
          .plate_thickness = s.number("plate_thickness"),
          .facets = static_cast<int>(s.number("facets")),
          .round = round_parts_of(s)};
}

/// Length available to one pin: the smaller extent of its half of the block.
double half_block(const PinsShape& shape) { return std::min(0.5 * shape.width, shape.depth); }

void check_pins(const PinsShape& shape) {
  // A rotating square sweeps its diagonal; the vertices of an equal-area polygon lie slightly outside the circle.
  require(shape.square_side * std::numbers::sqrt2 < half_block(shape),
          "square_side is too large for its half of the block");
  require(2.0 * polygon_radius(shape.round_radius, shape.facets, shape.round) < half_block(shape),
          "round_radius is too large for its half of the block");
}

/// @param path the parameter of the path
Settings pins_settings(Parameter path) {
  return settings_with_round_parts({
      length_parameter("width", "width b of plate and block", "80"),
      length_parameter("depth", "depth a of plate and block; also height of the block and length of the pins", "40"),
      length_parameter("square_side", "side c of the square pin", "20"),
      length_parameter("round_radius", "radius r of the round pin", "10"),
      length_parameter("plate_thickness", "thickness of the plate that carries the pins", "10"),
      std::move(path),
  });
}

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

/// Load of a vertical line of the wall at depth d.
double line_load(double d, double length, bool along_wall) { return d * (along_wall ? length - 2.0 * d : length - d); }

/// Scenario III: only the square pin is in its hole, and rotates about its own axis.
///
/// X_AB rotates by pi - phi about the square hole's axis, phi = 0 .. rotation_degrees: at pi the round pin is outside
/// the block. The rotation is clockwise, so that the torque that reverses it points along +z, as in the paper.
/// Reference: middle of the square pin.
class RotatingPin final : public Scenario {
 public:
  /// @param largest_phi radians
  RotatingPin(Description description, const PinsShape& shape, double largest_phi)
      : Scenario(std::move(description), holes_solid(shape, "holes"), pins_solid(shape, "pins")),
        shape_(shape),
        largest_phi_(largest_phi) {}

  Pose pose(double progress) const override {
    const double phi = progress * largest_phi_;
    Pose rotated;
    // Rotation by pi - phi; exact at phi = 0.
    rotated.R << -std::cos(phi), -std::sin(phi), 0.0, std::sin(phi), -std::cos(phi), 0.0, 0.0, 0.0, 1.0;
    const Eigen::Vector3d axis(-0.25 * shape_.width, 0.0, 0.0);
    rotated.t = axis - rotated.R * axis;
    return rotated;
  }

  /// At phi = 0 the pin exactly fits: V has a kink in every direction, and its gradient is a set.
  bool in_window(double progress) const override { return progress > 0.0; }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const double phi = progress * largest_phi_;
    const double c = shape_.square_side;
    const double length = shape_.depth;
    const double bulge = std::numbers::sqrt2 * std::cos(0.25 * std::numbers::pi - phi) - 1.0;  // sin + cos - 1
    const double p = 0.5 * c * bulge;
    const double v = length * c * c * bulge / (bulge + 2.0);
    // dV / dphi; at phi = 0 the mean of the two one-sided derivatives is 0.
    const double slope =
        phi > 0.0 ? length * c * c * 2.0 * (std::cos(phi) - std::sin(phi)) / ((bulge + 2.0) * (bulge + 2.0)) : 0.0;
    const auto twist = [](double penalty, double torque, double lift = 0.0) {
      return IdealWrench{penalty, {0.0, 0.0, lift}, {0.0, 0.0, torque}};
    };
    // -dV / dz on the side where the plate leaves the block: the part of the pin outside its hole gets shorter. By
    // symmetry that part is centred at the axis, so there is no torque.
    const double lift = v / length;
    switch (law) {
      case IdealLaw::depth:
        return twist(p, p);
      case IdealLaw::volume:
        return twist(v, v);
      case IdealLaw::gradient:
        return twist(v, slope, lift);
      case IdealLaw::energy:
        return twist(v, v * slope, v * lift);
      case IdealLaw::traction:
      case IdealLaw::wall_traction:
        return twist(
            p, square_pin_traction(c, length, -phi, Eigen::Vector2d::Zero(), law == IdealLaw::wall_traction).torque);
      case IdealLaw::normals: {
        const NormalsWrench w = square_pin_normals(c, length, -phi, Eigen::Vector2d::Zero());
        return IdealWrench{v, w.force, w.torque};
      }
      case IdealLaw::descent:
        return descent(twist(v, slope, lift), square_pin_moments(c, length, -phi, Eigen::Vector2d::Zero()));
      // "p ~ sin(phi/2) - 1": negative throughout, so the torque is its absolute value.
      case IdealLaw::paper_depth:
        return twist(std::sin(0.5 * phi) - 1.0, 1.0 - std::sin(0.5 * phi));
      case IdealLaw::paper_volume: {
        const double printed = phi > 0.0 ? bulge * bulge / std::tan(0.5 * phi) : 0.0;
        return twist(printed, printed);
      }
    }
    return std::nullopt;
  }

 private:
  PinsShape shape_;
  double largest_phi_;
};

/// Scenario IV: both pins are in their holes, and move along a small circle without rotation.
///
/// X_AB is the translation by orbit_radius (cos 2 pi s, sin 2 pi s, 0). Reference: between the pins, at the middle of
/// their length.
class OrbitingPins final : public Scenario {
 public:
  /// @param orbit radius rho of the path
  OrbitingPins(Description description, const PinsShape& shape, double orbit)
      : Scenario(std::move(description), holes_solid(shape, "holes"), pins_solid(shape, "pins")),
        shape_(shape),
        length_(shape.depth),
        orbit_(orbit) {}

  Pose pose(double progress) const override {
    const Eigen::Vector2d d = orbit_ * direction(progress);
    return {Eigen::Matrix3d::Identity(), {d.x(), d.y(), 0.0}};
  }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const Eigen::Vector2d u = direction(progress);
    const double v = square_volume(u) + round_volume();
    switch (law) {
      // Both pins are equally deep: their forces are equal, at opposite arms.
      case IdealLaw::depth:
      case IdealLaw::paper_depth:
        return both(orbit_, -0.5 * orbit_ * u, -0.5 * orbit_ * u, 0.0);
      case IdealLaw::volume:
        return both(v, -square_volume(u) * u, -round_volume() * u, 0.0);
      case IdealLaw::gradient:
        return gradient(u, 1.0);
      case IdealLaw::energy:
        return gradient(u, v);
      case IdealLaw::traction:
      case IdealLaw::wall_traction:
        return traction(u, law == IdealLaw::wall_traction);
      case IdealLaw::normals:
        return normals(u);
      case IdealLaw::descent:
        return descent(gradient(u, 1.0), moments(u));
      case IdealLaw::paper_volume: {
        // As printed, without the pins' length; the integral's limits are c/2 and r, so it is empty if c = 2 r.
        const double c = shape_.square_side;
        const double r = shape_.round_radius;
        const double integral = r * r * (r - 0.5 * c) - (r * r * r - 0.125 * c * c * c) / 3.0;
        const double printed = square_volume(u) / length_ + std::numbers::pi * r * r - 4.0 * integral;
        return both(printed, -0.5 * printed * u, -0.5 * printed * u, 0.0);
      }
    }
    return std::nullopt;
  }

 private:
  static Eigen::Vector2d direction(double progress) {
    const double angle = 2.0 * std::numbers::pi * progress;
    return {std::cos(angle), std::sin(angle)};
  }

  /// Forces of the square and the round pin at their centres; `own` is the torque about those centres.
  IdealWrench both(double penalty, const Eigen::Vector2d& square, const Eigen::Vector2d& round, double own) const {
    const double arm = 0.25 * shape_.width;
    const Eigen::Vector2d sum = square + round;
    return {penalty, {sum.x(), sum.y(), 0.0}, {0.0, 0.0, arm * (round.y() - square.y()) + own}};
  }

  /// Areas of the pins' cross-sections inside and outside their holes.
  double square_inside(const Eigen::Vector2d& u) const {
    const Eigen::Vector2d free = Eigen::Vector2d::Constant(shape_.square_side) - orbit_ * u.cwiseAbs();
    return free.x() * free.y();
  }
  double square_outside(const Eigen::Vector2d& u) const {
    return shape_.square_side * shape_.square_side - square_inside(u);
  }
  double round_inside() const { return lens_area(shape_.round_radius, shape_.round_radius, orbit_); }
  double round_outside() const { return std::numbers::pi * shape_.round_radius * shape_.round_radius - round_inside(); }

  double square_volume(const Eigen::Vector2d& u) const { return length_ * square_outside(u); }
  double round_volume() const { return length_ * round_outside(); }

  IdealWrench gradient(const Eigen::Vector2d& u, double factor) const {
    const double c = shape_.square_side;
    const Eigen::Vector2d d = (orbit_ * u).cwiseAbs();
    const Eigen::Vector2d square(-sign(u.x()) * length_ * (c - d.y()), -sign(u.y()) * length_ * (c - d.x()));
    const Eigen::Vector2d round = -length_ * lens_chord(shape_.round_radius, shape_.round_radius, orbit_) * u;
    // Torque of the square about its own centre: of the strips outside the hole, where they pass the hole's corners.
    const double own = 0.5 * length_ * sign(u.x() * u.y()) * (d.x() * (c - d.x()) - d.y() * (c - d.y()));
    IdealWrench wrench = both(square_volume(u) + round_volume(), factor * square, factor * round, factor * own);
    // -dV / dz on the side where the plate leaves the block: the parts outside the holes get shorter. Their first
    // moment about the reference point is that of the whole pins minus that of the parts inside, whose centres are at
    // -d / 2.
    const Eigen::Vector2d pins(0.25 * shape_.width * (round_outside() - square_outside(u)), 0.0);
    const Eigen::Vector2d moment = pins + 0.5 * orbit_ * (square_inside(u) + round_inside()) * u;
    wrench.force.z() = factor * (square_outside(u) + round_outside());
    wrench.torque.x() = factor * moment.y();
    wrench.torque.y() = -factor * moment.x();
    return wrench;
  }

  IdealWrench traction(const Eigen::Vector2d& u, bool along_wall) const {
    const Eigen::Vector2d d = orbit_ * u;
    const PlaneWrench square = square_pin_traction(shape_.square_side, length_, 0.0, d, along_wall);
    const PlaneWrench round = round_pin_traction(shape_.round_radius, length_, d, along_wall);
    // About its own centre the round pin has no torque: it is its own mirror image in the line of the shift.
    return both(orbit_, square.force(), round.force(), square.torque);
  }

  IdealWrench normals(const Eigen::Vector2d& u) const {
    const Eigen::Vector2d d = orbit_ * u;
    const NormalsWrench square = square_pin_normals(shape_.square_side, length_, 0.0, d);
    const NormalsWrench round = round_pin_normals(shape_.round_radius, length_, d);
    const Eigen::Vector3d arm(0.25 * shape_.width, 0.0, 0.0);
    return {square_volume(u) + round_volume(), square.force + round.force,
            square.torque - arm.cross(square.force) + round.torque + arm.cross(round.force)};
  }

  OverlapMoments moments(const Eigen::Vector2d& u) const {
    const Eigen::Vector2d d = orbit_ * u;
    const Eigen::Vector3d arm(0.25 * shape_.width, 0.0, 0.0);
    const OverlapMoments square = square_pin_moments(shape_.square_side, length_, 0.0, d).moved(-arm);
    const OverlapMoments round = round_pin_moments(shape_.round_radius, length_, d).moved(arm);
    return {square.volume + round.volume, square.first + round.first, square.second + round.second};
  }

  PinsShape shape_;
  double length_;  ///< Of the pins.
  double orbit_;
};

}  // namespace

PlaneWrench square_pin_traction(double side, double length, double angle, const Eigen::Vector2d& shift,
                                bool along_wall) {
  const double half = 0.5 * side;
  PlaneWrench sum;
  for (int quarter = 0; quarter < 4; ++quarter) {
    // Rotation by quarters by exact exchange of sine and cosine.
    const std::array<double, 4> cosines{std::cos(angle), -std::sin(angle), -std::cos(angle), std::sin(angle)};
    const Eigen::Vector2d normal(cosines[static_cast<std::size_t>(quarter)],
                                 cosines[static_cast<std::size_t>((quarter + 3) % 4)]);
    const Eigen::Vector2d along(-normal.y(), normal.x());
    const auto arm = [&](double t) { return Eigen::Vector2d(half * normal + t * along); };
    const auto element = [&](double t) {
      const Eigen::Vector2d p = shift + arm(t);
      const Eigen::Vector2d excess = (p.cwiseAbs().array() - half).max(0.0);
      const double d = excess.norm();
      if (d == 0.0) return PlaneWrench{};
      const Eigen::Vector2d wall = -(excess.array() * p.array().sign()).matrix() / d;
      const Eigen::Vector2d direction = along_wall ? wall : Eigen::Vector2d(-normal);
      return PlaneWrench::of(arm(t), line_load(d, length, along_wall) * direction);
    };
    // The depth has kinks where this side crosses the lines of the hole's walls.
    std::vector<double> cuts{-half, half};
    for (int axis = 0; axis < 2; ++axis) {
      for (const double line : {-half, half}) {
        if (along[axis] == 0.0) continue;
        const double t = (line - shift[axis] - half * normal[axis]) / along[axis];
        if (std::abs(t) < half) cuts.push_back(t);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      sum += integrate_wrench(element, cuts[i], cuts[i + 1]);
    }
  }
  return sum;
}

PlaneWrench round_pin_traction(double r, double length, const Eigen::Vector2d& shift, bool along_wall) {
  PlaneWrench sum;
  const double distance = shift.norm();
  if (distance == 0.0) return sum;
  const double middle = std::atan2(shift.y(), shift.x());
  const auto element = [&](double angle) {
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d p = shift + r * normal;
    const double d = p.norm() - r;
    const Eigen::Vector2d direction = along_wall ? Eigen::Vector2d(-p / p.norm()) : Eigen::Vector2d(-normal);
    return PlaneWrench::of(r * normal, r * line_load(d, length, along_wall) * direction);
  };
  // The part of the wall outside the hole: |shift + r normal| > r.
  const double reach = std::acos(std::clamp(-0.5 * distance / r, -1.0, 1.0));
  sum += integrate_wrench(element, middle - reach, middle + reach);
  return sum;
}

Settings rotating_pin_settings() {
  return pins_settings(
      Parameter::number("rotation_degrees", "largest rotation phi of the square pin", "degree", "30", 1e-3, 45.0));
}

std::unique_ptr<Scenario> make_rotating_pin(const Settings& settings) {
  const PinsShape shape = shape_of(settings);
  const double largest_phi = settings.number("rotation_degrees") * std::numbers::pi / 180.0;
  check_pins(shape);
  require(0.5 * shape.width * std::cos(largest_phi) - polygon_radius(shape.round_radius, shape.facets, shape.round) >
              0.25 * shape.width,
          "the round pin rotates into the block's side");
  return std::make_unique<RotatingPin>(
      Scenario::Description{
          "III",
          "Does a large contact of flat walls give a pure torque that grows with the rotation?",
          {k_superfluous, "Force and torque are those on the pins, about the middle of the square pin."},
          {-0.25 * shape.width, 0.0, -0.5 * shape.depth},
          shape.square_side,
          false},
      shape, largest_phi);
}

Settings orbiting_pins_settings() {
  return pins_settings(length_parameter("orbit_radius", "radius rho of the circle along which the pins move", "2"));
}

std::unique_ptr<Scenario> make_orbiting_pins(const Settings& settings) {
  const PinsShape shape = shape_of(settings);
  const double orbit = settings.number("orbit_radius");
  check_pins(shape);
  require(orbit < 0.5 * shape.square_side && orbit < 2.0 * shape.round_radius,
          "orbit_radius must be small against the pins");
  require(0.5 * (half_block(shape) - shape.square_side) > orbit && 0.5 * half_block(shape) - shape.round_radius > orbit,
          "the walls between the holes are too thin for orbit_radius");
  return std::make_unique<OrbitingPins>(
      Scenario::Description{
          "IV",
          "Does a small displacement inside a tight fit give a small force back to the fit, and no other?",
          {k_superfluous,
           "Force and torque are those on the pins, about the point between them at the middle of their length."},
          {0.0, 0.0, -0.5 * shape.depth},
          shape.square_side,
          true},
      shape, orbit);
}

}  // namespace sixdof
