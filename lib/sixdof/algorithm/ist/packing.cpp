#include <sixdof/algorithm/ist/packing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <random>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/sphere_index.h>
#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>

namespace sixdof::ist {
namespace {

constexpr double k_margin = 1e-9;          // relative gap kept around every sphere, far above rounding
constexpr double k_start_depth = 1e-7;     // of a prototype below its surface point, in diagonals
constexpr double k_depth_rounding = 1e-6;  // of that depth: rounding of coordinates, 1e-16 / 1e-7, with room
constexpr int k_escape_steps = 40;         // doublings of the clearance, at most, before the zigzag
constexpr int k_climb_steps = 64;          // measured clearances per climb after the escape, at most: wedges need many
constexpr std::size_t k_memory = 8;        // obstacles a climbing prototype remembers
constexpr double k_good_enough = 1e-2;     // a climb ends when its model promises less than this relative gain
constexpr double k_together = 0.9;         // spheres of at least this share of the largest are inserted in one round
constexpr std::size_t k_starts_per_sphere = 2;  // surface prototypes per sphere asked for
constexpr std::size_t k_least_starts = 2'000;

struct Prototype {
  Eigen::Vector3d position;
  double clearance = 0.0;
  std::uint64_t order = 0;  ///< Breaks ties.
  bool operator<(const Prototype& o) const {
    return clearance != o.clearance ? clearance < o.clearance : order > o.order;
  }
};

/// What limits the clearance of a prototype, as seen from where it was met: a placed sphere, or the surface's tangent
/// plane at the closest point.
struct Obstacle {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< Centre of the sphere, or point on the surface.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Plane: unit normal towards the prototype. Sphere: unused.
  double radius = 0.0;                               ///< Sphere: > 0. Plane: 0.

  double distance(const Eigen::Vector3d& p) const {
    return radius > 0.0 ? (p - point).norm() - radius : normal.dot(p - point);
  }
  Eigen::Vector3d away(const Eigen::Vector3d& p) const {
    return radius > 0.0 ? Eigen::Vector3d((p - point).normalized()) : normal;
  }
};

/// The free space left: inside the mesh, outside the placed spheres.
class FreeSpace {
 public:
  FreeSpace(const Tree& tree, double largest) : tree_(tree), placed_(largest) {}

  struct Clearance {
    double value = 0.0;  ///< Distance to the closest obstacle; `bound` if none is nearer than that.
    Obstacle obstacle;   ///< The closest one.
  };

  /// `bound` is an upper bound on the answer: clearance changes by at most the length of a step.
  Clearance clearance(const Eigen::Vector3d& p, double bound) const {
    constexpr double k_bound_slack = 1.0 + 1e-12;
    const auto sphere = placed_.nearest(p, bound * k_bound_slack);
    const auto surface = closest_point(tree_, p, std::max(0.0, std::min(bound * k_bound_slack, sphere.clearance)));
    if (surface) {
      const Eigen::Vector3d offset = p - surface->point;
      const Eigen::Vector3d away =
          surface->distance > 0.0 ? Eigen::Vector3d(offset / surface->distance) : Eigen::Vector3d::Zero();
      return {surface->distance, {surface->point, away, 0.0}};
    }
    if (sphere.sphere < 0) return {bound, {}};
    const Sphere& nearest = placed_.spheres()[static_cast<std::size_t>(sphere.sphere)];
    return {sphere.clearance, {nearest.center, Eigen::Vector3d::Zero(), nearest.radius}};
  }

  double clearance_of_spheres(const Eigen::Vector3d& p, double within) const {
    return placed_.nearest(p, within).clearance;
  }

  void place(const Sphere& sphere) { placed_.insert(sphere); }
  std::span<const Sphere> placed() const { return placed_.spheres(); }

 private:
  const Tree& tree_;
  SphereIndex placed_;
};

/// The last few obstacles met: a model of the clearance near a prototype, free to evaluate.
class ObstacleMemory {
 public:
  void add(const Obstacle& obstacle) {
    obstacles_[next_ % k_memory] = obstacle;
    ++next_;
  }

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    const Obstacle* obstacle = nullptr;
  };
  Nearest nearest(const Eigen::Vector3d& p) const {
    Nearest best;
    for (std::size_t i = 0; i < std::min(next_, k_memory); ++i) {
      const double distance = obstacles_[i].distance(p);
      if (distance < best.distance) best = {distance, &obstacles_[i]};
    }
    return best;
  }

