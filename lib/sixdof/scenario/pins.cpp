#include <sixdof/scenario/pins.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <sixdof/scenario/circles.h>
#include <sixdof/scenario/parameters.h>
#include <sixdof/scenario/pin_traction.h>

namespace sixdof {
namespace {

struct Shape : PinsShape {
  double turn;   ///< Largest phi, radians.
  double orbit;  ///< rho.

  Shape(const Settings& s, PinsPath path) {
    width = s.number("width");
    depth = s.number("depth");
    square_side = s.number("square_side");
    round_radius = s.number("round_radius");
    plate_thickness = s.number("plate_thickness");
    facets = facets_of(s);
    round = round_parts_of(s);
    turn = path == PinsPath::turn ? s.number("turn_degrees") * std::numbers::pi / 180.0 : 0.0;
    orbit = path == PinsPath::orbit ? s.number("orbit_radius") : 0.0;

    const double narrow = std::min(0.5 * width, depth);  // the room of one pin
    // The square's corners while it turns; the round polygon's corners, which stand out of the circle a little.
    require(square_side * std::numbers::sqrt2 < narrow, "square_side is too large for its half of the block");
    require(2.0 * polygon_radius(round_radius, facets, round) < narrow,
            "round_radius is too large for its half of the block");
    if (path == PinsPath::turn) {
      require(0.5 * width * std::cos(turn) - polygon_radius(round_radius, facets, round) > 0.25 * width,
              "the round pin turns into the block's side");
    } else {
      require(orbit < 0.5 * square_side && orbit < 2.0 * round_radius, "orbit_radius must be small against the pins");
      require(0.5 * (narrow - square_side) > orbit && 0.5 * narrow - round_radius > orbit,
              "the walls between the holes are too thin for orbit_radius");
    }
  }

  double pin_length() const { return depth; }
};

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

/// Dimensions of block and holes; `part` of the plane with a margin for them.
Sketch pins_sketch(const Shape& shape, double left) {
  Sketch sketch;
  const double b = shape.width;
  const double a = shape.depth;
  const double c = shape.square_side;
  const double r = shape.round_radius;
  sketch.part = {Eigen::Vector2d(left, -0.85 * a), Eigen::Vector2d(0.62 * b, 0.9 * a)};
  sketch.up = Eigen::Vector3d::UnitZ();
  sketch.underside = true;  // the plate hides its pins
  sketch.dimensions = {
      {{-0.5 * b, -0.5 * a}, {0.5 * b, -0.5 * a}, {0.0, -0.2 * a}, fmt::format("b = {:g}", b)},
      {{0.5 * b, -0.5 * a}, {0.5 * b, 0.5 * a}, {0.12 * a, 0.0}, fmt::format("a = {:g}", a)},
      {{-0.25 * b - 0.5 * c, -0.5 * c}, {-0.25 * b + 0.5 * c, -0.5 * c}, {0.0, -0.15 * a}, fmt::format("c = {:g}", c)},
      {{0.25 * b, 0.0}, {0.25 * b + r, 0.0}, {0.0, -0.4 * a}, fmt::format("r = {:g}", r)}};
  return sketch;
}

class TurningPin final : public Scenario {
 public:
  TurningPin(About about, const Shape& shape)
      : Scenario(std::move(about), holes_solid(shape, "holes"), pins_solid(shape, "pins")), shape_(shape) {}

  Pose pose(double progress) const override {
    const double phi = progress * shape_.turn;
    Pose turn;
    // Rotation by pi - phi; exactly half a turn at phi = 0.
    turn.R << -std::cos(phi), -std::sin(phi), 0.0, std::sin(phi), -std::cos(phi), 0.0, 0.0, 0.0, 1.0;
    const Eigen::Vector3d axis(-0.25 * shape_.width, 0.0, 0.0);
    turn.t = axis - turn.R * axis;
    return turn;
  }

