#include <sixdof/generation/distance_generator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/ray_cast_search.h>

namespace sixdof {
namespace {

/// Limit of the steps of refine(), and the residual at which it ends: a few roundings, in units of Cast::size().
constexpr int k_most_refine_steps = 10;
constexpr double k_refined = 3e-16;

class RayCastSolver final : public RaySolver {
 public:
  RayCastSolver(const Mesh& a, std::shared_ptr<const ray_cast::CastMesh> cast_a, const Mesh& b,
                std::shared_ptr<const ray_cast::CastMesh> cast_b)
      : a_(a), b_(b), cast_a_(std::move(cast_a)), cast_b_(std::move(cast_b)), search_(*cast_a_, *cast_b_) {}

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(a_, b_, rotation);
    search_.set_rotation(ray_.R);
  }

  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    ray_.direction = direction;
    search_.start_ray(direction);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      translations[k] = std::numeric_limits<double>::quiet_NaN();
      residuals[k] = 0.0;
      if (const ray_cast::Hit* hit = search_.find_next(targets[k])) {
        std::tie(translations[k], residuals[k]) = refine(*hit, targets[k]);
      }
    }
  }

  std::uint64_t measurements() const override { return search_.cast().counts.distances + refine_distances_; }

 private:
  /// Newton steps from a hit towards the target distance at the pose that ConfigurationRay makes. That distance differs
  /// from the search's by rounding that depends on the meshes' positions in their frames.
  /// @return translation and residual
  std::pair<double, double> refine(const ray_cast::Hit& hit, double target) {
    const Tree::Corners& a = cast_a_->tree().corners()[hit.pair->a];
    const Tree::Corners& b = cast_b_->tree().corners()[hit.pair->b];
    const auto measure = [&](double translation) {
      const Pose X_AB = ray_.pose(translation);
      ++refine_distances_;
      return triangle_triangle_distance(a, {X_AB * b[0], X_AB * b[1], X_AB * b[2]}).distance;
    };
    double s = std::max(hit.translation, 0.0);
    double distance = measure(s);
    double residual = std::abs(distance - target);
    const double slope = hit.axis.dot(ray_.direction);
    for (int step = 0; step < k_most_refine_steps && residual > k_refined * search_.cast().size(); ++step) {
      const double next = std::max(0.0, s - (distance - target) / slope);
      if (!std::isfinite(next) || next == s) break;
      const double next_distance = measure(next);
      const double next_residual = std::abs(next_distance - target);
      if (!(next_residual < residual)) break;
      s = next;
      distance = next_distance;
      residual = next_residual;
    }
    if (residual > k_distance_tolerance * a_.diagonal()) {
      throw BadMesh(
          fmt::format("distance {} at s = {} instead of {}: the coordinates are too large for the meshes' size",
                      distance, s, target));
    }
    return {s, residual};
  }

  const Mesh& a_;
  const Mesh& b_;
  std::shared_ptr<const ray_cast::CastMesh> cast_a_, cast_b_;
  ray_cast::RaySearch search_;
  ConfigurationRay ray_;
  std::uint64_t refine_distances_ = 0;
};

class RayCast final : public DistanceGenerator {
 public:
  const std::string& oracle_name() const override { return name_; }
  const std::string& oracle_version() const override { return version_; }
  std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const override {
    auto cast_a = cast_mesh(a);
    return std::make_unique<RayCastSolver>(a, cast_a, b, cast_mesh(b));
  }

 private:
  /// Shared by all solvers of the mesh that exist at a time.
  std::shared_ptr<const ray_cast::CastMesh> cast_mesh(const Mesh& mesh) const {
    const std::scoped_lock lock(mutex_);
    std::weak_ptr<const ray_cast::CastMesh>& known = known_[mesh.hash()];
    std::shared_ptr<const ray_cast::CastMesh> made = known.lock();
    if (!made) {
      // Isolated: a thread that waits for the tree to be built takes no other task, which could lock the mutex again.
      parallel::isolated(
          [&] { made = std::make_shared<const ray_cast::CastMesh>(std::make_shared<const Tree>(mesh)); });
      known = made;
    }
    return made;
  }

  mutable std::mutex mutex_;
  mutable std::map<std::string, std::weak_ptr<const ray_cast::CastMesh>> known_;
  const std::string name_ = "triangle-distance";
  const std::string version_ = SIXDOF_VERSION;
};

}  // namespace

std::unique_ptr<DistanceGenerator> make_ray_cast() { return std::make_unique<RayCast>(); }

}  // namespace sixdof
