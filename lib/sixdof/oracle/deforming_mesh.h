#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree_builder.h>
#include <sixdof/oracle/near_query.h>

namespace sixdof {

/// A mesh whose vertices move, prepared for NearQuery. One thread at a time changes it, while nobody asks.
///
/// **Answers** have the same bits whichever of the updates brought the vertices to where they are: those of a
/// DeformingMesh made anew there. Two things in which an answer could depend on how the tree partitions the triangles
/// are settled: a mesh that deforms always counts as having coplanar patches (so of distances that differ by no more
/// than the width of ties in distance.h the first pair's is taken, and a distance may differ by so much from that of
/// the same vertices as a Mesh); and of bodies that are far apart (NearQuery::are_far()) who asks first calls
/// make_fresh().
///
/// **Updates.** rebuild() builds the tree anew. refit() keeps the partition of the triangles; volumes grow where
/// neighbours have moved apart. update() refits, and builds anew the parts that are worth it by the following rule.
///
/// **The rule.** A query's cost grows with the area of the boxes in the tree. Each node knows the sum of these areas in
/// its subtree, over the area of the surface in it, when it was built. By how much this ratio has grown since says
/// which share of all box area, and so of the work of queries, building this part anew may save. note_work() is told
/// the work that queries do. The share of it that was wasted is summed up, frame after frame, and as soon as it exceeds
/// what building these parts would cost, they are built: as in the ski rental (Karlin, Manasse, Rudolph and Sleator
/// 1988, "Competitive snoopy caching"), where no more is lost than twice the cost of the best moment, up to how well
/// areas predict work.
class DeformingMesh {
 public:
  /// @throws BadMesh as Tree does
  explicit DeformingMesh(const Mesh& mesh);
  DeformingMesh(const DeformingMesh&) = delete;
  DeformingMesh& operator=(const DeformingMesh&) = delete;

  /// The same object for life; its content changes by updates.
  const PreparedMesh& prepared() const { return prepared_; }
  /// As of the last update.
  std::span<const Eigen::Vector3d> vertices() const { return vertices_; }
  /// Whether it bounds a body, as Mesh::solid().
  bool solid() const { return solid_; }

  // Updates take one vertex for each of the mesh's, finite, in its frame. They return an upper bound on how far any
  // point of the surface has moved (length). They throw BadMesh as Tree does; then nothing has changed.
  double rebuild(std::span<const Eigen::Vector3d> vertices);  ///< All anew.
  double refit(std::span<const Eigen::Vector3d> vertices);    ///< No part anew.
  double update(std::span<const Eigen::Vector3d> vertices);   ///< By the rule.

  /// Adds to the work that queries have done since the last update.
  /// @param nodes pairs of nodes that they expanded (TraversalCounts::nodes)
  void note_work(double nodes) { work_ += nodes; }

  /// Builds the tree anew unless no part of it was only refitted since it was built whole.
  void make_fresh();

  std::uint64_t built_triangles() const { return built_triangles_; }  ///< Of parts that updates built, in all.
  std::size_t bytes() const;

 private:
  /// Parts that are worth being built together.
  struct Parts {
    std::vector<std::uint32_t> nodes;
    double saved = 0.0;  ///< Box area that would be saved, at most.
    double price = 0.0;  ///< Triangles.
  };
  /// In a subtree.
  struct Areas {
    double boxes = 0.0;    ///< Of all nodes and leaves below its root, half of each.
    double surface = 0.0;  ///< Of its triangles.
    double ratio() const { return surface > 0.0 ? boxes / surface : 0.0; }
  };
  static std::vector<Areas> areas_of(const Tree& tree);
  tree_builder::Surface surface() const { return {vertices_, triangles_}; }
  double take(std::span<const Eigen::Vector3d> vertices);
  void refresh();
  void note_built();
  Parts find_parts(std::uint32_t node, const std::vector<Areas>& areas) const;
  void apply_rule();

  std::vector<Triangle> triangles_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> pieces_;  // first vertices of pieces; empty unless the triangles are closed and oriented
  std::shared_ptr<detail::DistanceBody> body_;
  PreparedMesh prepared_;
  bool solid_ = false;
  bool fresh_ = true;         // as it was built whole at these vertices
  std::vector<float> built_;  // of each node: Areas::ratio() when it was built
  double work_ = 0.0;         // of queries since the last update: nodes
  double wasted_ = 0.0;       // of it and before: nodes that parts built anew would have saved
  std::uint64_t built_triangles_ = 0;
};

}  // namespace sixdof