  /// At phi = 0 the pin just fits: V has a kink there in every direction, and its gradient is a set.
  bool in_window(double progress) const override { return progress > 0.0; }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const double phi = progress * shape_.turn;
    const double c = shape_.square_side;
    const double bulge = std::numbers::sqrt2 * std::cos(0.25 * std::numbers::pi - phi) - 1.0;  // sin + cos - 1
    const double p = 0.5 * c * bulge;
    const double v = shape_.pin_length() * c * c * bulge / (bulge + 2.0);
    // dV / dphi; at phi = 0 the mean of the two one-sided derivatives is 0.
    const double slope = phi > 0.0 ? shape_.pin_length() * c * c * 2.0 * (std::cos(phi) - std::sin(phi)) /
                                         ((bulge + 2.0) * (bulge + 2.0))
                                   : 0.0;
    const auto twist = [](double penalty, double torque, double lift = 0.0) {
      return IdealWrench{penalty, {0.0, 0.0, lift}, {0.0, 0.0, torque}};
    };
    // -dV / dz where the plate leaves the block: what sticks out, by symmetry centred at the axis, gets shorter.
    const double lift = v / shape_.pin_length();
    const auto traction = [&](bool along_wall) {
      const PinTraction t = square_pin_traction(c, shape_.pin_length(), -phi, Eigen::Vector2d::Zero(), along_wall);
      return twist(p, t.torque);
    };
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
        return traction(false);
      case IdealLaw::wall_traction:
        return traction(true);
      // "p ~ sin(phi/2) - 1": negative throughout, so its amount.
      case IdealLaw::paper_depth:
        return twist(std::sin(0.5 * phi) - 1.0, 1.0 - std::sin(0.5 * phi));
      case IdealLaw::paper_volume: {
        const double printed = phi > 0.0 ? bulge * bulge / std::tan(0.5 * phi) : 0.0;
        return twist(printed, printed);
      }
    }
    return std::nullopt;
  }

  Sketch sketch() const override {
    Sketch sketch = pins_sketch(shape_, -1.15 * shape_.width);
    sketch.progress = 1.0;
    return sketch;
  }

 private:
  Shape shape_;
};

class OrbitingPins final : public Scenario {
 public:
  OrbitingPins(About about, const Shape& shape)
      : Scenario(std::move(about), holes_solid(shape, "holes"), pins_solid(shape, "pins")), shape_(shape) {}

  Pose pose(double progress) const override {
    const Eigen::Vector2d d = shape_.orbit * direction(progress);
    return {Eigen::Matrix3d::Identity(), {d.x(), d.y(), 0.0}};
  }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const Eigen::Vector2d u = direction(progress);
    const double v = square_volume(u) + round_volume();
    switch (law) {
      // Both pins are as deep: their forces are equal, at opposite arms.
      case IdealLaw::depth:
        return both(shape_.orbit, -0.5 * shape_.orbit * u, -0.5 * shape_.orbit * u, 0.0);
      case IdealLaw::volume:
        return both(v, -square_volume(u) * u, -round_volume() * u, 0.0);
      case IdealLaw::gradient:
        return gradient(u, 1.0);
      case IdealLaw::energy:
        return gradient(u, v);
      case IdealLaw::traction:
        return traction(u, false);
      case IdealLaw::wall_traction:
        return traction(u, true);
      case IdealLaw::paper_depth:
        return both(shape_.orbit, -0.5 * shape_.orbit * u, -0.5 * shape_.orbit * u, 0.0);
      case IdealLaw::paper_volume: {
        // As printed, without the pins' length; the integral's limits are c/2 and r, and c = 2 r makes it empty.
        const double c = shape_.square_side;
        const double r = shape_.round_radius;
        const double empty_integral = r * r * (r - 0.5 * c) - (r * r * r - 0.125 * c * c * c) / 3.0;
        const double printed = square_volume(u) / shape_.pin_length() + std::numbers::pi * r * r - 4.0 * empty_integral;
        return both(printed, -0.5 * printed * u, -0.5 * printed * u, 0.0);
      }
    }
    return std::nullopt;
  }

  Sketch sketch() const override {
    Sketch sketch = pins_sketch(shape_, -0.7 * shape_.width);
    sketch.progress = 0.125;
    const Eigen::Vector2d d = shape_.orbit * direction(sketch.progress);
    sketch.dimensions.push_back({Eigen::Vector2d::Zero(), d,
                                 0.8 * shape_.depth * Eigen::Vector2d(-d.y(), d.x()) / d.norm(),
                                 fmt::format("\u03c1 = {:g}", shape_.orbit)});
    return sketch;
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
    const Eigen::Vector2d free = Eigen::Vector2d::Constant(shape_.square_side) - shape_.orbit * u.cwiseAbs();
    return free.x() * free.y();
  }
  double square_outside(const Eigen::Vector2d& u) const {
    return shape_.square_side * shape_.square_side - square_inside(u);
  }
  double round_inside() const { return lens_area(shape_.round_radius, shape_.round_radius, shape_.orbit); }
  double round_outside() const { return std::numbers::pi * shape_.round_radius * shape_.round_radius - round_inside(); }

  double square_volume(const Eigen::Vector2d& u) const { return shape_.pin_length() * square_outside(u); }
  double round_volume() const { return shape_.pin_length() * round_outside(); }

  IdealWrench gradient(const Eigen::Vector2d& u, double factor) const {
    const double c = shape_.square_side;
    const double length = shape_.pin_length();
    const Eigen::Vector2d d = (shape_.orbit * u).cwiseAbs();
    const Eigen::Vector2d square(-sign(u.x()) * length * (c - d.y()), -sign(u.y()) * length * (c - d.x()));
    const Eigen::Vector2d round = -length * lens_chord(shape_.round_radius, shape_.round_radius, shape_.orbit) * u;
    // Turning the square about its own centre: the strips that stick out beside the holes' corners.
    const double own = 0.5 * length * sign(u.x() * u.y()) * (d.x() * (c - d.x()) - d.y() * (c - d.y()));
    IdealWrench wrench = both(square_volume(u) + round_volume(), factor * square, factor * round, factor * own);
    // -dV / dz where the plate leaves the block: what sticks out of the holes gets shorter. First moment of those areas
    // about the reference point: a whole pin less the part inside, whose centre is half of d back.
    const Eigen::Vector2d pins(0.25 * shape_.width * (round_outside() - square_outside(u)), 0.0);
    const Eigen::Vector2d moment = pins + 0.5 * shape_.orbit * (square_inside(u) + round_inside()) * u;
    wrench.force.z() = factor * (square_outside(u) + round_outside());
    wrench.torque.x() = factor * moment.y();
    wrench.torque.y() = -factor * moment.x();
    return wrench;
  }

  IdealWrench traction(const Eigen::Vector2d& u, bool along_wall) const {
    const Eigen::Vector2d d = shape_.orbit * u;
    const PinTraction square = square_pin_traction(shape_.square_side, shape_.pin_length(), 0.0, d, along_wall);
    const PinTraction round = round_pin_traction(shape_.round_radius, shape_.pin_length(), d, along_wall);
    // About its own centre the round pin has no torque: it is its own mirror image in the line of the shift.
    return both(shape_.orbit, square.force, round.force, square.torque);
  }

  Shape shape_;
};

}  // namespace

