#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

/// Whether two triangles of one mesh meet elsewhere than in the vertices they share, by exact predicates.
///
/// Triangles that share no vertex meet if an edge of one meets the other. Triangles that share one vertex v meet beyond
/// v if the edge opposite v of one meets the other: both are convex, so a common point lies on a common segment from v,
/// which can be prolonged to one of these edges. Triangles that share an edge meet beyond it if they lie in one plane
/// on the same side of the edge.
namespace sixdof {

enum class ContactKind {
  crossing,    ///< Not in one plane: one passes through the other, or touches it.
  coplanar,    ///< In one plane: they overlap, or touch beside what they share.
  coincident,  ///< The same three vertices, in either direction.
};

struct TriangleContact {
  ContactKind kind;
  Eigen::Vector3d point;  ///< A common point, rounded; the middle of the edge where triangles share one.
};

/// Whether the corners are exactly collinear. Such a triangle has no interior; find_contact() does not take it.
bool is_collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// The contact of two triangles, neither collinear, beyond their common vertices; nothing if there is none. Signs are
/// exact in the range of predicates.h.
std::optional<TriangleContact> find_contact(std::span<const Eigen::Vector3d> vertices, const Triangle& a,
                                            const Triangle& b);

}  // namespace sixdof
