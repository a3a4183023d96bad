#include <sixdof/oracle/contact_truth.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <sixdof/oracle/normal_cone.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Triangles whose distances from a point differ by less, in diagonals, are equally near.
constexpr double k_equally_near = 1e-9;

/// Distance of the lines beside that of a thickness, in diagonals: above rounding, and far below what is measured.
constexpr double k_beside = 1e-8;

Vector3d unit(const Vector3d& v) {
  const double norm = v.stableNorm();
  return norm > 0.0 ? Vector3d(v / norm) : Vector3d::Zero();
}

Tree::Corners corners_in_a(const Tree::Corners& corners, const Pose& X_AB) {
  return {transform_point(X_AB, corners[0]), transform_point(X_AB, corners[1]), transform_point(X_AB, corners[2])};
}

Vector3d normal_of(const Tree::Corners& corners) {
  return unit((corners[1] - corners[0]).cross(corners[2] - corners[0]));
}

/// One for a face, two for an edge, three for a corner.
std::size_t dimension(std::span<const Vector3d> normals) { return std::min<std::size_t>(3, normals.size()); }

}  // namespace

ContactTruth::Ball::Ball(const Mesh& mesh) : center(Vector3d::Zero()), radius(0.0) {
  for (const Vector3d& vertex : mesh.vertices()) center += vertex / static_cast<double>(mesh.vertices().size());
  for (const Vector3d& vertex : mesh.vertices()) radius = std::max(radius, (vertex - center).norm());
}

ContactTruth::ContactTruth(const Mesh& a, const Mesh& b)
    : a_(&a),
      b_(&b),
      ball_a_(a),
      ball_b_(b),
      tree_a_(a),
      tree_b_(b),
      solid_a_(a, tree_a_),
      solid_b_(b, tree_b_),
      diagonal_(a.diagonal()),
      depth_in_a_(a, tree_a_),
      depth_in_b_(b, tree_b_),
      query_(solid_a_, solid_b_),
      thickness_(tree_a_, tree_b_) {}

void ContactTruth::move_to(const Pose& X_AB) {
  X_AB_ = X_AB;
  X_BA_ = X_AB.inverse();
  overlap_ = query_.evaluate(X_AB);
  curve_.clear();
  curve_pairs_.clear();
  pairs_.clear();
  if (overlap_.crossings == 0) return;
  find_candidates(tree_a_, tree_b_, X_AB, scratch_, pairs_);
  for (const TrianglePair& pair : pairs_) {
    const auto segment = cross(tree_a_.corners()[pair.a], corners_in_a(tree_b_.corners()[pair.b], X_AB));
    if (!segment) continue;
    curve_.push_back(*segment);
    curve_pairs_.push_back(pair);
  }
}

Vector3d ContactTruth::force_direction() const { return -unit(overlap_.area); }

Vector3d ContactTruth::normal_of_a(const TrianglePair& pair) const { return normal_of(tree_a_.corners()[pair.a]); }

Vector3d ContactTruth::normal_of_b(const TrianglePair& pair) const {
  return X_AB_.R * normal_of(tree_b_.corners()[pair.b]);
}

/// @param of_b whether `mesh` is B
void ContactTruth::add_inner(const Mesh& mesh, bool of_b, std::vector<InnerVertex>& found) {
  const Pose& to_other = of_b ? X_AB_ : X_BA_;
  const Ball& ball = of_b ? ball_a_ : ball_b_;
  std::vector<Vector3d> near, own;  // in the other's frame; in the vertex's
  for (const Vector3d& vertex : mesh.vertices()) {
    const Vector3d p = to_other * vertex;
    if ((p - ball.center).norm() > ball.radius) continue;
    near.push_back(p);
    own.push_back(vertex);
  }
  const std::size_t step = (near.size() + k_most_vertices - 1) / k_most_vertices;
  for (std::size_t i = 0; i < near.size(); i += step) {
    const detail::DepthNode node = (of_b ? depth_in_a_ : depth_in_b_).at(near[i], 0);
    // Closer to the surface the way out has no direction.
    if (node.s >= -k_equally_near * diagonal_) continue;
    // A vertex within a flat face is a point of this face.
    normals_a_.clear();
    normals_near(of_b ? tree_b_ : tree_a_, own[i], k_equally_near * diagonal_, normals_a_);
    const bool is_flat = dimension(normals_a_) == 1;
    const Vector3d out = is_flat ? Vector3d(-(to_other.R * normals_a_[0])) : unit(node.to_surface);
    found.push_back({.point = of_b ? near[i] : Vector3d(X_AB_ * near[i]),
                     .of_b = of_b,
                     .depth = -node.s,
                     .normal = of_b ? out : Vector3d(-(X_AB_.R * out))});
  }
}

std::vector<InnerVertex> ContactTruth::inner_vertices() {
  std::vector<InnerVertex> found;
  add_inner(*a_, false, found);
  add_inner(*b_, true, found);
  return found;
}

std::vector<Vector3d> ContactTruth::truth_points() {
  std::vector<Vector3d> points;
  for (const InnerVertex& each : inner_vertices()) points.push_back(each.point);
  // The middles of segments, and their starts while there is room: long ones have few neighbours.
  const std::size_t room = k_most_points - std::min(points.size(), k_most_points / 2);
  const std::size_t step = std::max<std::size_t>(1, (2 * curve_.size() + room - 1) / room);
  for (std::size_t i = 0; i < 2 * curve_.size(); i += step) {
    const Segment& segment = curve_[i / 2];
    points.push_back(i % 2 == 0 ? Vector3d(0.5 * (segment.start + segment.end)) : segment.start);
  }
  return points;
}

double ContactTruth::thickness(const Vector3d& point, const Vector3d& normal, double resolution) {
  return thickness_.at(X_AB_, point, normal, k_contact_slack * diagonal_ + resolution, k_beside * diagonal_);
}

JudgedContact ContactTruth::judge(const Contact& contact, double resolution) {
  const Vector3d in_b = X_BA_ * contact.point, normal = unit(contact.normal);
  JudgedContact judged;
  const double to_surface_a = depth_in_a_.at(contact.point, 0).s, to_surface_b = depth_in_b_.at(in_b, 0).s;
  judged.outside_a = std::max(0.0, to_surface_a);
  judged.outside_b = std::max(0.0, to_surface_b);
  normals_a_.clear();
  normals_b_.clear();
  const double slack = k_equally_near * diagonal_ + resolution;
  normals_near(tree_a_, contact.point, slack, normals_a_);
  normals_near(tree_b_, in_b, slack, normals_b_);
  const double to_a = angle_to_cone(normal, normals_a_), to_b = angle_to_cone(-(X_BA_.R * normal), normals_b_);
  const std::size_t of_a = dimension(normals_a_), of_b = dimension(normals_b_);
  const double touching = k_contact_slack * diagonal_ + resolution;
  const bool touch = std::abs(to_surface_a) <= touching && std::abs(to_surface_b) <= touching;
  judged.normal_angle = of_a < of_b           ? to_a
                        : of_b < of_a         ? to_b
                        : of_a == 1 || !touch ? std::min(to_a, to_b)
                                              : std::max(to_a, to_b);
  judged.thickness = thickness(contact.point, normal, resolution);
  return judged;
}

}  // namespace sixdof
