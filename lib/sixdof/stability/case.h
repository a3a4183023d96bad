#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/pose.h>

/// What a stability test asks: a case is one or more queries whose true answers, or relations between answers, are
/// known without asking any algorithm.
namespace sixdof::stability {

using MeshPointer = std::shared_ptr<const Mesh>;

/// A pose by the seven numbers that a user types: they give the same bits of X_AB here and in `sixdof query`.
struct Placement {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< Unit to rounding.

  Pose pose() const { return Pose::from_quaternion(q.w(), q.x(), q.y(), q.z(), t); }
};

inline constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

/// What is true of the two bodies; k_unknown where nothing is claimed.
struct GroundTruth {
  double gap = k_unknown;       ///< Distance of the bodies, or minus the depth by which B has to leave A (length).
  double distance = k_unknown;  ///< Of the surfaces (length).
  double volume = k_unknown;    ///< Of the intersection (length^3).
  std::optional<Eigen::Vector3d> push;  ///< Unit direction, in A's frame, in which B leaves A on the shortest way.
  bool contained = false;               ///< One body lies inside the other; the surfaces do not meet.
  double depth_of_a = k_unknown;        ///< Greatest depth in B of a point of A's surface; 0 if none is in B (length).
  double depth_of_b = k_unknown;        ///< Greatest depth in A of a point of B's surface, likewise (length).
  double error = 0.0;                   ///< Of the lengths above, besides the rounding of the input (length).
};

/// One query.
struct Shot {
  MeshPointer a, b;
  Placement X_AB;
  GroundTruth truth = {};
  double scale = 1.0;                                  ///< Lengths of this shot over those of the case's first.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< Takes the force of the first shot to that of this one.
  std::optional<Pose> raw;                             ///< Asked in place of X_AB: a pose that is none.

  Pose pose() const { return raw ? *raw : X_AB.pose(); }

  /// How far the rounding of vertices, of the pose and of transformed vertices may move a surface (length): truths
  /// hold for the ideal bodies, answers for the rounded ones.
  double rounding() const;
};

/// What ties the answers to the shots of one case together.
enum class Relation {
  none,      ///< Each is judged alone.
  same,      ///< Equal up to Shot::scale and Shot::turn: also where no truth is known.
  path,      ///< Consecutive poses: the distance changes by no more than the body moves.
  loop,      ///< A closed path: the work of a conservative force is zero.
  repeat,    ///< Asked again, by other objects, in other orders and on two threads.
  sweep,     ///< From the first shot along Case::motion until the bodies touch.
  cast,      ///< When B first touches A on Case::cast.
  contacts,  ///< Contacts of bodies that overlap along GroundTruth::push.
  time,      ///< Times of the queries are compared with their median.
  bad,       ///< Shot::raw, poses that are none: a refusal, or an answer that is finite.
};

/// A member of a family.
struct Case {
  std::string name;
  std::string thread = {};  ///< "owner/repo#issue" where users met it; empty if generated.
  double parameter = 0.0;   ///< Of the family's sweep.
  Relation relation = Relation::none;
  std::vector<Shot> shots = {};
  bool convex = false;                               ///< Both bodies are: a separating direction attains the distance.
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< Of B in A's frame, per unit of time (Relation::sweep).
  double contact_time = k_unknown;                   ///< When the bodies first touch; infinity: never.
  std::optional<Motion> cast = {};                   ///< From the first shot, from t = 0 to 1 (Relation::cast).

  double size() const { return shots.front().a->diagonal(); }  ///< Lengths are judged relative to it.
};

/// A case whose shots must have the same answers (Relation::same).
inline Case same_answers(std::string name, double parameter, std::vector<Shot> shots, bool convex = true,
                         std::string thread = {}) {
  return {.name = std::move(name),
          .thread = std::move(thread),
          .parameter = parameter,
          .relation = Relation::same,
          .shots = std::move(shots),
          .convex = convex};
}

}  // namespace sixdof::stability
