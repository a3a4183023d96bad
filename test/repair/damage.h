#pragma once

#include <algorithm>
#include <vector>

#include <sixdof/geometry/mesh.h>

#include "../geometry/shapes.h"

/// Damages of meshes, at random places.
namespace sixdof::damage {

struct Soup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;

  explicit Soup(const Mesh& mesh) : vertices(mesh.vertices()), triangles(mesh.triangles()) {}
  Mesh build() const { return Mesh::build(vertices, triangles, "damaged"); }
};

inline std::size_t pick(shapes::Generator& generator, std::size_t n) {
  return static_cast<std::size_t>(generator() % n);
}

inline std::uint32_t add(Soup& soup, const Eigen::Vector3d& p) {
  soup.vertices.push_back(p);
  return static_cast<std::uint32_t>(soup.vertices.size() - 1);
}

/// Turns `count` triangles.
inline void flip(Soup& soup, shapes::Generator& generator, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    Triangle& t = soup.triangles[pick(generator, soup.triangles.size())];
    std::swap(t[0], t[1]);
  }
}

/// Adds copies, of which every other faces the other way; corners start anywhere.
inline void duplicate(Soup& soup, shapes::Generator& generator, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    Triangle t = soup.triangles[pick(generator, soup.triangles.size())];
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(pick(generator, 3)), t.end());
    if (i % 2 == 1) std::swap(t[0], t[1]);
    soup.triangles.push_back(t);
  }
}

/// Gives corners vertices of their own, up to `noise` away in each coordinate.
inline void split_vertices(Soup& soup, shapes::Generator& generator, std::size_t count, double noise) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t& v = soup.triangles[pick(generator, soup.triangles.size())][pick(generator, 3)];
    v = add(soup, soup.vertices[v] + shapes::uniform_vector(generator, noise));
  }
}

inline void remove(Soup& soup, shapes::Generator& generator, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = soup.triangles.begin() + static_cast<std::ptrdiff_t>(pick(generator, soup.triangles.size()));
    soup.triangles.erase(at);
  }
}

/// Divides triangles at a point of one side, up to `noise` off it, and leaves their neighbours as they are.
inline void make_t_junctions(Soup& soup, shapes::Generator& generator, std::size_t count, double noise) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = pick(generator, soup.triangles.size());
    const Triangle t = soup.triangles[at];
    const double s = shapes::uniform(generator, 0.2, 0.8);
    const std::uint32_t m =
        add(soup, (1.0 - s) * soup.vertices[t[0]] + s * soup.vertices[t[1]] + shapes::uniform_vector(generator, noise));
    soup.triangles[at] = {t[0], m, t[2]};
    soup.triangles.push_back({m, t[1], t[2]});
  }
}

/// As T-junctions, closed by a triangle without area: it has a corner in the middle of its longest side.
inline void add_flat_triangles(Soup& soup, shapes::Generator& generator, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = pick(generator, soup.triangles.size());
    const Triangle t = soup.triangles[at];
    const std::uint32_t m = add(soup, 0.5 * (soup.vertices[t[0]] + soup.vertices[t[1]]));
    soup.triangles[at] = {t[0], m, t[2]};
    soup.triangles.push_back({m, t[1], t[2]});
    soup.triangles.push_back({t[0], t[1], m});
  }
}

}  // namespace sixdof::damage