Settings pins_settings(PinsPath path) {
  std::vector<Parameter> parameters{
      length_parameter("width", "width b of plate and block", "80"),
      length_parameter("depth", "depth a of plate and block; also height of the block and length of the pins", "40"),
      length_parameter("square_side", "side c of the square pin", "20"),
      length_parameter("round_radius", "radius r of the round pin", "10"),
      length_parameter("plate_thickness", "thickness of the plate that carries the pins", "10"),
  };
  if (path == PinsPath::turn) {
    parameters.push_back({.name = "turn_degrees",
                     .meaning = "largest turn phi of the square pin",
                     .unit = "degree",
                     .standard = "30",
                     .low = 1e-3,
                     .high = 45.0});
  } else {
    parameters.push_back(length_parameter("orbit_radius", "radius rho of the circle the pins are carried round", "2"));
  }
  add_round_parameters(parameters);
  return Settings(std::move(parameters));
}

std::unique_ptr<Scenario> make_pins(const Settings& settings, PinsPath path) {
  const Shape shape(settings, path);
  const double middle = -0.5 * shape.depth;
  const std::string superfluous = "The plate lies on the block all along: that contact must not act.";
  if (path == PinsPath::turn) {
    TurningPin::About about{
        "III",
        "Does a large contact of flat walls give a pure torque that grows with the turn?",
        {superfluous, "Force and torque are those on the pins, about the middle of the square pin."},
        {-0.25 * shape.width, 0.0, middle},
        shape.square_side,
        false};
    return std::make_unique<TurningPin>(std::move(about), shape);
  }
  OrbitingPins::About about{
      "IV",
      "Does a small displacement inside a snug fit give a small force that leads back to the fit, and no other?",
      {superfluous,
       "Force and torque are those on the pins, about the point between them at the middle of their length."},
      {0.0, 0.0, middle},
      shape.square_side,
      true};
  return std::make_unique<OrbitingPins>(std::move(about), shape);
}

}  // namespace sixdof
