#include <sixdof/scenario/normals.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <sixdof/scenario/plane.h>

namespace sixdof {
namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

/// A point of the cross-section inside both bodies: distances from both walls, and their outward normals.
struct SectionPoint {
  Point arm;  ///< From the pin's axis.
  double depth_a, depth_b;
  Point normal_a, normal_b;
};

/// What the vertical line through a point carries, per unit of area.
NormalsWrench line_wrench(const SectionPoint& p, double length) {
  const Point of_a = 0.5 * (length - 2.0 * p.depth_a) * p.normal_a;
  const Point of_b = -0.5 * (length - p.depth_b) * p.normal_b;
  const double lift = 0.5 * p.depth_b;
  const Point sum = of_a + of_b;
  const double middle = 0.5 * p.depth_b;  // height of the line's part that belongs to the pin's wall
  const double lowest = -0.5 * length + 0.5 * p.depth_b;
  NormalsWrench w{{sum.x(), sum.y(), lift}, Eigen::Vector3d::Zero()};
  w.torque = Eigen::Vector3d(p.arm.x(), p.arm.y(), 0.0).cross(Eigen::Vector3d(of_a.x(), of_a.y(), 0.0)) +
             Eigen::Vector3d(p.arm.x(), p.arm.y(), middle).cross(Eigen::Vector3d(of_b.x(), of_b.y(), 0.0)) +
             Eigen::Vector3d(p.arm.x(), p.arm.y(), lowest).cross(Eigen::Vector3d(0.0, 0.0, lift));
  return w;
}

void add(NormalsWrench& sum, double factor, const NormalsWrench& w) {
  sum.force += factor * w.force;
  sum.torque += factor * w.torque;
}

/// Calls visit(t, weight) for the nodes of integrate() from 0 to 1.
template <class Visit>
void for_nodes(const Visit& visit) {
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    for (const double sign : {-1.0, 1.0}) visit(0.5 + 0.5 * sign * Gauss::abscissa()[i], 0.5 * Gauss::weights()[i]);
  }
}

/// The part of a convex polygon with normal . p <= offset.
Polygon clip(const Polygon& polygon, const Point& normal, double offset) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = normal.dot(p) - offset, at_q = normal.dot(q) - offset;
    if (at_p <= 0.0) result.push_back(p);
    if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0))
      result.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return result;
}

/// Calls visit(point, area) for the nodes of a quadrature over a convex polygon, by triangles with a corner at its
/// vertex nearest to `apex`: exact to rounding also for what depends on the direction from there.
template <class Visit>
void for_polygon(Polygon polygon, const Point& apex, const Visit& visit) {
  if (polygon.size() < 3) return;
  const auto nearest = std::ranges::min_element(polygon, {}, [&](const Point& p) { return (p - apex).squaredNorm(); });
  std::rotate(polygon.begin(), nearest, polygon.end());
  const Point o = polygon.front();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Point p = polygon[i] - o, q = polygon[i + 1] - o;
    const double twice_area = std::abs(p.x() * q.y() - p.y() * q.x());
    for_nodes([&](double along, double weight_along) {
      const Point direction = p + along * (q - p);
      for_nodes(
          [&](double t, double weight) { visit(Point(o + t * direction), twice_area * weight_along * weight * t); });
    });
  }
}

/// Calls visit(point of the section, area) for the nodes of a quadrature over a square pin's section outside the hole.
template <class Visit>
void for_square_section(double side, double angle, const Point& shift, const Visit& visit) {
  const double half = 0.5 * side;
  const Point ex(std::cos(angle), std::sin(angle)), ey(-ex.y(), ex.x());
  for (const Point& pin : {ex, ey, Point(-ex), Point(-ey)}) {
    // The quarter of the pin's section that is nearest to this side.
    const Point along(-pin.y(), pin.x());
    const Polygon quarter{shift, shift + half * (pin - along), shift + half * (pin + along)};
    // The outside of the hole, by the nearest part of its wall: a side (one sign) or a corner (two).
    for (const int x : {-1, 0, 1}) {
      for (const int y : {-1, 0, 1}) {
        if (x == 0 && y == 0) continue;
        Polygon part = quarter;
        for (const auto& [sign, axis] : {std::pair{x, Point(1.0, 0.0)}, {y, Point(0.0, 1.0)}}) {
          if (sign != 0) {
            part = clip(part, -sign * axis, -half);
          } else {
            part = clip(clip(part, axis, half), -axis, half);
          }
        }
        const Point wall(x, y);
        for_polygon(part, half * wall, [&](const Point& p, double area) {
          const Point beyond = (p - half * wall).cwiseProduct(wall.cwiseAbs());
          const double depth = beyond.norm();
          const Point arm = p - shift;
          visit(SectionPoint{arm, depth, half - pin.dot(arm), depth > 0.0 ? Point(-beyond / depth) : Point(-wall), pin},
                area);
        });
      }
    }
  }
}

