#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/query/outcome.h>
#include <sixdof/query/settings.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// Answer of a distance query: the smallest distance between the two surfaces, in the meshes' length unit.
struct Separation {
  static constexpr std::uint32_t k_no_triangle = std::numeric_limits<std::uint32_t>::max();
  double distance = 0.0;
  bool has_witnesses = false;
  Eigen::Vector3d witness_a = Eigen::Vector3d::Zero();  ///< Closest point on A, in A's frame.
  Eigen::Vector3d witness_b = Eigen::Vector3d::Zero();  ///< Closest point on B, in A's frame.
  /// Triangles of the witnesses, indices into the meshes' triangles(); k_no_triangle where the algorithm does not tell.
  std::uint32_t triangle_a = k_no_triangle;
  std::uint32_t triangle_b = k_no_triangle;
};

/// Answer of a response query: the penalty wrench that pushes B out of A, in A's frame.
struct Response {
  static constexpr double k_absent = std::numeric_limits<double>::quiet_NaN();
  double penalty = 0.0;      ///< What the algorithm's law measures: a depth (length) or a volume (length^3).
  double volume = k_absent;  ///< Intersection volume (length^3), NaN where the algorithm gives none.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< On B, in A's frame.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();     ///< On B about `reference`, in A's frame.
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< In A's frame. The default: centre of B's bounding box.

  /// The same wrench about another point (in A's frame).
  Response about(const Eigen::Vector3d& point) const {
    Response moved = *this;
    moved.torque = torque + (reference - point).cross(force);
    moved.reference = point;
    return moved;
  }
};

/// Which kinds of query an algorithm answers.
struct QuerySet {
  bool collide = false;
  bool distance = false;
  bool respond = false;
};

/// What a response's magnitude is proportional to; decides the ideal model it is judged against.
enum class ResponseLaw {
  none,
  depth,
  volume
};

/// Size of a prepared structure and the counts that explain it ("nodes", "voxels", "spheres", ...).
struct Footprint {
  std::size_t bytes = 0;
  std::vector<std::pair<std::string, double>> counts;
};

/// How much a query looked at, in units that explain its time.
struct Work {
  std::string unit;      ///< What is counted, plural, as in names of counters: "points", "sphere_pairs".
  double visited = 0.0;  ///< By the last query, of any kind.
  double present = 0.0;  ///< What it would visit if it left out nothing.
};

struct Traits {
  std::string name;     ///< As typed and as in benchmark names: lower case, digits, '-'.
  std::string version;  ///< Of the library behind it; this project's own version for its own algorithms.
  std::string summary;  ///< One line.
  QuerySet answers;
  ResponseLaw law = ResponseLaw::none;
  std::vector<Parameter> parameters;
  bool timed = true;  ///< False: a check for small meshes that benchmarks leave out.
};

/// An algorithm prepared for one pair of meshes. One thread at a time; it may keep what it learnt from the last query
/// (warm starts), so answers may depend on the order only in their rounding.
///
/// No method throws: whatever goes wrong becomes a Status, with words in diagnosis().
class Query {
 public:
  virtual ~Query() = default;

  /// Do the two bodies, or for algorithms that know only surfaces the two surfaces, have a point in common?
  virtual Outcome<bool> collide(const Pose& /*X_AB*/) { return Status::unsupported; }

  /// Distance of the two surfaces; 0 where they touch or intersect.
  virtual Outcome<Separation> distance(const Pose& /*X_AB*/) { return Status::unsupported; }

  /// Penalty wrench on B; zero where the bodies are apart.
  virtual Outcome<Response> respond(const Pose& /*X_AB*/) { return Status::unsupported; }

  virtual Footprint footprint() const { return {}; }

  /// Of the last query; empty where nothing is counted.
  virtual std::vector<Work> work() const { return {}; }

  /// Words for the last outcome that was neither ok nor unsupported.
  const std::string& diagnosis() const { return diagnosis_; }

 protected:
  Status fail(Status status, std::string words) {
    diagnosis_ = std::move(words);
    return status;
  }

 private:
  std::string diagnosis_;
};

/// What is under test: prepared once per pair, then queried. Immutable; prepare() may be called from several threads.
class Algorithm {
 public:
  virtual ~Algorithm() = default;
  virtual const Traits& traits() const = 0;

  /// Builds all structures for A (fixed) and B (moving). Both meshes outlive the query.
  /// @throws BadMesh if the algorithm cannot honour a mesh (e.g. it needs a solid); BadArgument for settings.
  virtual std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const = 0;

  /// Default settings.
  Settings settings() const { return Settings(traits().parameters); }
};

}  // namespace sixdof
