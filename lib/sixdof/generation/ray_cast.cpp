#include <sixdof/generation/ray_cast.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/generation/ray_cast_traversal.h>
#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/geometry/triangle_distance.h>

namespace sixdof {
namespace {

static_assert(k_ray_cast_tie == ray_cast::k_cast_tie);

/// Steps towards the exact distance of the pose as it is used, and the residual that needs none: a few roundings, in
/// units of Cast::size().
constexpr int k_most_polish_steps = 10;
constexpr double k_polished = 3e-16;

/// How far behind a wider target's translation a hit is looked for, in units of where its axis would have it; and how much
/// farther next.
constexpr double k_first_way = 2.0;
constexpr double k_way_growth = 2.0;

class RayCastSolver final : public RaySolver {
 public:
  RayCastSolver(const Mesh& a, std::shared_ptr<const ray_cast::CastMesh> cast_a, const Mesh& b,
                std::shared_ptr<const ray_cast::CastMesh> cast_b)
      : a_(a), b_(b), tree_a_(std::move(cast_a)), tree_b_(std::move(cast_b)), cast_(tree_a_, tree_b_) {
    tree_a_.turn(-Eigen::Matrix3d::Identity());
  }

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(a_, b_, rotation);
    tree_b_.turn(ray_.R);
    cast_.forget_rotation();
    last_direction_.clear();
  }

  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    ray_.direction = direction;
    cast_.direction = direction;
    cast_.front.clear();
    last_direction_.resize(targets.size());
    work_.assign(targets.size(), 0);
    std::optional<LastTarget> last;
    bool reachable = true;
    for (std::size_t k = 0; k < targets.size(); ++k) {
      std::optional<ray_cast::CastPair> pair;
      const std::uint64_t before = cast_.counts.work();
      // Who is missed by a wider target is missed by a narrower one.
      if (reachable) pair = cast(targets[k], last, last_direction_[k]);
      reachable = pair.has_value();
      translations[k] = std::numeric_limits<double>::quiet_NaN();
      residuals[k] = 0.0;
      if (reachable) {
        last = {targets[k], cast_.translations, cast_.axis.dot(cast_.direction), *pair, cast_.axis};
        last_direction_[k] = pair;
        std::tie(translations[k], residuals[k]) = polish(*pair, cast_.translations, targets[k]);
      }
      work_[k] = cast_.counts.work() - before;
    }
  }

  std::uint64_t measurements() const override { return cast_.counts.distances; }
  std::span<const std::uint64_t> work() const override { return work_; }

 private:
  /// What the target before taught, if it was not this ray's first.
  struct LastTarget {
    double target;
    double translations;
    double slope;  ///< d target / d translation
    ray_cast::CastPair pair;
    Eigen::Vector3d axis;
  };

  void start_at(double translations, const Eigen::Vector3d& axis) {
    cast_.translations = translations;
    cast_.axis = cast_.apart_axis = axis;
    cast_.pair.reset();
  }

  std::optional<ray_cast::CastPair> cast(double target, const std::optional<LastTarget>& last,
                                         const std::optional<ray_cast::CastPair>& second_guess) {
    cast_.target = target;
    // The path ends where the centres meet; what ties with that still counts.
    start_at(-k_ray_cast_tie * cast_.size(), cast_.direction);
    if (last) ray_cast::offer_pair(cast_, last->pair);
    if (second_guess) ray_cast::offer_pair(cast_, *second_guess);
    if (last && find_from_above(*last)) return cast_.pair;
    ray_cast::find_first_hit(cast_);
    return cast_.pair;
  }

  /// Where guesses are far behind the target before, looks between the two first: a narrower target is met a little later,
  /// and a search that begins far behind opens much in vain.
  /// @return whether there was a hit; if not, guesses stay
  bool find_from_above(const LastTarget& last) {
    const auto guess = std::tuple(cast_.translations, cast_.pair, cast_.axis, cast_.apart_axis);
    const double behind = std::get<0>(guess);
    // Equal targets have no way between them, but one that grows.
    double way = std::max(k_first_way * (last.target - cast_.target) / last.slope, k_ray_cast_tie * cast_.size());
    for (; last.translations - way > behind; way *= k_way_growth) {
      start_at(last.translations - way, last.axis);
      ray_cast::find_first_hit(cast_);
      if (cast_.pair) return true;
    }
    std::tie(cast_.translations, cast_.pair, cast_.axis, cast_.apart_axis) = guess;
    return false;
  }

  /// Ends with the pose as everyone makes it, whose rounding depends on where the meshes lie in their frames.
  std::pair<double, double> polish(const ray_cast::CastPair& pair, double s, double target) {
    const Tree::Corners& a = tree_a_.mesh().tree().corners()[pair.a];
    const Tree::Corners& b = tree_b_.mesh().tree().corners()[pair.b];
    const auto measure = [&](double translations) {
      const Pose X_AB = ray_.pose(translations);
      ++cast_.counts.distances;
      return triangle_triangle_distance(a, {X_AB * b[0], X_AB * b[1], X_AB * b[2]});
    };
    s = std::max(s, 0.0);
    ClosestPoints closest = measure(s);
    double residual = std::abs(closest.distance - target);
    const double slope = cast_.axis.dot(cast_.direction);
    for (int step = 0; step < k_most_polish_steps && residual > k_polished * cast_.size(); ++step) {
      const double next = std::max(0.0, s - (closest.distance - target) / slope);
      if (!std::isfinite(next) || next == s) break;
      const ClosestPoints next_closest = measure(next);
      const double next_residual = std::abs(next_closest.distance - target);
      if (!(next_residual < residual)) break;
      s = next;
      closest = next_closest;
      residual = next_residual;
    }
    if (residual > k_distance_tolerance * a_.diagonal()) {
      throw Error(fmt::format("distance {} at s = {} instead of {}: the coordinates are too large for the meshes' size",
                              closest.distance, s, target));
    }
    return {s, residual};
  }

  const Mesh& a_;
  const Mesh& b_;
  ray_cast::CastTree tree_a_;  // mirrored
  ray_cast::CastTree tree_b_;
  ray_cast::Cast cast_;
  ConfigurationRay ray_;
  std::vector<std::optional<ray_cast::CastPair>> last_direction_;  // pair of each target
  std::vector<std::uint64_t> work_;                                // of each target
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
  /// One for all solvers that are alive.
  std::shared_ptr<const ray_cast::CastMesh> cast_mesh(const Mesh& mesh) const {
    const std::scoped_lock lock(mutex_);
    std::weak_ptr<const ray_cast::CastMesh>& known = known_[mesh.hash()];
    std::shared_ptr<const ray_cast::CastMesh> made = known.lock();
    if (!made) {
      // Isolated, so that a thread that waits for its part of the tree does not come here again.
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
