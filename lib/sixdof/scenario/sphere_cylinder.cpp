#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <sixdof/scenario/kinds.h>
#include <sixdof/scenario/normals.h>
#include <sixdof/scenario/plane.h>

namespace sixdof {
namespace {

struct Shape {
  double sphere_radius, cylinder_radius, cylinder_length, orbit;
  int facets;
  RoundParts round;

  explicit Shape(const Settings& s)
      : sphere_radius(s.number("sphere_radius")),
        cylinder_radius(s.number("cylinder_radius")),
        cylinder_length(s.number("cylinder_length")),
        orbit(s.number("orbit_radius")),
        facets(static_cast<int>(s.number("facets"))),
        round(round_parts_of(s)) {
    require(orbit < sphere_radius + cylinder_radius, "the sphere never touches: orbit_radius is too large");
    require(orbit > cylinder_radius && orbit > sphere_radius,
            "one centre is inside the other body: orbit_radius must exceed both radii");
    // With this the nearest face is never a flat end: the part inside is nearer to the wall than to the ends.
    require(0.5 * cylinder_length > half_height() + sphere_radius + cylinder_radius - orbit,
            "the sphere meets the cylinder's ends: cylinder_length is too small");
  }

  /// Half height of the common part: there the sphere's horizontal circle touches the cylinder.
  double half_height() const {
    const double reach = orbit - cylinder_radius;
    return std::sqrt((sphere_radius - reach) * (sphere_radius + reach));
  }
};

/// Scenario II: a sphere moves around a cylinder at a constant depth, without rotation.
///
/// A's frame: the cylinder's axis is z, its middle the origin. B's frame: the sphere's centre is the origin, which is
/// also the reference point. Pose: translation by orbit * (cos 2 pi s, sin 2 pi s, 0). README.md derives the ideal
/// models.
class SphereCylinder final : public Scenario {
 public:
  SphereCylinder(Description description, const Shape& shape)
      : Scenario(std::move(description),
                 cylinder_solid(shape.cylinder_radius, shape.cylinder_length, shape.facets, shape.round, "cylinder"),
                 sphere_solid(shape.sphere_radius, shape.facets, shape.round, "sphere")),
        shape_(shape) {
    const double half = shape.half_height();
    const auto over_height = [&](const auto& f) { return 2.0 * integrate_chords(f, 0.0, half); };
    const double volume = over_height([&](double z) { return lens_area(circle(z), cylinder(), orbit()); });
    const double gradient = over_height([&](double z) { return lens_chord(circle(z), cylinder(), orbit()); });
    const double along_normals = over_height([&](double z) { return traction(z, false); });
    by_law_ = {{{depth(), depth()},
                {volume, volume},
                {volume, gradient},
                {volume, volume * gradient},
                {depth(), along_normals},
                {depth(), over_height([&](double z) { return traction(z, true); })},
                {volume, 0.5 * along_normals + sphere_normals(shape.sphere_radius, cylinder(), orbit())},
                {volume, volume},
                {orbit(), orbit()},  // "p = rho"
                {1.0, 1.0}}};        // "V = const"
  }

  Pose pose(double progress) const override { return {Eigen::Matrix3d::Identity(), shape_.orbit * outwards(progress)}; }

  std::optional<IdealWrench> ideal(IdealLaw law, double progress) const override {
    const auto [penalty, magnitude] = by_law_[static_cast<std::size_t>(law)];
    return IdealWrench{penalty, magnitude * outwards(progress), Eigen::Vector3d::Zero()};
  }

 private:
  double orbit() const { return shape_.orbit; }
  double cylinder() const { return shape_.cylinder_radius; }
  double depth() const { return shape_.sphere_radius + cylinder() - orbit(); }

  /// Radius of the sphere's horizontal circle at height z.
  double circle(double z) const { return std::sqrt((shape_.sphere_radius - z) * (shape_.sphere_radius + z)); }

  Eigen::Vector3d outwards(double progress) const {
    const double angle = 2.0 * std::numbers::pi * progress;
    return {std::cos(angle), std::sin(angle), 0.0};
  }

  /// Radial part of the traction on the sphere's horizontal circle at height z, per unit of z. Points are at `angle`
  /// from the direction towards the cylinder's axis; the sphere's area element is radius * dz * dangle at any height.
  double traction(double z, bool along_wall) const {
    const double q = circle(z);
    const double cosine = (orbit() * orbit() + q * q - cylinder() * cylinder()) / (2.0 * orbit() * q);
    if (cosine >= 1.0) return 0.0;
    const auto element = [&](double angle) {
      const double x = orbit() - q * std::cos(angle);
      const double from_axis = std::hypot(x, q * std::sin(angle));
      const double normal = along_wall ? x / from_axis : q * std::cos(angle) / shape_.sphere_radius;
      return (cylinder() - from_axis) * normal * shape_.sphere_radius;
    };
    return 2.0 * integrate(element, 0.0, std::acos(cosine));
  }

  Shape shape_;
  /// Penalty, and magnitude of the force away from the axis, in the order of IdealLaw.
  std::array<std::pair<double, double>, 10> by_law_;
};

}  // namespace

Settings sphere_cylinder_settings() {
  return settings_with_round_parts({
      length_parameter("sphere_radius", "radius r of the sphere", "30"),
      length_parameter("cylinder_radius", "radius R of the cylinder", "30"),
      length_parameter("cylinder_length", "length of the cylinder", "100"),
      length_parameter("orbit_radius", "distance rho of the sphere's centre from the cylinder's axis", "50"),
  });
}

std::unique_ptr<Scenario> make_sphere_cylinder(const Settings& settings) {
  const Shape shape(settings);
  SphereCylinder::Description description{
      "II",
      "Does a constant contact of two smooth round bodies give a constant force that rotates with "
      "the contact, and no torque?",
      {"The sphere moves around the cylinder without rotation.",
       "Force and torque are those on the sphere, about its centre."},
      Eigen::Vector3d::Zero(),
      shape.sphere_radius,
      true};
  return std::make_unique<SphereCylinder>(std::move(description), shape);
}

}  // namespace sixdof