  /// Best point of the model within `trust` of `start`: moves away from the closest obstacle with shrinking steps.
  std::pair<Eigen::Vector3d, double> ascend(const Eigen::Vector3d& start, double trust) const {
    constexpr int k_steps = 40;
    constexpr double k_decay = 0.88;  // 0.88^40 = 0.6 %
    Eigen::Vector3d p = start, best = start;
    Nearest here = nearest(p);
    double best_distance = here.distance;
    double length = 0.5 * trust;
    for (int i = 0; i < k_steps; ++i, length *= k_decay) {
      p += here.obstacle->away(p) * length;
      if (const double out = (p - start).norm(); out > trust) p = start + (p - start) * (trust / out);
      here = nearest(p);
      if (here.distance > best_distance) {
        best = p;
        best_distance = here.distance;
      }
    }
    return {best, best_distance};
  }

 private:
  std::array<Obstacle, k_memory> obstacles_;
  std::size_t next_ = 0;
};

struct Start {
  Eigen::Vector3d position;
  double bound;        ///< Upper bound on the clearance here.
  double least = 0.0;  ///< With less clearance the start is not where it should be, and is given up.
};

/// Lets a prototype climb from `start` (inside the free space) to a place of locally largest clearance.
///
/// First it doubles its clearance away from what it starts at; then it climbs by cutting planes: every measured
/// clearance adds an obstacle to the model, the model's best point within a trusted distance is measured next.
Prototype climb(const FreeSpace& space, const Start& start, std::uint64_t order) {
  ObstacleMemory memory;
  auto here = space.clearance(start.position, start.bound);
  if (here.value < start.least) return {start.position, 0.0, order};
  Prototype best{start.position, here.value, order};
  for (int i = 0; i < k_escape_steps && here.value > 0.0; ++i) {
    memory.add(here.obstacle);
    const Eigen::Vector3d next = best.position + here.obstacle.away(best.position) * (0.99 * best.clearance);
    here = space.clearance(next, 2.0 * best.clearance);
    const bool slowing = here.value < 1.5 * best.clearance;
    if (here.value > best.clearance) best = {next, here.value, order};
    if (slowing) break;
  }
  memory.add(here.obstacle);
  double trust = 0.9 * best.clearance;
  for (int i = 0; i < k_climb_steps && best.clearance > 0.0; ++i) {
    const auto [next, promise] = memory.ascend(best.position, trust);
    if (promise < best.clearance * (1.0 + k_good_enough)) break;
    here = space.clearance(next, best.clearance + trust);
    memory.add(here.obstacle);
    if (here.value > best.clearance) {
      best = {next, here.value, order};
      trust = std::min(1.5 * trust, 0.9 * best.clearance);
    } else {
      trust *= 0.6;
    }
  }
  return best;
}

/// Starting points just below the surface, at equal shares of its area in the triangles' order (stratified). One whose
/// own surface point is not the closest has another wall nearer by, and may even be beyond it: it does not start.
std::vector<Start> surface_starts(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  std::vector<Start> starts;
  starts.reserve(count);
  const double depth = k_start_depth * mesh.diagonal();
  const double share = mesh.area() / static_cast<double>(count);
  double passed = 0.0;
  double next = share * uniform();
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d& a = mesh.vertices()[t[0]];
    const Eigen::Vector3d& b = mesh.vertices()[t[1]];
    const Eigen::Vector3d& c = mesh.vertices()[t[2]];
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double area = 0.5 * cross.norm();
    for (passed += area; next < passed; next += share) {
      double u = uniform(), v = uniform();
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      starts.push_back({a + u * (b - a) + v * (c - a) - cross * (depth / (2.0 * area)),
                        depth * (1.0 + k_depth_rounding), depth * (1.0 - k_depth_rounding)});
    }
  }
  return starts;
}

/// Starting points on the surface of a placed sphere, in the directions of a cube's corners.
void starts_around(const Sphere& sphere, std::vector<Start>& starts) {
  // Half-way into the gap that the sphere keeps: outside the sphere, yet not through a surface it touches.
  const double reach = sphere.radius * (1.0 + 0.5 * k_margin) / std::sqrt(3.0);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d direction((corner & 1) != 0 ? reach : -reach, (corner & 2) != 0 ? reach : -reach,
                                    (corner & 4) != 0 ? reach : -reach);
    starts.push_back({sphere.center + direction, sphere.radius});
  }
}

