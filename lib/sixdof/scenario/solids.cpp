#include <sixdof/scenario/solids.h>

#include <algorithm>
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
  Mesh build(std::string name) && { return Mesh::build(std::move(vertices_), std::move(triangles_), std::move(name)); }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
};

Eigen::Vector3d at_z(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

/// Triangle p, q, r (counter-clockwise in the x, y plane) at height z, facing up or down.
void add_horizontal(Soup& soup, const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r, double z,
                    bool up) {
  if (up) {
    soup.triangle(at_z(p, z), at_z(q, z), at_z(r, z));
  } else {
    soup.triangle(at_z(r, z), at_z(q, z), at_z(p, z));
  }
}

/// Vertical walls along a counter-clockwise loop, facing out of the loop or into it.
void add_walls(Soup& soup, const Loop& loop, double low, double high, bool outwards) {
  for (std::size_t j = 0; j < loop.size(); ++j) {
    const Eigen::Vector2d& p = loop[outwards ? j : (j + 1) % loop.size()];
    const Eigen::Vector2d& q = loop[outwards ? (j + 1) % loop.size() : j];
    soup.triangle(at_z(p, low), at_z(q, low), at_z(q, high));
    soup.triangle(at_z(p, low), at_z(q, high), at_z(p, high));
  }
}

/// The face inside a convex loop: a fan of triangles about `middle`.
void add_fan(Soup& soup, const Loop& loop, const Eigen::Vector2d& middle, double z, bool up) {
  for (std::size_t j = 0; j < loop.size(); ++j) {
    add_horizontal(soup, loop[j], loop[(j + 1) % loop.size()], middle, z, up);
  }
}

/// The face between a rectangle and a convex loop about the rectangle's middle, both counter-clockwise. Each vertex of
/// the loop is joined to the corner in its own quadrant, so no edge crosses the loop.
void add_face_with_hole(Soup& soup, const Loop& rectangle, const Loop& hole, double z, bool up) {
  const Eigen::Vector2d middle = 0.5 * (rectangle[0] + rectangle[2]);
  // Corner q of the rectangle is in quadrant q: angles from q pi/2 to (q + 1) pi/2.
  const auto quadrant = [&](const Eigen::Vector2d& p) {
    double angle = std::atan2(p.y() - middle.y(), p.x() - middle.x());
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    return std::min<std::size_t>(3, static_cast<std::size_t>(angle / (0.5 * std::numbers::pi)));
  };
  for (std::size_t j = 0; j < hole.size(); ++j) {
    const Eigen::Vector2d& from = hole[j];
    const Eigen::Vector2d& to = hole[(j + 1) % hole.size()];
    std::size_t corner = quadrant(from);
    const std::size_t last = quadrant(to);
    add_horizontal(soup, to, from, rectangle[corner], z, up);
    while (corner != last) {
      const std::size_t next = (corner + 1) % 4;
      add_horizontal(soup, rectangle[corner], rectangle[next], to, z, up);
      corner = next;
    }
  }
}

/// Counter-clockwise; corner q is in quadrant q about `middle`.
Loop rectangle_about(const Eigen::Vector2d& middle, double width, double depth) {
  const double x = 0.5 * width;
  const double y = 0.5 * depth;
  return {middle + Eigen::Vector2d(x, y), middle + Eigen::Vector2d(-x, y), middle + Eigen::Vector2d(-x, -y),
          middle + Eigen::Vector2d(x, -y)};
}

/// The outlines that pins and holes have in common.
struct PinsOutline {
  Eigen::Vector2d square_middle, round_middle;
  Loop square, round;
  Loop square_half, round_half;  ///< Halves of the plate or block around them.
  Loop outer;                    ///< Counter-clockwise, with the vertices where the halves meet.

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
  const double angle = 2.0 * std::numbers::pi / facets;
  return r * std::sqrt(angle / std::sin(angle));
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
  add_walls(soup, outline, low.z(), high.z(), true);
  for (const bool top : {false, true}) {
    const double z = top ? high.z() : low.z();
    add_horizontal(soup, outline[0], outline[1], outline[2], z, top);
    add_horizontal(soup, outline[0], outline[2], outline[3], z, top);
  }
  return std::move(soup).build(std::move(name));
}

Mesh cone_solid(double radius, double height, int facets, RoundParts round, std::string name) {
  const Loop rim = polygon(radius, facets, round);
  const Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle(0.0, height, 0.0);
  // The polygon's x, y axes become z, x, so that its third axis becomes y.
  const auto corner = [&](std::size_t k) {
    const Eigen::Vector2d& p = rim[k % rim.size()];
    return Eigen::Vector3d(p.y(), height, p.x());
  };
  Soup soup;
  for (std::size_t j = 0; j < rim.size(); ++j) {
    soup.triangle(apex, corner(j + 1), corner(j));
    soup.triangle(middle, corner(j), corner(j + 1));
  }
  return std::move(soup).build(std::move(name));
}

Mesh cylinder_solid(double radius, double length, int facets, RoundParts round, std::string name) {
  const Loop rim = polygon(radius, facets, round);
  Soup soup;
  add_walls(soup, rim, -0.5 * length, 0.5 * length, true);
  add_fan(soup, rim, Eigen::Vector2d::Zero(), -0.5 * length, false);
  add_fan(soup, rim, Eigen::Vector2d::Zero(), 0.5 * length, true);
  return std::move(soup).build(std::move(name));
}

Mesh sphere_solid(double radius, int facets, RoundParts round, std::string name) {
  const auto make = [&](double vertex_radius) {
    const int bands = facets / 2;
    // Ring 0 is the upper pole, ring `bands` the lower one.
    const auto ring = [&](int i) {
      const double polar = std::numbers::pi * i / bands;
      std::vector<Eigen::Vector3d> points;
      for (const Eigen::Vector2d& p : polygon(vertex_radius * std::sin(polar), facets, RoundParts::inscribed)) {
        points.push_back(at_z(p, vertex_radius * std::cos(polar)));
      }
      if (i == 0 || i == bands) {
        points.assign(points.size(), {0.0, 0.0, i == 0 ? vertex_radius : -vertex_radius});
      }
      return points;
    };
    Soup soup;
    std::vector<Eigen::Vector3d> upper = ring(0);
    for (int i = 0; i < bands; ++i) {
      std::vector<Eigen::Vector3d> lower = ring(i + 1);
      for (std::size_t j = 0; j < upper.size(); ++j) {
        const std::size_t next = (j + 1) % upper.size();
        if (i + 1 < bands) soup.triangle(lower[j], lower[next], upper[next]);
        if (i > 0) soup.triangle(lower[j], upper[next], upper[j]);
      }
      upper = std::move(lower);
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
  add_walls(soup, outline.outer, bottom, 0.0, true);
  add_walls(soup, outline.square, bottom, 0.0, false);
  add_walls(soup, outline.round, bottom, 0.0, false);
  for (const bool top : {false, true}) {
    add_face_with_hole(soup, outline.square_half, outline.square, top ? 0.0 : bottom, top);
    add_face_with_hole(soup, outline.round_half, outline.round, top ? 0.0 : bottom, top);
  }
  return std::move(soup).build(std::move(name));
}

Mesh pins_solid(const PinsShape& shape, std::string name) {
  const PinsOutline outline(shape);
  const double bottom = -shape.depth;
  const double top = shape.plate_thickness;
  Soup soup;
  add_walls(soup, outline.outer, 0.0, top, true);
  add_walls(soup, outline.square, bottom, 0.0, true);
  add_walls(soup, outline.round, bottom, 0.0, true);
  add_fan(soup, outline.square, outline.square_middle, bottom, false);
  add_fan(soup, outline.round, outline.round_middle, bottom, false);
  add_face_with_hole(soup, outline.square_half, outline.square, 0.0, false);
  add_face_with_hole(soup, outline.round_half, outline.round, 0.0, false);
  add_fan(soup, outline.square_half, outline.square_middle, top, true);
  add_fan(soup, outline.round_half, outline.round_middle, top, true);
  return std::move(soup).build(std::move(name));
}

}  // namespace sixdof
