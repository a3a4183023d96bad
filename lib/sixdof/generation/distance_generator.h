#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

class Algorithm;

/// Finds the translations at which targets are met, for one pair of meshes. Used by one thread at a time. Results may
/// depend on the rays solved since set_rotation() and their order, but on nothing before.
class RaySolver {
 public:
  virtual ~RaySolver() = default;  ///< Of whatever derives from it.

  /// Sets B's rotation (w, x, y, z) for the rays that follow.
  virtual void set_rotation(const Eigen::Vector4d& rotation) = 0;

  /// Moves the centre of B's box along the ray from the centre of A's box in direction u (A's frame), inwards from far
  /// outside.
  /// @param targets distances in the meshes' length unit, positive and descending (of volume_solvers():
  /// volumes, ascending)
  /// @param translations one per target: the largest s >= 0 at which it is met, NaN if there is none
  /// @param residuals one per target: |measured - target| at that s, 0 if there is none
  /// @throws BadMesh if coordinates are too large for the tolerance; Error if a target is passed without being met
  virtual void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
                     std::span<double> residuals) = 0;

  /// Number of distances or volumes measured so far.
  virtual std::uint64_t measurements() const = 0;
};

/// A method that finds the configurations of distance buckets.
class DistanceGenerator {
 public:
  virtual ~DistanceGenerator() = default;  ///< Of whatever derives from it.
  /// The method that measures distances, for the attributes of the set.
  virtual const std::string& oracle_name() const = 0;
  /// Of that method.
  virtual const std::string& oracle_version() const = 0;
  /// May be called from several threads. Both meshes outlive the solver. @throws BadMesh
  virtual std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const = 0;
};

/// The sphere method by one ray cast per configuration instead of an iteration. A ray is cast against the Minkowski
/// difference of B and A, grown by the target distance. The largest translation s with dist(A, B + s u) = target is the
/// largest over all pairs of triangles, which one branch and bound over two trees finds. It is the first hit from
/// outside, however short the interval in which the distance is below the target. The search for each target of a ray
/// starts from the pairs that the search for the larger target before it did not cull.
///
/// A hit is not replaced by one that is farther out by less than 1e-14, in units of the sum of the meshes' radii and
/// the target (k_cast_tie).
///
/// Results have the same bits for every number of threads and on every instruction set.
std::unique_ptr<DistanceGenerator> make_ray_cast();

/// How B moves along a ray.
enum class SphereMarch {
  certified,     ///< By the longest certified steps; each target continues where the larger one before it was met.
  conservative,  ///< By the distance less the target (conservative advancement); every target alone, from outside.
};

/// The paper's sphere method on top of a distance algorithm: B moves from outside towards A and stops where the target
/// is met for the first time.
///
/// Steps are as long as is certain to pass no hit. Let f(s) be the distance at translation s. Two facts bound it:
/// - |f(s) - f(s')| <= |s - s'|, since B moves by |s - s'| (conservative advancement; Mirtich 1996);
/// - f(s)^2 - s^2 is concave: it is the minimum over all pairs of points (p on A, q on B) of a linear function of s. So
///   between two measurements f^2 lies above the parabola with leading coefficient 1 through both.
/// SphereMarch::certified uses both. By the second, one further measurement certifies a Newton step from the witnesses
/// wherever the target is not small against the step. SphereMarch::conservative uses the first alone and needs many
/// more measurements, most of all where B grazes A.
///
/// Certified steps may pass a hit that begins and ends within k_first_hit_resolution; conservative ones pass none.
/// @param algorithm measures the distances, with its default settings. They have to be exact and depend on the pose
/// alone, in every bit. It outlives the generator.
/// @throws BadArgument if it answers no distance queries
std::unique_ptr<DistanceGenerator> make_sphere_method(const Algorithm& algorithm,
                                                      SphereMarch march = SphereMarch::certified);

/// In units of the diagonal of A's box. The distance falls below the target by at most half of it in a hit so short.
constexpr double k_first_hit_resolution = 1e-6;

/// Buckets as they were solved.
struct Generated {
  /// In the order of the percentages asked for. The rows of a bucket are in the order of the rotations asked for; those
  /// of a whole grid are as ConfigurationSetWriter::write() takes them.
  std::vector<Bucket> buckets;
  std::uint64_t measurements = 0;  ///< Distances or volumes that were measured.
};

/// Finds all configurations of distance buckets. Every distinct rotation is solved once. The result has the same bits
/// for every number of threads and every split into shards.
/// @param percents of the diagonal of A's box, each once, as a BucketKey has them
/// @param run a step is one configuration that is solved
/// @param rotations indices into the grid, a shard's part; empty: all rotations of the grid
/// @throws BadArgument, Interrupted, and Error from the solver naming the configuration
Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const double> percents, const RunOptions& run = {},
                             std::span<const std::uint32_t> rotations = {});

namespace detail {

/// The loop over rotations and directions that fills buckets of either kind: solves every distinct rotation once, on
/// several threads, and copies its rows to its repeats. The result has the same bits for every number of threads.
/// @param prepare makes the solver of a thread
/// @param summaries of buckets of one kind; their largest residuals are filled in
/// @param rotations indices into the grid; empty: all rotations of the grid
/// @return the buckets in the order of `summaries`
/// @throws BadArgument if there is no bucket, one is asked for twice, or the grid does not have one of the rotations;
/// Interrupted; Error from the solver naming the configuration
Generated sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                          const std::vector<BucketSummary>& summaries, const RunOptions& run,
                          std::span<const std::uint32_t> rotations);

}  // namespace detail
}  // namespace sixdof
