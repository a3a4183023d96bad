#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

/// A scene: bodies, their recorded motion, and which pairs of them matter. It is replayed alike to every algorithm.
namespace sixdof::scene {

/// A pose X_WB of a body in the world as it is recorded: unit quaternion (w, x, y, z) and translation (length). Files
/// hold these numbers, so that a scene read back has the same bits.
struct RecordedPose {
  std::array<double, 7> numbers{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};  ///< w, x, y, z of the quaternion; translation.

  /// The recorded pose nearest to another. @param R a rotation matrix
  static RecordedPose of(const Eigen::Matrix3d& R, const Eigen::Vector3d& t);
  /// X_WB of these numbers. @throws BadArgument as Pose::from_quaternion() does
  Pose pose() const;
};

/// Two bodies by their identifiers, a < b.
struct BodyPair {
  std::uint32_t a = 0;  ///< The lower one.
  std::uint32_t b = 0;  ///< The higher one.

  /// Of two different identifiers in either order.
  static BodyPair of(std::uint32_t i, std::uint32_t j) { return i < j ? BodyPair{i, j} : BodyPair{j, i}; }
  /// By the lower identifier, then by the higher one.
  auto operator<=>(const BodyPair&) const = default;
};

/// One body of a scene.
struct Body {
  std::uint32_t id = 0;    ///< Unique. Answers name bodies by it, so that they do not depend on the order of insertion.
  std::uint32_t mesh = 0;  ///< Index into Scene::meshes; bodies may share a mesh.
  bool fixed = false;      ///< It never moves; two fixed bodies are no pair that matters.
  RecordedPose pose;       ///< In the first frame.
};

/// What one body does from one frame to the next.
struct Motion {
  std::uint32_t body = 0;  ///< Index into Scene::bodies.
  RecordedPose pose;       ///< Where it is now.
};

/// The bodies that move from the frame before to this one; the others stay. By index, each once.
using Frame = std::vector<Motion>;

/// How a mesh is deformed in a frame: all of its vertices, and with them all bodies of this mesh.
struct Deformation {
  std::uint32_t mesh = 0;  ///< Index into Scene::meshes.
  /// One for each vertex of that mesh, in its order, in the mesh's frame (length). Not null.
  std::shared_ptr<const std::vector<Eigen::Vector3d>> vertices;
};

/// Bodies in their order of insertion, recorded motion, pairs. A pair matters unless both bodies are fixed or it is
/// ignored.
struct Scene {
  std::string name;     ///< Of the family, or as the user likes.
  std::string recipe;   ///< What it was made with, "bodies=1000 seed=1"; empty if it was not made here.
  double margin = 0.0;  ///< Of the query for near pairs (length).
  std::vector<std::shared_ptr<const Mesh>> meshes;  ///< None is null.
  std::vector<Body> bodies;                         ///< In their order of insertion.
  std::vector<BodyPair> ignored;                    ///< Sorted, each once.
  std::vector<Frame> frames;                        ///< The first one moves nothing: it is the start.
  /// Of each frame, by index of the mesh; empty if no mesh deforms. The first frame has the meshes as they are.
  std::vector<std::vector<Deformation>> deformations;

  /// @throws BadArgument naming the first element that is wrong: an identifier or pair that comes twice, an index out
  /// of range, a fixed body that moves or deforms, a pose that is no pose, vertices that Mesh::with_vertices() refuses,
  /// a margin that is negative or not finite
  void check() const;

  /// Whether a mesh deforms in some frame.
  bool deforms() const { return !deformations.empty(); }
  /// Whether this one does. @param mesh index into `meshes`
  bool deforms(std::uint32_t mesh) const;

  /// Content hash of everything but name and recipe; the meshes enter by their own hashes. 32 hexadecimal digits.
  std::string hash() const;

  std::size_t triangles() const;  ///< Of all bodies: a shared mesh counts once for each body.
  std::size_t motions() const;    ///< Of all frames.
  std::size_t shapes() const;     ///< Deformations of all frames.
};

/// Whether a pair matters, in constant time or logarithmic in the number of ignored pairs.
class PairFilter {
 public:
  /// Of a scene that has passed check(); it need not outlive this object.
  explicit PairFilter(const Scene& scene);
  /// Whether this pair matters. @param i, j indices of different bodies
  bool matters(std::uint32_t i, std::uint32_t j) const;
  std::uint64_t pairs() const { return pairs_; }  ///< That matter.

 private:
  std::vector<std::uint32_t> ids_;
  std::vector<bool> fixed_;
  std::vector<bool> has_ignored_;
  std::vector<BodyPair> ignored_;
  std::uint64_t pairs_ = 0;
};

/// The same scene with its bodies inserted in a seeded random order.
Scene shuffled(const Scene& scene, std::uint64_t seed);

/// Part of a scene: some bodies, in their order, over some frames. The first frame kept is the start; its poses and
/// vertices are the recorded ones, so that answers keep their bits (of meshes that deform no more: up to tie_width() of
/// oracle/distance.h).
/// @param ids of the bodies to keep; empty for all
/// @param first, last frames, both included
/// @throws BadArgument naming an identifier that no body has, or frames that are not first <= last < Scene::frames
Scene excerpt(const Scene& scene, std::span<const std::uint32_t> ids, std::size_t first, std::size_t last);

/// Frames with their poses as matrices, as algorithms take them.
struct Moved {
  std::uint32_t body = 0;  ///< Index into Scene::bodies.
  Pose X_WB;               ///< Where it is now, in the world's frame.
};
/// All bodies at the start, in their order.
std::vector<Moved> start_of(const Scene& scene);
/// The motions of one frame, in their order.
std::vector<Moved> moves_of(const Frame& frame);

/// A mesh in a frame in which it is deformed, as algorithms take it.
struct Deformed {
  std::uint32_t mesh = 0;                          ///< Index into Scene::meshes.
  std::span<const Eigen::Vector3d> vertices = {};  ///< One for each of the mesh's, in its frame (length).
};
/// The deformations of one frame, in their order; they refer to the scene's vertices.
std::vector<Deformed> shapes_of(const Scene& scene, std::size_t frame);

}  // namespace sixdof::scene
