#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `bullet-hull`: Bullet's convex casts of the convex hulls of both meshes. Answers cast only; its answers are about
/// hulls.
///
/// **A query** is btConvexCast::calcTimeOfImpact() of two btConvexHullShape, without a broad phase. Parameter `caster`:
/// `continuous` is btContinuousConvexCollision, the one that btCollisionWorld::objectQuerySingle() takes; `gjk` and
/// `subsimplex` are btGjkConvexCast and btSubsimplexConvexCast, for motions that do not rotate; others go to
/// `continuous`. `gjk` needs a margin: at 0 its last step often ends in contact, where its search of a distance has no
/// result, and it says that there is no hit (136 of 200 motions of a box through the centre of another; none at 0.001).
///
/// **Motion.** Bullet moves the origin of a shape on a straight line and turns about it at constant speed, from one
/// transform to another. So the origin of B's shape is the motion's reference point, and the motion is the one that is
/// asked. Rotations of more than 3 radians are asked in parts, since two transforms give at most pi.
///
/// **Margin.** Bullet thickens hulls by parameter `margin`, by 0.04 length units if nothing is set. The default here is
/// 0, as for `bullet-gimpact`.
///
/// **Known limits.** Bodies that overlap at the start and move apart have no hit: Bullet says so by design
/// (btContinuousConvexCollision.cpp returns false where the gap does not close).
std::unique_ptr<Algorithm> make_bullet_hull_algorithm();

}  // namespace sixdof
