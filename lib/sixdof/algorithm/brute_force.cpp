#include <sixdof/algorithm/core_algorithms.h>

#include <limits>
#include <vector>

#include <sixdof/geometry/triangle_distance.h>

namespace sixdof {
namespace {

class BruteForceQuery final : public Query {
 public:
  BruteForceQuery(const Mesh& a, const Mesh& b, const Settings&) : b_(b), vertices_b_A_(b.vertices().size()) {
    for (const Triangle& t : a.triangles()) {
      triangles_a_.push_back({a.vertices()[t[0]], a.vertices()[t[1]], a.vertices()[t[2]]});
    }
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    const Outcome<Separation> closest = distance(X_AB);
    if (!closest.ok()) return closest.status;
    return closest.value.distance == 0.0;
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    for (std::size_t i = 0; i < vertices_b_A_.size(); ++i) vertices_b_A_[i] = X_AB * b_.vertices()[i];
    Separation best{.distance = std::numeric_limits<double>::infinity(), .has_witnesses = true};
    for (const Triangle& t : b_.triangles()) {
      const TriangleCorners second{vertices_b_A_[t[0]], vertices_b_A_[t[1]], vertices_b_A_[t[2]]};
      for (const TriangleCorners& first : triangles_a_) {
        const ClosestPoints points = triangle_triangle_distance(first, second);
        if (points.distance >= best.distance) continue;
        best.distance = points.distance;
        best.witness_a = points.on_a;
        best.witness_b = points.on_b;
        if (best.distance == 0.0) return best;
      }
    }
    return best;
  }

 private:
  const Mesh& b_;
  std::vector<TriangleCorners> triangles_a_;
  std::vector<Eigen::Vector3d> vertices_b_A_;  ///< B's, in A's frame.
};

}  // namespace

std::unique_ptr<Algorithm> make_brute_force_algorithm() {
  return make_algorithm<BruteForceQuery>({.name = "brute-force",
                                          .version = SIXDOF_VERSION,
                                          .summary = "all pairs of triangles: an independent check for small meshes",
                                          .answers = {.collide = true, .distance = true},
                                          .limits = {.surfaces_only = {.collide = true}},
                                          .timed = false});
}

}  // namespace sixdof
