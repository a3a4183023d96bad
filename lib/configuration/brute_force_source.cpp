#include <sixdof/configuration/brute_force_source.h>

#include <limits>
#include <vector>

#include <sixdof/geometry/triangle_distance.h>

namespace sixdof {
namespace {

class BruteForceProbe final : public DistanceProbe {
 public:
  BruteForceProbe(const Mesh& a, const Mesh& b) : b_(b), placed_(b.vertices().size()) {
    for (const Triangle& t : a.triangles()) {
      triangles_a_.push_back({a.vertices()[t[0]], a.vertices()[t[1]], a.vertices()[t[2]]});
    }
  }

  ProbedDistance measure(const Pose& X_AB) override {
    for (std::size_t i = 0; i < placed_.size(); ++i) placed_[i] = X_AB * b_.vertices()[i];
    ProbedDistance best{.distance = std::numeric_limits<double>::infinity(), .has_witnesses = true};
    for (const Triangle& t : b_.triangles()) {
      const TriangleCorners second{placed_[t[0]], placed_[t[1]], placed_[t[2]]};
      for (const TriangleCorners& first : triangles_a_) {
        const ClosestPoints points = triangle_triangle_distance(first, second);
        if (points.distance >= best.distance) continue;
        best.distance = points.distance;
        best.on_a = points.on_a;
        best.on_b = points.on_b;
        if (best.distance == 0.0) return best;
      }
    }
    return best;
  }

 private:
  const Mesh& b_;
  std::vector<TriangleCorners> triangles_a_;
  std::vector<Eigen::Vector3d> placed_;
};

class BruteForceSource final : public DistanceSource {
 public:
  const std::string& name() const override { return name_; }
  const std::string& version() const override { return version_; }
  std::unique_ptr<DistanceProbe> prepare(const Mesh& a, const Mesh& b) const override {
    return std::make_unique<BruteForceProbe>(a, b);
  }

 private:
  const std::string name_ = "brute-force";
  const std::string version_ = SIXDOF_VERSION;
};

}  // namespace

std::shared_ptr<const DistanceSource> make_brute_force_source() { return std::make_shared<BruteForceSource>(); }

}  // namespace sixdof
