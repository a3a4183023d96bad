#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/query/settings.h>

/// The interface of every algorithm under test. To add one, derive from Query, prepare in its constructor, and describe
/// the algorithm by its traits:
///
///     class MyQuery final : public Query {
///      public:
///       MyQuery(const Mesh& a, const Mesh& b, const Settings& settings);
///       Outcome<Separation> distance(const Pose& X_AB) override { return Separation{.distance = ...}; }
///     };
///
///     make_algorithm<MyQuery>({.name = "mine", .version = "1.0", .summary = "...", .answers = {.distance = true}});
///
/// Register it in a program of your own with Registrar (registrar.h), in this library with Registry::add().
///
/// Conventions: body A is fixed and body B moves. A pose X_AB maps points of B's mesh frame to A's mesh frame. Every
/// point, force and torque of an answer is in A's frame, every length in the meshes' length unit.

namespace sixdof {

/// How a query ended.
enum class Status {
  ok,             ///< There is an answer.
  unsupported,    ///< The algorithm does not answer this kind of query.
  failed,         ///< The algorithm gave up, threw, or returned something that is no answer.
  non_finite,     ///< The algorithm returned, or was given, a NaN or an infinity.
  crashed,        ///< The process in which it ran ended: a signal, an abort, an exit.
  timed_out,      ///< No answer within the limit; its process was ended.
  out_of_memory,  ///< It asked for more memory than there is, or than it may have.
};

/// The name as it stands in results: "timed_out".
constexpr std::string_view to_string(Status status) {
  constexpr std::string_view k_names[] = {"ok",      "unsupported", "failed",       "non_finite",
                                          "crashed", "timed_out",   "out_of_memory"};
  return k_names[static_cast<std::size_t>(status)];
}

/// Those that rows count apart, besides counting them as failed configurations.
inline constexpr std::array<Status, 3> k_counted_statuses{Status::crashed, Status::timed_out, Status::out_of_memory};

/// A value, or why there is none. `value` is meaningful only if ok(); Query::diagnosis() has the words for a failure.
template <class T>
struct Outcome {
  Status status = Status::unsupported;  ///< How the query ended.
  T value{};                            ///< The answer, if ok().

  /// Status::unsupported.
  Outcome() = default;
  /// No answer, for a reason other than Status::ok.
  Outcome(Status why) : status(why) {}  // NOLINT(google-explicit-constructor): reads as a value
  /// An answer, with Status::ok.
  Outcome(T answer) : status(Status::ok), value(std::move(answer)) {}  // NOLINT(google-explicit-constructor)

  /// Whether there is an answer.
  bool ok() const { return status == Status::ok; }
};

/// Answer of a distance query.
struct Separation {
  /// The index of no triangle.
  static constexpr std::uint32_t k_no_triangle = std::numeric_limits<std::uint32_t>::max();
  double distance = 0.0;                                ///< Smallest one between the two surfaces, >= 0 (length).
  bool has_witnesses = false;                           ///< Whether the witness points are set.
  Eigen::Vector3d witness_a = Eigen::Vector3d::Zero();  ///< Closest point on A, in A's frame.
  Eigen::Vector3d witness_b = Eigen::Vector3d::Zero();  ///< Closest point on B, in A's frame.
  /// Triangle of witness_a, an index into Mesh::triangles() of A; k_no_triangle where the algorithm gives none.
  std::uint32_t triangle_a = k_no_triangle;
  std::uint32_t triangle_b = k_no_triangle;  ///< Likewise of witness_b and B.
};

/// Answer of a response query: the penalty wrench that pushes B out of A, in A's frame.
struct Response {
  /// A volume that is not there: NaN.
  static constexpr double k_absent = std::numeric_limits<double>::quiet_NaN();
  double penalty = 0.0;      ///< By is_of_depth(): a penetration depth (length) or an intersection volume (length^3).
  double volume = k_absent;  ///< Intersection volume (length^3); k_absent where the algorithm gives none.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< On B, in A's frame.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();     ///< On B about `reference`, in A's frame.
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< In A's frame; by convention the centre of B's bounding box.

  /// The same wrench with its torque about another point (A's frame).
  Response about(const Eigen::Vector3d& point) const {
    Response moved = *this;
    moved.torque = torque + (reference - point).cross(force);
    moved.reference = point;
    return moved;
  }
};

/// Answer of a cast: when the bodies first have a point in common.
struct Impact {
  bool hit = false;  ///< Whether they do at any t from 0 to 1. If not, the rest is not set.
  /// The first such t; 0 where they are in contact at the start, and there only.
  double t = 0.0;
  bool has_witnesses = false;                           ///< Whether the points of contact are set.
  Eigen::Vector3d witness_a = Eigen::Vector3d::Zero();  ///< On A, in A's frame.
  Eigen::Vector3d witness_b = Eigen::Vector3d::Zero();  ///< On B at t, in A's frame.
  /// Of the contact, from A to B: a unit vector in A's frame. Zero where the algorithm gives none.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();

