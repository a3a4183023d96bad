#include <sixdof/conformance/poses.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>
#include <sixdof/oracle/convex_hull.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/overlap.h>

namespace sixdof::conformance {
namespace {

/// Least distance of poses apart, in A's diagonals, and least overlap volume, in volumes of the smaller body: far more
/// than a voxel or a sphere of an approximating algorithm.
constexpr double k_clearly_apart = 0.02, k_clearly_overlapping = 0.05;
/// Poses of each place and pair.
constexpr std::size_t k_poses = 5;

/// Both oracles of one pair; the overlap only if both are solids.
class Oracles {
 public:
  Oracles(const Mesh& a, const Mesh& b) : oracle_(a, b), distance_(oracle_) {
    if (!a.solid() || !b.solid()) return;
    solid_a_.emplace(a, oracle_.tree_a());
    solid_b_.emplace(b, oracle_.tree_b());
    overlap_.emplace(*solid_a_, *solid_b_);
  }

  Case of(const TypedPose& pose) {
    Case result{.pose = pose, .distance = distance_.distance(pose.X_AB, false).distance};
    const bool inside = overlap_ && distance_.collide(pose.X_AB, false);
    result.place = result.distance == 0.0 ? Place::overlapping : inside ? Place::contained : Place::apart;
    if (inside) {
      const Overlap overlap = overlap_->evaluate(pose.X_AB);
      result.volume = overlap.volume;
      result.force = -overlap.area;
    }
    return result;
  }

 private:
  DistanceOracle oracle_;
  DistanceQuery distance_;
  std::optional<Solid> solid_a_, solid_b_;
  std::optional<OverlapQuery> overlap_;
};

using Random = std::mt19937_64;

Eigen::Vector3d direction(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

Eigen::Matrix3d rotation(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

/// B's box centre at `reach` from A's, in a random direction.
TypedPose random_pose(Random& random, const Mesh& a, const Mesh& b, double reach) {
  const Eigen::Matrix3d R = rotation(random);
  return TypedPose::of({R, a.center() + reach * direction(random) - R * b.center()});
}

/// Draws poses until there are k_poses clear ones of each of the two places.
Pair with_cases(Mesh a, Mesh b, std::uint64_t seed) {
  Pair pair{std::move(a), std::move(b), {}};
  Oracles oracles(pair.a, pair.b);
  Random random(seed);
  const double farthest = 0.5 * (pair.a.diagonal() + pair.b.diagonal());
  std::uniform_real_distribution<double> reach(0.1 * farthest, farthest);
  const bool solids = pair.a.solid() && pair.b.solid();
  const double least_volume = solids ? k_clearly_overlapping * std::min(pair.a.volume(), pair.b.volume()) : 0.0;
  std::size_t apart = 0, overlapping = 0;
  while (apart < k_poses || overlapping < k_poses) {
    const Case drawn = oracles.of(random_pose(random, pair.a, pair.b, reach(random)));
    const bool clear = drawn.place == Place::apart ? drawn.distance >= k_clearly_apart * pair.a.diagonal()
                                                   : drawn.place == Place::overlapping && drawn.volume >= least_volume;
    std::size_t& count = drawn.place == Place::apart ? apart : overlapping;
    if (!clear || count == k_poses) continue;
    ++count;
    pair.cases.push_back(drawn);
  }
  return pair;
}

/// A body of at most a third of the other's radius within half of it.
Pair with_one_inside(Mesh a, Mesh b, std::uint64_t seed) {
  Pair pair{std::move(a), std::move(b), {}};
  Oracles oracles(pair.a, pair.b);
  Random random(seed);
  std::uniform_real_distribution<double> reach(0.05, 0.35);
  while (pair.cases.size() < k_poses) {
    const Case drawn = oracles.of(random_pose(random, pair.a, pair.b, reach(random)));
    if (drawn.place == Place::contained) pair.cases.push_back(drawn);
  }
  return pair;
}

/// A plate of twelve triangles, with edges that are not along the axes, so that boxes of its triangles are large.
Mesh turned_plate() {
  return moved(make_box(BoxShape{.size = {2.0, 1.6, 0.08}}, k_minimum_box), generic_motion(7)).renamed("turned plate");
}

Mesh small(const std::string& model, double factor) {
  return scaled(load_model(model), factor).renamed("small " + model);
}

/// @param made of each body, what a pair has of it
std::vector<Pair> make_pairs(const std::function<Mesh(Mesh)>& made) {
  const auto model = [&](const std::string& name) { return made(load_model(name)); };
  // Few triangles: brute force asks all of them, too.
  std::vector<Pair> list;
  list.push_back(with_cases(model("torus-300"), model("cone-100"), 11));
  list.push_back(with_cases(model("bumpy-sphere-80"), model("circular-box-960"), 12));
  list.push_back(with_cases(made(turned_plate()), made(small("sphere-80", 0.15)), 13));
  list.push_back(with_cases(model("circular-box-960"), model("torus-100"), 14));
  list.push_back(with_cases(model("torus-knot-600"), model("torus-100"), 15));
  list.push_back(with_one_inside(model("sphere-1k"), made(small("torus-100", 0.22)), 16));
  list.push_back(with_one_inside(made(small("torus-100", 0.22)), model("sphere-1k"), 17));
  return list;
}

}  // namespace

const std::vector<Pair>& pairs(Body body) {
  if (body == Body::convex_hull) {
    static const std::vector<Pair> hulls =
        make_pairs([](const Mesh& mesh) { return convex_hull(mesh).renamed(mesh.name() + " hull"); });
    return hulls;
  }
  static const std::vector<Pair> list = make_pairs([](Mesh mesh) { return mesh; });
  return list;
}

Pair open_pair() {
  const Mesh torus = load_model("torus-300");
  std::vector<Triangle> triangles = torus.triangles();
  triangles.resize(triangles.size() * 2 / 3);
  return with_cases(load_model("cone-100"), Mesh::build(torus.vertices(), std::move(triangles), "open torus"), 18);
}

Mesh moved(const Mesh& mesh, const Pose& X) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& v : vertices) v = X * v;
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name() + " (moved)");
}

Mesh scaled(const Mesh& mesh, double factor) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& v : vertices) v *= factor;
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name() + " (scaled)");
}

Pose generic_motion(std::uint64_t seed) {
  Random random(seed);
  const Eigen::Matrix3d R = rotation(random);
  return {R, 1.3 * direction(random)};
}

}  // namespace sixdof::conformance
