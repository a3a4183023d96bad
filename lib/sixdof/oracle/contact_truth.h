#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/signed_depth.h>
#include <sixdof/oracle/thickness.h>
#include <sixdof/query/algorithm.h>

/// What exact geometry says of the contacts of two solids. Everything is in A's frame.

namespace sixdof {

/// By how much a point may be off and still count as on a body, in diagonals of A's box: some roundings of libraries in
/// single precision. A resolution comes on top.
inline constexpr double k_contact_slack = 1e-6;

/// A normal farther from every true one (degrees) leads the wrong way. Beyond 90: a normal across both surfaces, such
/// as that of two edges, is no better known than by the size of triangles.
inline constexpr double k_reversed_degrees = 100.0;

/// One contact, judged.
struct JudgedContact {
  double outside_a = 0.0;  ///< Distance of its point from the solid A; 0 within (length).
  double outside_b = 0.0;  ///< Likewise from B.
  /// Angle of its normal to the nearest true one (degrees). The true ones are N_A, the cone of A's outward normals at
  /// the point of A's surface nearest to the contact (normal_cone.h), and -N_B, likewise of B's inward normals. Of the
  /// two the one of fewer normals counts, as a corner on a face takes the normal of the face: a normal of a face comes
  /// before those of an edge, these before those of a corner. Of two faces the nearer normal counts. Of two edges or
  /// two corners that touch, the farther one: there the normal has to lie in both cones; else the nearer.
  double normal_angle = 0.0;
  double thickness = 0.0;  ///< Of the intersection along the normal (thickness.h): what the depth should be (length).

  double off() const { return outside_a > outside_b ? outside_a : outside_b; }  ///< How far from being in both bodies.
  bool is_reversed() const { return normal_angle > k_reversed_degrees; }
};

/// A vertex of one body inside the other.
struct InnerVertex {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  bool of_b = false;                                 ///< B's, in A; else A's, in B.
  double depth = 0.0;                                ///< Distance from the other's surface (length).
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Unit, from A to B: the shortest way out for it, or
                                                     ///< the normal of its own face if it lies within one.
};

/// Two solids, asked at one pose after the other. One object per thread.
class ContactTruth {
 public:
  /// Vertices of each body that are tested at a pose: if there are more near the other body, every second, third, ...
  static constexpr std::size_t k_most_vertices = 256;
  /// Points of truth_points() at most.
  static constexpr std::size_t k_most_points = 1024;

  /// Both meshes outlive it. @throws BadMesh as Tree and Solid do
  ContactTruth(const Mesh& a, const Mesh& b);
  ContactTruth(const ContactTruth&) = delete;
  ContactTruth& operator=(const ContactTruth&) = delete;

  /// All that follows is about this pose. @throws BadArgument if it is not finite
  void move_to(const Pose& X_AB);

  const Overlap& overlap() const { return overlap_; }
  /// Unit vector of the exact force on B, minus the gradient of the intersection volume; zero without one.
  Eigen::Vector3d force_direction() const;
  /// Where the surfaces cross: one segment per pair of triangles.
  std::span<const Segment> curve() const { return curve_; }
  /// Triangles of a segment of curve(): indices in tree order.
  std::span<const TrianglePair> curve_triangles() const { return curve_pairs_; }
  /// Unit normals of these triangles, outwards.
  Eigen::Vector3d normal_of_a(const TrianglePair& pair) const;
  Eigen::Vector3d normal_of_b(const TrianglePair& pair) const;
  std::vector<InnerVertex> inner_vertices();
  /// Points of the curve and vertices of either body inside the other: the region of contact.
  std::vector<Eigen::Vector3d> truth_points();

  /// @param resolution of an algorithm that approximates the bodies (length); 0 of others
  JudgedContact judge(const Contact& contact, double resolution = 0.0);
  /// See JudgedContact::thickness.
  double thickness(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double resolution = 0.0);

  double diagonal() const { return diagonal_; }  ///< Of A's box (length).

 private:
  void add_inner(const Mesh& mesh, bool of_b, std::vector<InnerVertex>& found);

  /// About the mean of a mesh's vertices, through the farthest: turns with the mesh, as a box would not.
  struct Ball {
    Eigen::Vector3d center;
    double radius;
    explicit Ball(const Mesh& mesh);
  };

  const Mesh* a_;
  const Mesh* b_;
  const Ball ball_a_, ball_b_;
  const Tree tree_a_, tree_b_;
  const Solid solid_a_, solid_b_;
  const double diagonal_;
  detail::SignedDepth depth_in_a_, depth_in_b_;
  OverlapQuery query_;
  Thickness thickness_;
  Pose X_AB_, X_BA_;
  Overlap overlap_;
  std::vector<Segment> curve_;
  std::vector<TrianglePair> curve_pairs_;
  // Scratch.
  CandidateScratch scratch_;
  std::vector<TrianglePair> pairs_;
  std::vector<Eigen::Vector3d> normals_a_, normals_b_;
};

}  // namespace sixdof