  /// Whether the bodies were in contact before they moved.
  bool at_start() const { return hit && t == 0.0; }
};

/// A place where two bodies touch or overlap, as a library reports it to whoever pushes the bodies apart.
struct Contact {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< On A, on B or between, in A's frame.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< A unit vector from A to B: along it B leaves A. In A's frame.
  double depth = 0.0;                                ///< Along the normal (length), in the sense of Traits::depth.
};

/// Answer of a contact query.
struct Contacts {
  std::vector<Contact> list;  ///< In any order, no more than were asked for; empty where the bodies are apart.
};

/// Which kinds of query an algorithm answers.
struct QuerySet {
  bool collide = false;   ///< Query::collide()
  bool distance = false;  ///< Query::distance()
  bool respond = false;   ///< Query::respond()
  bool cast = false;      ///< Query::cast()
  bool contacts = false;  ///< Query::contacts()

  /// Whether it answers any.
  bool any() const { return collide || distance || respond || cast || contacts; }
};

/// Which bodies an algorithm's answers are about.
enum class Body {
  mesh,        ///< The mesh as it is.
  convex_hull  ///< Of each mesh: another question than that of the other algorithms, with another truth.
};

/// The name as it stands in results: "convex_hull".
constexpr std::string_view to_string(Body body) { return body == Body::mesh ? "mesh" : "convex_hull"; }

/// What a method does not promise by its nature. `sixdof stress` shows an answer that one of these explains as
/// declared; every other wrong answer counts as a failure.
struct MethodLimits {
  /// Where one body is inside the other and the surfaces are apart, collide() may be no and respond() zero.
  QuerySet surfaces_only = {};
  /// There distance() is 0, not that of the surfaces.
  bool distance_of_bodies = false;
  /// The force is a sum over contacts, points or parts of the bodies. Where the overlap is shallow it is less than 90
  /// degrees from the shortest way out; elsewhere no direction is promised.
  bool own_direction = false;
  /// respond() looks at points of B's surface only. Where none of them is deeper in A than the resolution, it may be
  /// zero, however far B is from leaving A.
  bool points_of_b_only = false;
};

/// What a response tends to with increasing resolution: its own law. It selects the ideal model that scenarios compare
/// with, and the truth of the counters `..._own_...` of rows.
enum class ResponseLaw {
  none,     ///< None of these, or not known.
  depth,    ///< Integral of depth times B's inward normal over B's surface inside A (oracle/depth_integral.h).
  volume,   ///< Minus the gradient of the volume of the intersection, or a volume along its direction.
  way_out,  ///< As depth, along the shortest way out of A instead of along B's normal.
  /// Sum or mean over pairs of triangles, or springs on them, of a depth times a normal. It depends on the triangles
  /// and has no limit of its own; it is judged by `depth`.
  contacts
};

/// The name as it stands in results: "way_out".
constexpr std::string_view to_string(ResponseLaw law) {
  constexpr std::string_view k_names[] = {"none", "depth", "volume", "way_out", "contacts"};
  return k_names[static_cast<std::size_t>(law)];
}

/// Whether magnitudes grow with a depth, not with a volume.
constexpr bool is_of_depth(ResponseLaw law) {
  return law == ResponseLaw::depth || law == ResponseLaw::way_out || law == ResponseLaw::contacts;
}

/// What the depth of a contact is the depth of. Rows compare it with the thickness of the intersection of both bodies
/// along the normal through the point (oracle/contact_truth.h), which is what whoever pushes by it has to know.
enum class ContactDepth {
  none,       ///< Not known, or the algorithm gives none.
  triangles,  ///< Of two triangles: how far a point of one lies below the plane of the other, or both are to be moved.
  point,      ///< Of the point: its distance from the surface of one of the bodies.
  local,      ///< Of the bodies there: the thickness of their intersection along the normal through the point.
  bodies      ///< Of the bodies: how far B has to move along the normal to leave A.
};

/// The name as it stands in results: "triangles".
constexpr std::string_view to_string(ContactDepth depth) {
  constexpr std::string_view k_names[] = {"none", "triangles", "point", "local", "bodies"};
  return k_names[static_cast<std::size_t>(depth)];
}

/// Size of a prepared structure and the counts that explain it ("nodes", "voxels", "spheres", ...).
struct Footprint {
  std::size_t bytes = 0;                               ///< Of memory; 0 where the algorithm does not tell.
  std::vector<std::pair<std::string, double>> counts;  ///< Name (lower case, '_') and number.
};

/// How many elements a query tested. Rows report `<unit>_tested`, `<unit>_total` and the time per tested element.
struct Work {
  std::string unit;     ///< Plural, as in names of counters: "points", "sphere_pairs".
  double tested = 0.0;  ///< Elements that the last query tested, of any kind of query.
  double total = 0.0;   ///< Elements that it would test without any culling.
};

/// What is known of an algorithm before it is prepared. Constant while the algorithm lives.
struct Traits {
  std::string name;     ///< Unique; as typed and as in benchmark names: a-z, 0-9 and '-'.
  std::string version;  ///< Of the library behind it; this project's own version for its own algorithms.
  std::string summary;  ///< One line, for lists.
  QuerySet answers;     ///< Benchmarks ask these kinds of query only; the others return Status::unsupported.
  ResponseLaw law = ResponseLaw::none;      ///< Of respond().
  ContactDepth depth = ContactDepth::none;  ///< Of contacts().
  /// Whether it answers for an approximation of the bodies: Footprint::counts has how far that may lie from the true
  /// surfaces, as "resolution" (length).
  bool approximates = false;
  MethodLimits limits = {};           ///< Of the method, not of this code.
  std::vector<Parameter> parameters;  ///< What a user may set; empty if nothing.
  /// Whether benchmarks have rows of its queries. False for a reference that is too slow, such as brute force.
  bool timed = true;
  /// Never compared with the truth of the meshes, or with other algorithms, unless it is `mesh`.
  Body body = Body::mesh;
  /// Whether suites and studies of "all" algorithms take this one. False where thousands of queries would take hours:
  /// it is measured only where it is named.
  bool by_default = true;
  /// Of a program that bench/rivals/setup has made ready, what executes it: "native", "python", "node" or "wasm" (in
  /// Node.js). Empty for all others.
  std::string runtime = {};

