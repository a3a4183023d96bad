#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

/// Makes a closed, consistently oriented surface of a damaged one where small changes suffice.
///
/// The surface is a plain list of triangles: half-edge structures (OpenMesh) refuse the edges with three and more
/// triangles that damaged files have.
///
/// Steps, repeated until none finds anything to do:
/// 1. border vertices that are closer than the tolerance to another vertex become one with it (weld.h);
/// 2. duplicate triangles go; triangles whose corners are collinear within rounding are replaced by splitting the
///    neighbour at their longest edge (cleanup.h);
/// 3. border edges are split at the border vertices that lie on them within the tolerance (t_junctions.h);
/// 4. triangles are turned to agree with their neighbours, and shells to face outwards (orient.h);
/// 5. fins, inner walls and stray triangles go where the rest is closed without them (superfluous.h);
/// 6. holes of few edges are filled (holes.h).
/// A closed, oriented mesh without duplicate and collinear triangles stays as it is, bit by bit. Self-intersections and
/// nested shells stay, see oracle/mesh_check.h.
namespace sixdof {

/// How far a repair may go.
struct RepairOptions {
  static constexpr double k_default_weld = 1e-6;          ///< Of `weld`.
  static constexpr std::size_t k_default_max_hole = 32;   ///< Of `max_hole`.
  static constexpr std::size_t k_largest_max_hole = 512;  ///< Largest value of `max_hole`.
  /// Above a stray facet of a cube's edge (6 %), below what someone may have modelled as a sheet.
  static constexpr double k_default_max_fin = 0.1;

  /// Tolerance of welding and of vertices on edges, relative to the diagonal of the mesh's box. The default is above
  /// the rounding of coordinates to float. 0: within rounding.
  double weld = k_default_weld;
  /// Edges of the largest hole that is filled; 0: none. Time grows with its third power.
  std::size_t max_hole = k_default_max_hole;
  /// Largest fin or stray piece that is dropped, relative to the area of the closed surface beside it.
  double max_fin = k_default_max_fin;
};

/// What was done to a mesh.
enum class RepairKind {
  welded_vertices,       ///< Moved to another vertex, with which they became one.
  duplicate_triangles,   ///< Dropped.
  degenerate_triangles,  ///< Of no area; dropped.
  split_edges,           ///< By vertices that lay on them.
  flipped_triangles,     ///< Turned over.
  filled_holes,          ///< Each counts once, however many triangles it takes.
  fins,                  ///< Triangles that hang on a closed surface and enclose nothing; dropped, as the next two.
  inner_walls,           ///< Triangles inside of the outline of what they hang on.
  stray_triangles,       ///< Triangles beside closed surfaces.
};
/// Number of kinds.
inline constexpr std::size_t k_repair_kinds = 9;

/// Repairs of one kind.
struct RepairsOfKind {
  static constexpr std::size_t k_listed = 5;  ///< Most places that are kept.
  std::size_t count = 0;                      ///< How many.
  std::vector<Eigen::Vector3d> first;         ///< Where the first k_listed were made, in the mesh's frame.
};

/// What was done, by kind.
struct RepairLog {
  /// By the number of the kind; of() finds them.
  std::array<RepairsOfKind, k_repair_kinds> kinds;

  /// Counts one more. @param place in the mesh's frame
  void add(RepairKind kind, const Eigen::Vector3d& place) {
    RepairsOfKind& of_kind = kinds[static_cast<std::size_t>(kind)];
    if (of_kind.count++ < RepairsOfKind::k_listed) of_kind.first.push_back(place);
  }
  /// Those of one kind.
  const RepairsOfKind& of(RepairKind kind) const { return kinds[static_cast<std::size_t>(kind)]; }
  /// Of all kinds.
  std::size_t total() const {
    std::size_t sum = 0;
    for (const RepairsOfKind& of_kind : kinds) sum += of_kind.count;
    return sum;
  }
};

/// Answer of repair_mesh().
struct RepairedMesh {
  Mesh mesh;               ///< In the frame and unit of the damaged one.
  RepairLog log;           ///< What was done.
  std::size_t passes = 0;  ///< Rounds of all steps, the last without work included.
  /// Whether the last round found nothing to do. If not, repairing the result again may change it.
  bool converged = false;
};

/// Repairs a mesh by the steps above.
/// @throws BadArgument if `weld` is not in [0, 0.1], `max_hole` above k_largest_max_hole or `max_fin` not in [0, 1];
/// BadMesh if no triangle is left.
RepairedMesh repair_mesh(const Mesh& mesh, const RepairOptions& options = {});

}  // namespace sixdof
