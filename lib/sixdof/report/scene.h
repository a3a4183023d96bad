#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/report/series.h>
#include <sixdof/results/results.h>

/// What the page shows in three dimensions.

namespace sixdof::report {

using namespace results;

/// A simplified copy of a mesh, for drawing.
struct DrawnMesh {
  std::string name;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t triangles_before = 0;
};

/// Most triangles of a drawn mesh; a page with twenty of them stays below ten megabytes.
inline constexpr std::size_t k_most_triangles = 6000;

/// Joins the vertices in each cell of a grid (Rossignac and Borrel 1993), which is refined as far as `most` triangles
/// allow. A mesh that has no more stays as it is.
DrawnMesh drawn(const Mesh& mesh, std::size_t most = k_most_triangles);

/// One moment: B's pose and, of a response, forces and torques on B in A's frame.
struct Moment {
  std::array<double, 7> pose{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};  ///< X_AB: w, x, y, z, tx, ty, tz.
  std::array<double, 3> force{}, ideal_force{}, torque{}, ideal_torque{};
};

struct Scene {
  std::string name;
  std::string algorithm = {};         ///< Whose forces or answers; empty for an object.
  std::string kind;                   ///< "object", "path", "case" or "pose" (an outlier of a row).
  std::string command;                ///< That asks or measures it again.
  std::size_t a = 0, b = 0;           ///< Indices in Scenes::meshes; of an object both are the same.
  std::array<double, 3> reference{};  ///< Where arrows begin, in B's frame.
  double rate_hz = 0.0;               ///< Of a path.
  std::size_t stride = 1;             ///< Steps of the path from one moment to the next.
  std::vector<std::array<double, 6>> contacts{}, curve{};  ///< results::ContactPicture, of a pose of contacts.
  std::vector<Moment> moments;                             ///< At least one, except for an object.
};

struct Scenes {
  std::vector<DrawnMesh> meshes;
  std::vector<Scene> scenes;
};

inline constexpr std::size_t k_most_moments = 200;

/// Paths of series; the worst poses of hard cases with a fault, where the meshes that the reproduction names are here;
/// objects that rows are about, where the model is here; outliers of rows, where their meshes are here.
Scenes make_scenes(const Results& results, const std::vector<Series>& series);

}  // namespace sixdof::report