double total_volume(std::span<const Sphere> spheres) {
  double volume = 0.0;
  for (const Sphere& s : spheres) volume += s.volume();
  return volume;
}

class Packer {
 public:
  Packer(const Mesh& mesh, const Tree& tree, const PackingGoal& goal)
      : mesh_(mesh), goal_(goal), least_(goal.smallest_radius * mesh.diagonal()), space_(tree, mesh.diagonal()) {}

  Packing run() {
    send(surface_starts(mesh_, std::max(k_least_starts, k_starts_per_sphere * goal_.spheres), goal_.seed));
    while (!waiting_.empty() && !done()) round();
    Packing result{{space_.placed().begin(), space_.placed().end()}, total_volume(space_.placed()) / mesh_.volume()};
    if (result.spheres.empty()) {
      throw BadMesh(fmt::format("{}: too thin for a sphere of radius {}", mesh_.name(), least_));
    }
    return result;
  }

 private:
  bool done() const { return space_.placed().size() >= goal_.spheres || filled_ >= goal_.fill * mesh_.volume(); }

  /// Lets prototypes climb from all starts, in parallel, and queues those that found room.
  void send(const std::vector<Start>& starts) {
    std::vector<Prototype> arrived(starts.size());
    const std::uint64_t first = order_;
    order_ += starts.size();
    parallel::for_each(starts.size(), [&](std::size_t i) { arrived[i] = climb(space_, starts[i], first + i); });
    for (const Prototype& prototype : arrived) {
      if (prototype.clearance >= least_) waiting_.push(prototype);
    }
  }

  /// Inserts the largest that still fit; those that no longer do climb again from where they stand.
  void round() {
    std::vector<Prototype> front;
    const double enough = k_together * waiting_.top().clearance;
    while (!waiting_.empty() && waiting_.top().clearance >= enough) {
      front.push_back(waiting_.top());
      waiting_.pop();
    }
    std::vector<Start> starts;
    for (const Prototype& p : front) {
      if (done()) return;
      const double clearance = space_.clearance_of_spheres(p.position, p.clearance);
      if (clearance < p.clearance) {
        // Inside a sphere there is nothing to climb from; outside, the bound is what was just measured.
        if (clearance > 0.0) starts.push_back({p.position, clearance});
        continue;
      }
      const Sphere sphere{p.position, p.clearance * (1.0 - k_margin)};
      space_.place(sphere);
      filled_ += sphere.volume();
      starts_around(sphere, starts);
    }
    send(starts);
  }

  const Mesh& mesh_;
  const PackingGoal goal_;
  const double least_;
  FreeSpace space_;
  std::priority_queue<Prototype> waiting_;
  std::uint64_t order_ = 0;
  double filled_ = 0.0;
};

}  // namespace

Packing pack_spheres(const Mesh& mesh, const Tree& tree, const PackingGoal& goal) {
  if (!mesh.solid()) throw BadMesh(mesh.name() + ": " + mesh.why_not_solid());
  return Packer(mesh, tree, goal).run();
}

Packing pack_spheres_cached(const Mesh& mesh, const PackingGoal& goal) {
  if (!mesh.solid()) throw BadMesh(mesh.name() + ": " + mesh.why_not_solid());
  constexpr const char* k_kind = "ist-packing";
  // Raise the number whenever the packing of the same mesh and goal changes.
  const std::string key = fmt::format("2 {} spheres={} fill={} smallest_radius={} seed={}", mesh.hash(), goal.spheres,
                                      goal.fill, goal.smallest_radius, goal.seed);
  if (auto entry = load_cached(k_kind, key)) {
    const auto values = entry->take<double>("spheres");
    Packing packing;
    for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
      packing.spheres.push_back({{values[i], values[i + 1], values[i + 2]}, values[i + 3]});
    }
    packing.fill = total_volume(packing.spheres) / mesh.volume();
    if (!packing.spheres.empty()) return packing;
  }
  Packing packing = pack_spheres(mesh, Tree(mesh), goal);
  std::vector<double> values;
  values.reserve(4 * packing.spheres.size());
  for (const Sphere& s : packing.spheres) {
    values.insert(values.end(), {s.center.x(), s.center.y(), s.center.z(), s.radius});
  }
  CacheEntry entry;
  entry.put("spheres", std::move(values));
  store_cached(k_kind, key, entry);
  return packing;
}

}  // namespace sixdof::ist
