#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/oracle/deforming_mesh.h>
#include <sixdof/oracle/near_query.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/scene/scene.h>
#include <sixdof/scene/scene_algorithm.h>

/// The bodies of a scene as the project's own algorithms see them: prepared meshes, poses, boxes and bounds on motion.
/// Internal: use scene_algorithm.h.
namespace sixdof::scene::detail {

/// A box along the world's axes (length).
struct Box {
  Eigen::Array3d lower = Eigen::Array3d::Zero();
  Eigen::Array3d upper = Eigen::Array3d::Zero();

  Box grown(double by) const { return {lower - by, upper + by}; }
  bool contains(const Box& other) const { return (lower <= other.lower).all() && (upper >= other.upper).all(); }
  bool meets(const Box& other) const { return (lower <= other.upper).all() && (upper >= other.lower).all(); }
  /// Distance of two boxes.
  double gap(const Box& other) const { return (other.lower - upper).max(lower - other.upper).max(0.0).matrix().norm(); }
  void add(const Box& other) {
    lower = lower.min(other.lower);
    upper = upper.max(other.upper);
  }
};

/// Bodies by their rank: their place in the order of identifiers, so that nothing depends on the order of insertion.
class Bodies {
 public:
  explicit Bodies(const Scene& scene);

  std::size_t size() const { return ids_.size(); }
  std::uint32_t id(std::uint32_t rank) const { return ids_[rank]; }
  std::uint32_t rank(std::uint32_t index) const { return rank_[index]; }  ///< Of an index into Scene::bodies.
  std::uint32_t rank_of_id(std::uint32_t id) const;
  std::uint32_t mesh_index(std::uint32_t rank) const { return mesh_[rank]; }
  const PreparedMesh& mesh(std::uint32_t rank) const { return *prepared_[mesh_[rank]]; }
  bool fixed(std::uint32_t rank) const { return fixed_[rank]; }
  bool matters(std::uint32_t i, std::uint32_t j) const { return filter_.matters(index_[i], index_[j]); }
  std::uint64_t pairs() const { return filter_.pairs(); }

  /// Moves a body. @returns an upper bound on how far any of its points moves (length)
  double move(std::uint32_t rank, const Pose& X_WB);

  /// What a deformation did to all bodies of a mesh.
  struct Change {
    double motion;       ///< Upper bound on how far any of their points moved (length).
    bool solid_changed;  ///< The mesh became a solid, or is none any more.
  };
  /// Deforms a mesh; before move() in a frame. @pre the scene says that it deforms
  Change deform(const Deformed& deformed, MeshUpdate how);
  /// The bodies of a mesh, by rank, ascending.
  std::span<const std::uint32_t> ranks_of(std::uint32_t mesh) const { return ranks_of_mesh_[mesh]; }
  /// Meshes that deform. Sorted.
  std::span<const std::uint32_t> deforming() const { return deforming_meshes_; }
  /// Of one of these.
  DeformingMesh& deforming(std::uint32_t mesh) { return *deforming_[mesh]; }
  const DeformingMesh& deforming(std::uint32_t mesh) const { return *deforming_[mesh]; }

  const Pose& pose(std::uint32_t rank) const { return poses_[rank]; }
  /// Contains the body at its pose, rounding included.
  const Box& box(std::uint32_t rank) const { return boxes_[rank]; }
  /// Of the body about the centre of its mesh's box: no vertex is further away (length).
  double radius(std::uint32_t rank) const { return radii_[mesh_[rank]]; }
  const Eigen::Vector3d& center(std::uint32_t rank) const { return centers_[rank]; }

  /// X_AB of two bodies.
  Pose relative(std::uint32_t a, std::uint32_t b) const { return poses_[a].inverse() * poses_[b]; }
  /// At least the error by which a measured distance of two bodies differs from that of their poses in the world
  /// (length).
  double rounding(std::uint32_t a, std::uint32_t b) const;

  /// A lower bound on the distance of two bodies, from their boxes and spheres; may be negative.
  double lower_bound(std::uint32_t a, std::uint32_t b) const;

  std::size_t bytes() const;

 private:
  void prepare(const Scene& scene);
  void place(std::uint32_t rank, const Pose& X_WB);

  PairFilter filter_;
  std::vector<std::uint32_t> ids_, rank_, index_, mesh_;
  std::vector<bool> fixed_;
  std::vector<std::unique_ptr<const PreparedMesh>> rigid_;  // of a mesh; null if it deforms
  std::vector<std::unique_ptr<DeformingMesh>> deforming_;   // of a mesh; null if it does not
  std::vector<const PreparedMesh*> prepared_;               // of a mesh: one of both
  std::vector<std::uint32_t> deforming_meshes_;
  std::vector<std::vector<std::uint32_t>> ranks_of_mesh_;
  std::vector<double> radii_;  // of a mesh
  std::vector<Pose> poses_;
  std::vector<Eigen::Vector3d> centers_;
  std::vector<Box> boxes_;
};

/// Solids of all meshes, and the wrenches of pairs.
class Wrenches {
 public:
  /// @throws BadMesh if a mesh is no solid
  Wrenches(const Scene& scene, const Bodies& bodies);

  /// A mesh has deformed. @throws BadMesh if it is no solid
  void deform(const Scene& scene, const Bodies& bodies, const Deformed& deformed);

  /// Sums the wrenches of pairs that touch, in the order given: the same bits for every number of threads.
  /// @param pairs by rank, sorted
  std::vector<BodyWrench> sum(const Bodies& bodies, std::span<const BodyPair> pairs) const;

  std::size_t bytes() const;

 private:
  std::vector<std::unique_ptr<const Mesh>> shapes_;  // of a mesh that has deformed
  std::vector<std::unique_ptr<const Solid>> solids_;
};

}  // namespace sixdof::scene::detail