  /// Whether it is such a program.
  bool is_rival() const { return !runtime.empty(); }
  /// Whether suites and studies of "all" algorithms include it.
  bool in_default_runs() const { return timed && by_default && body == Body::mesh; }
};

/// An algorithm prepared for one pair of meshes.
///
/// **Threads.** One thread at a time uses a Query. Queries of one algorithm share nothing that changes.
///
/// **State.** After a warm start from the last query, the order of poses may change the rounding of answers only.
///
/// **Errors.** An implementation should not throw: what goes wrong is returned as a Status other than ok, by fail()
/// with words. Callers count all the same what is thrown, and an answer with a NaN or an infinity (other than
/// Response::volume = k_absent), as one failed configuration (ask.h).
///
/// **Time.** Only the queries are timed. Memory that they need is best kept between calls.
class Query {
 public:
  virtual ~Query() = default;  ///< Frees the prepared structures.

  /// Do the two bodies (for some algorithms, the two surfaces) have a point in common? Contact counts.
  virtual Outcome<bool> collide(const Pose& /*X_AB*/) { return Status::unsupported; }

  /// Distance of the two surfaces; 0 where they touch or intersect.
  virtual Outcome<Separation> distance(const Pose& /*X_AB*/) { return Status::unsupported; }

  /// Penalty wrench on B; zero where the bodies are apart.
  virtual Outcome<Response> respond(const Pose& /*X_AB*/) { return Status::unsupported; }

  /// When the two bodies (for some algorithms, the two surfaces) first have a point in common while B moves. A search
  /// that ends without knowing is Status::failed, never "no hit".
  virtual Outcome<Impact> cast(const Motion& /*motion*/) { return Status::unsupported; }

  /// Where the two bodies (for some algorithms, the two surfaces) touch or overlap, at most `most` contacts. A library
  /// that finds more leaves out what it leaves out by itself; one that cannot be told a number, all but the first.
  virtual Outcome<Contacts> contacts(const Pose& /*X_AB*/, std::size_t /*most*/) { return Status::unsupported; }

  /// Of the prepared structures of both meshes; what A and B share counts once.
  virtual Footprint footprint() const { return {}; }

  /// Of the last query, always the same units in the same order; empty where nothing is counted.
  virtual std::vector<Work> work() const { return {}; }

  /// Words for the last outcome that was neither ok nor unsupported.
  const std::string& diagnosis() const { return diagnosis_; }

 protected:
  /// Keeps the words, visible, for diagnosis(). @return `status`
  Status fail(Status status, const std::string& words) {
    diagnosis_ = visible_words(words);
    return status;
  }

  /// Whether the pose holds no NaN and no infinity.
  static bool is_finite(const Pose& X_AB) { return X_AB.R.allFinite() && X_AB.t.allFinite(); }

 private:
  std::string diagnosis_;
};

/// What is under test: prepared once per pair of meshes, then queried. Immutable.
class Algorithm {
 public:
  virtual ~Algorithm() = default;  ///< Of whatever derives from it.
  /// What is known of it before it is prepared; the same object at every call.
  virtual const Traits& traits() const = 0;

  /// Builds all structures for A (fixed) and B (moving); `a` and `b` may be the same object. Several threads may call
  /// it at once. Both meshes outlive the query, `settings` does not.
  /// @param settings has a valid value for each of Traits::parameters
  /// @return never null
  /// @throws BadMesh if a mesh cannot be used (e.g. it is not solid), BadArgument for a combination of settings
  virtual std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const = 0;

  /// Default settings.
  Settings settings() const { return Settings(traits().parameters); }
};

/// An algorithm whose prepare() returns a QueryType(a, b, settings).
template <class QueryType>
std::unique_ptr<Algorithm> make_algorithm(Traits traits) {
  class Made final : public Algorithm {
   public:
    explicit Made(Traits traits) : traits_(std::move(traits)) {}
    const Traits& traits() const override { return traits_; }
    std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
      return std::make_unique<QueryType>(a, b, settings);
    }

   private:
    const Traits traits_;
  };
  return std::make_unique<Made>(std::move(traits));
}

}  // namespace sixdof
