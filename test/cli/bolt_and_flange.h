#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/save.h>

/// A pair as a workshop has it, in millimetres: a thin plate with a hole, and a bolt of 1/20 of its volume that goes
/// through the hole. Where both stand in their files, the bolt is in the hole with 0.5 mm to spare all around.
namespace sixdof::test {

struct ProfilePoint {
  double radius, z;  // mm
};

/// Turns a profile about the axis of the hole, as a prism with k_sides sides. The material is to the left of the
/// profile, with the radius to the right and z upwards. @param is_ring whether the last point is joined to the first
inline Mesh turned(const std::vector<ProfilePoint>& profile, bool is_ring, const std::string& name) {
  constexpr std::uint32_t k_sides = 24;
  const Eigen::Vector3d origin(12.5, -30.25, 7.0);
  std::vector<Eigen::Vector3d> vertices;
  for (const ProfilePoint& p : profile) {
    for (std::uint32_t j = 0; j < k_sides; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / k_sides;
      // Points on the axis are equal: Mesh::build() joins them and drops the triangles between them.
      vertices.push_back(origin + Eigen::Vector3d(p.radius * std::cos(angle), p.radius * std::sin(angle), p.z));
    }
  }
  std::vector<Triangle> triangles;
  const auto rings = static_cast<std::uint32_t>(profile.size());
  for (std::uint32_t i = 0; i < (is_ring ? rings : rings - 1); ++i) {
    const std::uint32_t from = i * k_sides, to = (i + 1) % rings * k_sides;
    for (std::uint32_t j = 0; j < k_sides; ++j) {
      const std::uint32_t next = (j + 1) % k_sides;
      triangles.push_back({from + j, from + next, to + next});
      triangles.push_back({from + j, to + next, to + j});
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), name);
}

/// 90 mm wide and 4 mm thick, with a hole of 10 mm.
inline Mesh make_flange() { return turned({{5.0, 0.0}, {45.0, 0.0}, {45.0, 4.0}, {5.0, 4.0}}, true, "flange"); }

/// From the middle of the tip to that of the head: a shaft of 9 mm, 12 mm long, and a head of 14 mm.
inline std::vector<ProfilePoint> bolt_profile() {
  return {{0.0, -7.0}, {4.5, -7.0}, {4.5, 5.0}, {7.0, 5.0}, {7.0, 8.2}, {0.0, 8.2}};
}
inline Mesh make_bolt() { return turned(bolt_profile(), false, "bolt"); }

/// The bolt without the disc at its tip.
inline Mesh make_open_bolt() {
  std::vector<ProfilePoint> profile = bolt_profile();
  profile.erase(profile.begin());
  return turned(profile, false, "open-bolt");
}

/// Writes flange.stl, bolt.stl and open-bolt.stl: single precision, every triangle with corners of its own.
inline void save_bolt_and_flange(const std::filesystem::path& folder) {
  save_mesh(make_flange(), folder / "flange.stl");
  save_mesh(make_bolt(), folder / "bolt.stl");
  save_mesh(make_open_bolt(), folder / "open-bolt.stl");
}

}  // namespace sixdof::test