/// The same for a round pin of radius r in a round hole of radius r.
template <class Visit>
void for_round_section(double r, const Point& shift, const Visit& visit) {
  const double distance = shift.norm();
  if (distance == 0.0) return;
  const Point middle = shift / distance, across(-middle.y(), middle.x());
  // Polar about the hole's axis: the pin's circle is beyond the hole's where cos(angle) > distance / (2 r).
  const double reach = std::acos(std::min(1.0, 0.5 * distance / r));
  for_nodes([&](double s, double weight_s) {
    const double angle = reach * (2.0 * s - 1.0);
    const Point out = std::cos(angle) * middle + std::sin(angle) * across;
    const double sine = distance * std::sin(angle);
    const double beyond = distance * std::cos(angle) + std::sqrt((r - sine) * (r + sine)) - r;
    for_nodes([&](double t, double weight) {
      const double radius = r + t * beyond;
      const Point arm = radius * out - shift;
      const double from_axis = arm.norm();
      visit(SectionPoint{arm, radius - r, r - from_axis, -out, arm / from_axis},
            2.0 * reach * weight_s * weight * beyond * radius);
    });
  });
}

/// Adds a vertical line of the intersection, of this cross-section.
void add_line(OverlapMoments& sum, const Point& arm, double area, double length) {
  sum.volume += area * length;
  sum.first += area * length * Eigen::Vector3d(arm.x(), arm.y(), 0.0);
  sum.second += area * length * (arm.squaredNorm() + length * length / 12.0);
}

}  // namespace

NormalsWrench square_pin_normals(double side, double length, double angle, const Eigen::Vector2d& shift) {
  NormalsWrench sum;
  for_square_section(side, angle, shift,
                     [&](const SectionPoint& p, double area) { add(sum, area, line_wrench(p, length)); });
  return sum;
}

NormalsWrench round_pin_normals(double r, double length, const Eigen::Vector2d& shift) {
  NormalsWrench sum;
  for_round_section(r, shift, [&](const SectionPoint& p, double area) { add(sum, area, line_wrench(p, length)); });
  return sum;
}

OverlapMoments square_pin_moments(double side, double length, double angle, const Eigen::Vector2d& shift) {
  OverlapMoments sum;
  for_square_section(side, angle, shift,
                     [&](const SectionPoint& p, double area) { add_line(sum, p.arm, area, length); });
  return sum;
}

OverlapMoments round_pin_moments(double r, double length, const Eigen::Vector2d& shift) {
  OverlapMoments sum;
  for_round_section(r, shift, [&](const SectionPoint& p, double area) { add_line(sum, p.arm, area, length); });
  return sum;
}

OverlapMoments OverlapMoments::moved(const Eigen::Vector3d& arm) const {
  return {volume, first + volume * arm, second + 2.0 * arm.dot(first) + volume * arm.squaredNorm()};
}

double OverlapMoments::gradient_norm(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) const {
  if (volume <= 0.0) return 0.0;
  const Eigen::Vector3d centroid = first / volume;
  const double gyration = second / volume - centroid.squaredNorm();  // squared
  if (!(gyration > 0.0)) return force.norm();                        // smaller than the rounding
  return std::sqrt(force.squaredNorm() + (torque - centroid.cross(force)).squaredNorm() / gyration);
}

NormalsWrench cone_normals(const ConeInBlock& shape) {
  const double cosine = 1.0 / std::sqrt(1.0 + shape.slope * shape.slope);
  const double middle = 0.5 * shape.height;
  const auto depth = [&](double s, double x, double z) {
    return std::min((shape.slope * s - std::hypot(x, z)) * cosine, shape.height - s);
  };
  /// Integral over z across the cone.
  const auto chord = [&](double s, double x) {
    const double r = shape.slope * s;
    const double half = std::sqrt(std::max(0.0, (r - std::abs(x)) * (r + std::abs(x))));
    return 2.0 * integrate([&](double z) { return depth(s, x, z); }, 0.0, half);
  };
  NormalsWrench sum;
  for (const double normal : {1.0, -1.0}) {
    const double s = normal > 0.0 ? shape.top : shape.bottom;
    const double r = shape.slope * s;
    const double from = std::max(-r, -shape.before), to = std::min(r, shape.beyond);
    const auto both_sides = [&](const auto& f) {
      return integrate_chords(f, from, std::min(0.0, to)) + integrate_chords(f, std::max(0.0, from), to);
    };
    sum.force.y() += 0.5 * normal * both_sides([&](double x) { return chord(s, x); });
    sum.torque.z() += 0.5 * normal * both_sides([&](double x) { return x * chord(s, x); });
  }
  for (const double normal : {1.0, -1.0}) {
    const double x = normal > 0.0 ? shape.beyond : -shape.before;
    const double from = std::max(shape.bottom, std::abs(x) / shape.slope);
    sum.force.x() += 0.5 * normal * integrate_chords([&](double s) { return chord(s, x); }, from, shape.top);
    sum.torque.z() -=
        0.5 * normal * integrate_chords([&](double s) { return (s - middle) * chord(s, x); }, from, shape.top);
  }
  return sum;
}

double sphere_normals(double r, double cylinder, double distance) {
  const double reach = distance - cylinder;
  const double half = std::sqrt(std::max(0.0, (r - reach) * (r + reach)));
  const auto ring = [&](double z) {
    const double q2 = (r - z) * (r + z);
    const double cosine = (distance * distance + cylinder * cylinder - q2) / (2.0 * distance * cylinder);
    const auto element = [&](double angle) {
      const double x = distance - cylinder * std::cos(angle), y = cylinder * std::sin(angle);
      return (r - std::sqrt(x * x + y * y + z * z)) * std::cos(angle) * cylinder;
    };
    return cosine < 1.0 ? 2.0 * integrate(element, 0.0, std::acos(cosine)) : 0.0;
  };
  return integrate_chords(ring, 0.0, half);  // half of both halves
}

}  // namespace sixdof
