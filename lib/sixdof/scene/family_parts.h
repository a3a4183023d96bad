#pragma once

#include <cstdint>
#include <numbers>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/scene/families.h>

/// What the makers of families share. Internal: use families.h.
namespace sixdof::scene::detail {

/// Seeded numbers; the bits do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  std::size_t pick(std::size_t count) { return engine_() % count; }
  Eigen::Vector3d in_cube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v = in_cube(1.0);
      if (const double n = v.norm(); n > 0.1 && n < 1.0) return v / n;
    }
  }
  /// Uniform over all rotations.
  Eigen::Matrix3d rotation() {
    for (;;) {
      const Eigen::Vector4d q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (const double n = q.norm(); n > 0.1 && n < 1.0) {
        return Eigen::Quaterniond(q[0] / n, q[1] / n, q[2] / n, q[3] / n).toRotationMatrix();
      }
    }
  }
  /// About a random axis, by at most `angle` (radians).
  Eigen::Matrix3d small_rotation(double angle) {
    const Eigen::Vector3d axis = direction();
    return Eigen::AngleAxisd(uniform(-angle, angle), axis).toRotationMatrix();
  }

 private:
  std::mt19937_64 engine_;
};

inline constexpr double k_degree = std::numbers::pi / 180.0;
/// Largest rotation in a frame, as in FCL's broad-phase tests.
inline constexpr double k_turn = 10.0 * k_degree;

/// The value, or the family's own.
inline double own(double value, double family) { return std::isnan(value) ? family : value; }

/// Boxes, spheres and cylinders of a few sizes, shared by all bodies: the proportions of FCL's broad-phase tests (box 5
/// x 10 x 20, sphere of radius 30, cylinder of radius 10 and height 40), in units of 30.
class Shapes {
 public:
  static constexpr std::size_t k_sizes = 4;
  static constexpr std::size_t k_kinds = 3;
  /// Adds k_kinds * k_sizes meshes to the scene, of sizes between 1 / size_ratio and 1, and evenly spread logarithms.
  Shapes(Scene& scene, double size_ratio);
  struct Draw {
    std::vector<std::uint32_t> meshes;  ///< Indices into Scene::meshes.
    double volume = 0.0;                ///< Of all boxes.
  };
  /// Meshes for the bodies from `first` to before `end`: kinds in turn, sizes at random.
  Draw draw(std::size_t first, std::size_t end, Random& random) const;
  double radius(std::uint32_t mesh) const { return radii_[mesh]; }  ///< Half of its box's diagonal.
  double mean_size(const Scene& scene) const;                       ///< Mean diameter of the bodies.

 private:
  std::vector<double> volumes_, radii_;
};

/// Bodies in motion while a scene is made.
struct Mover {
  explicit Mover(Scene& made) : scene(made) {}
  void add(std::uint32_t mesh, const Eigen::Matrix3d& R, const Eigen::Vector3d& t, bool fixed = false) {
    scene.bodies.push_back({static_cast<std::uint32_t>(scene.bodies.size()), mesh, fixed, RecordedPose::of(R, t)});
    poses.push_back({R, t});
  }
  /// In the frame that is made.
  void move(std::uint32_t body, const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
    poses[body] = {R, t};
    scene.frames.back().push_back({body, RecordedPose::of(R, t)});
  }
  Scene& scene;
  std::vector<Pose> poses;
};

/// Every body of the share moves at random from where it is.
void wander(Mover& mover, const SceneNumbers& numbers, double moving, double step, double turn, Random& random);

/// Bodies of Shapes at random places in a cube of the density, without motion. @returns the cube's edge
double fill_cube(Mover& mover, const Shapes& shapes, std::size_t bodies, double density, Random& random);

// One maker per family; families.cpp lists them.
Scene make_cube(const SceneNumbers& numbers);
Scene make_shuffled(const SceneNumbers& numbers);
Scene make_still(const SceneNumbers& numbers);
Scene make_all_move(const SceneNumbers& numbers);
Scene make_clusters(const SceneNumbers& numbers);
Scene make_giant(const SceneNumbers& numbers);
Scene make_dust(const SceneNumbers& numbers);
Scene make_pile(const SceneNumbers& numbers);
Scene make_robot(const SceneNumbers& numbers);
Scene make_pairs(const SceneNumbers& numbers);
Scene make_wave(const SceneNumbers& numbers);
Scene make_twist(const SceneNumbers& numbers);
Scene make_cloth(const SceneNumbers& numbers);
Scene make_bump(const SceneNumbers& numbers);
Scene make_crumple(const SceneNumbers& numbers);

}  // namespace sixdof::scene::detail
