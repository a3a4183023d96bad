#include <sixdof/scenario/solids.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace sixdof {
namespace {

using Loop = std::vector<Eigen::Vector2d>;

/// Triangles by coordinates; Mesh::build welds equal ones.
class Soup {
 public:
  void triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    vertices_.insert(vertices_.end(), {p, q, r});
    triangles_.push_back({first, first + 1, first + 2});
  }
  /// Counter-clockwise seen from outside.
  void quad(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r, const Eigen::Vector3d& s) {
    triangle(p, q, r);
    triangle(p, r, s);
  }
  Mesh build(std::string name) && { return Mesh::build(std::move(vertices_), std::move(triangles_), std::move(name)); }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
};

Eigen::Vector3d at_height(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

/// A flat face of triangles (p, q, r) counter-clockwise in xy, put at height z, facing up or down.
void flat(Soup& soup, const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r, double z, bool up) {
  if (up) {
    soup.triangle(at_height(p, z), at_height(q, z), at_height(r, z));
  } else {
    soup.triangle(at_height(r, z), at_height(q, z), at_height(p, z));
  }
}

/// Vertical walls below a counter-clockwise loop; they face away from the loop's inside, or into it.
void walls(Soup& soup, const Loop& loop, double low, double high, bool outwards) {
  for (std::size_t j = 0; j < loop.size(); ++j) {
    const Eigen::Vector2d& p = loop[outwards ? j : (j + 1) % loop.size()];
    const Eigen::Vector2d& q = loop[outwards ? (j + 1) % loop.size() : j];
    soup.quad(at_height(p, low), at_height(q, low), at_height(q, high), at_height(p, high));
  }
}

/// A convex loop as a fan about `middle`.
void disc(Soup& soup, const Loop& loop, const Eigen::Vector2d& middle, double z, bool up) {
  for (std::size_t j = 0; j < loop.size(); ++j) flat(soup, loop[j], loop[(j + 1) % loop.size()], middle, z, up);
}

/// Angle of p - middle in [0, 2 pi).
double angle_about(const Eigen::Vector2d& p, const Eigen::Vector2d& middle) {
  const double angle = std::atan2(p.y() - middle.y(), p.x() - middle.x());
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

/// The face between a rectangle and a convex loop about the rectangle's middle, both counter-clockwise: each vertex of
/// the loop is joined to the corner of its own quadrant, so no edge can cross the loop.
void face_with_hole(Soup& soup, const Loop& rectangle, const Loop& hole, double z, bool up) {
  const Eigen::Vector2d middle = 0.5 * (rectangle[0] + rectangle[2]);
  // Corner q of the rectangle is in quadrant q: angles from q pi/2 to (q + 1) pi/2.
  const auto quadrant = [&](const Eigen::Vector2d& p) {
    return std::min<std::size_t>(3, static_cast<std::size_t>(angle_about(p, middle) / (0.5 * std::numbers::pi)));
  };
  for (std::size_t j = 0; j < hole.size(); ++j) {
    const Eigen::Vector2d& from = hole[j];
    const Eigen::Vector2d& to = hole[(j + 1) % hole.size()];
    std::size_t corner = quadrant(from);
    const std::size_t last = quadrant(to);
    flat(soup, to, from, rectangle[corner], z, up);
    while (corner != last) {
      const std::size_t next = (corner + 1) % 4;
      flat(soup, rectangle[corner], rectangle[next], to, z, up);
      corner = next;
    }
  }
}

/// Corner q in quadrant q about the middle.
Loop rectangle_about(const Eigen::Vector2d& middle, double width, double depth) {
  const double x = 0.5 * width;
  const double y = 0.5 * depth;
  return {middle + Eigen::Vector2d(x, y), middle + Eigen::Vector2d(-x, y), middle + Eigen::Vector2d(-x, -y),
          middle + Eigen::Vector2d(x, -y)};
}

/// The outlines that pins and holes share.
struct PinsOutline {
  Eigen::Vector2d square_middle;
  Eigen::Vector2d round_middle;
  Loop square;
  Loop round;
  Loop square_half;  ///< Half of the plate or block around the square.
  Loop round_half;
  Loop outer;  ///< Counter-clockwise, with the vertices where the halves meet.

  explicit PinsOutline(const PinsShape& shape)
      : square_middle(-0.25 * shape.width, 0.0),
        round_middle(0.25 * shape.width, 0.0),
        square(rectangle_about(square_middle, shape.square_side, shape.square_side)),
        round(polygon(shape.round_radius, shape.facets, shape.round)),
        square_half(rectangle_about(square_middle, 0.5 * shape.width, shape.depth)),
        round_half(rectangle_about(round_middle, 0.5 * shape.width, shape.depth)) {
    for (Eigen::Vector2d& p : round) p += round_middle;
    outer = {round_half[0], round_half[1], square_half[1], square_half[2], square_half[3], round_half[3]};
  }
};

}  // namespace

double polygon_radius(double r, int facets, RoundParts round) {
  if (round == RoundParts::inscribed) return r;
  const double turn = 2.0 * std::numbers::pi / facets;
  return r * std::sqrt(turn / std::sin(turn));
}

std::vector<Eigen::Vector2d> polygon(double r, int facets, RoundParts round) {
  const double radius = polygon_radius(r, facets, round);
  std::vector<Eigen::Vector2d> loop;
  for (int j = 0; j < facets; ++j) {
    const double angle = 2.0 * std::numbers::pi * (j + 0.5) / facets;
    loop.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return loop;
}

Mesh box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::string name) {
  const Loop outline{{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}};
  Soup soup;
  walls(soup, outline, low.z(), high.z(), true);
  for (const bool top : {false, true}) {
    const double z = top ? high.z() : low.z();
    flat(soup, outline[0], outline[1], outline[2], z, top);
    flat(soup, outline[0], outline[2], outline[3], z, top);
  }
  return std::move(soup).build(std::move(name));
}

Mesh cone_solid(double radius, double height, int facets, RoundParts round, std::string name) {
  const Loop rim = polygon(radius, facets, round);
  const Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle(0.0, height, 0.0);
  Soup soup;
  for (std::size_t j = 0; j < rim.size(); ++j) {
    // The polygon's plane (x, y) becomes (z, x), so that its third axis becomes y.
    const Loop& loop = rim;
    const auto corner = [&](std::size_t k) {
      const Eigen::Vector2d& p = loop[k % loop.size()];
      return Eigen::Vector3d(p.y(), height, p.x());
    };
    soup.triangle(apex, corner(j + 1), corner(j));
    soup.triangle(middle, corner(j), corner(j + 1));
  }
  return std::move(soup).build(std::move(name));
}

Mesh cylinder_solid(double radius, double length, int facets, RoundParts round, std::string name) {
  const Loop rim = polygon(radius, facets, round);
  Soup soup;
  walls(soup, rim, -0.5 * length, 0.5 * length, true);
  disc(soup, rim, Eigen::Vector2d::Zero(), -0.5 * length, false);
  disc(soup, rim, Eigen::Vector2d::Zero(), 0.5 * length, true);
  return std::move(soup).build(std::move(name));
}

Mesh sphere_solid(double radius, int facets, RoundParts round, std::string name) {
  const auto make = [&](double vertex_radius) {
    const int bands = facets / 2;
    const auto ring = [&](int i) {
      const double polar = std::numbers::pi * i / bands;
      return std::pair(polygon(vertex_radius * std::sin(polar), facets, RoundParts::inscribed),
                       vertex_radius * std::cos(polar));
    };
    Soup soup;
    for (int i = 0; i < bands; ++i) {
      const auto [upper, top] = ring(i);
      const auto [lower, bottom] = ring(i + 1);
      for (std::size_t j = 0; j < upper.size(); ++j) {
        const std::size_t next = (j + 1) % upper.size();
        const Eigen::Vector3d pole_top(0.0, 0.0, vertex_radius);
        const Eigen::Vector3d pole_bottom(0.0, 0.0, -vertex_radius);
        const bool first = i == 0;
        const bool last = i + 1 == bands;
        const Eigen::Vector3d p = last ? pole_bottom : at_height(lower[j], bottom);
        const Eigen::Vector3d q = last ? pole_bottom : at_height(lower[next], bottom);
        const Eigen::Vector3d r = first ? pole_top : at_height(upper[next], top);
        const Eigen::Vector3d s = first ? pole_top : at_height(upper[j], top);
        if (!last) soup.triangle(p, q, r);
        if (!first) soup.triangle(p, r, s);
      }
    }
    return std::move(soup).build(name);
  };
  if (round == RoundParts::inscribed) return make(radius);
  const double unit_volume = make(1.0).volume();
  return make(radius * std::cbrt(4.0 / 3.0 * std::numbers::pi / unit_volume));
}

Mesh holes_solid(const PinsShape& shape, std::string name) {
  const PinsOutline outline(shape);
  const double bottom = -shape.depth;
  Soup soup;
  walls(soup, outline.outer, bottom, 0.0, true);
  walls(soup, outline.square, bottom, 0.0, false);
  walls(soup, outline.round, bottom, 0.0, false);
  for (const bool top : {false, true}) {
    face_with_hole(soup, outline.square_half, outline.square, top ? 0.0 : bottom, top);
    face_with_hole(soup, outline.round_half, outline.round, top ? 0.0 : bottom, top);
  }
  return std::move(soup).build(std::move(name));
}

Mesh pins_solid(const PinsShape& shape, std::string name) {
  const PinsOutline outline(shape);
  const double bottom = -shape.depth;
  const double top = shape.plate_thickness;
  Soup soup;
  walls(soup, outline.outer, 0.0, top, true);
  walls(soup, outline.square, bottom, 0.0, true);
  walls(soup, outline.round, bottom, 0.0, true);
  disc(soup, outline.square, outline.square_middle, bottom, false);
  disc(soup, outline.round, outline.round_middle, bottom, false);
  face_with_hole(soup, outline.square_half, outline.square, 0.0, false);
  face_with_hole(soup, outline.round_half, outline.round, 0.0, false);
  disc(soup, outline.square_half, outline.square_middle, top, true);
  disc(soup, outline.round_half, outline.round_middle, top, true);
  return std::move(soup).build(std::move(name));
}

}  // namespace sixdof
