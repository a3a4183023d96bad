#include <sixdof/algorithm/exact.h>

#include <sixdof/oracle/distance.h>

namespace sixdof {
namespace {

/// Largest deviation of R^T R from the identity that counts as rounding of a rotation.
constexpr double k_rotation_tolerance = 1e-9;

class ExactQuery final : public Query {
 public:
  ExactQuery(const Mesh& a, const Mesh& b, bool warm_start)
      : oracle_(a, b), distance_query_(oracle_), warm_start_(warm_start) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    if (const Status status = check(X_AB); status != Status::ok) return status;
    return distance_query_.collide(X_AB, warm_start_);
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (const Status status = check(X_AB); status != Status::ok) return status;
    const SurfaceDistance closest = distance_query_.distance(X_AB, {.warm_start = warm_start_});
    return Separation{closest.distance, true, closest.on_a, closest.on_b};
  }

  Footprint footprint() const override {
    const auto nodes = [](const Tree& tree) { return static_cast<double>(tree.nodes().size()); };
    return {oracle_.bytes(), {{"nodes_a", nodes(*oracle_.tree_a())}, {"nodes_b", nodes(*oracle_.tree_b())}}};
  }

 private:
  Status check(const Pose& X_AB) {
    if (!X_AB.R.allFinite() || !X_AB.t.allFinite()) return fail(Status::failed, "the pose is not finite");
    if (!(X_AB.R.transpose() * X_AB.R).isIdentity(k_rotation_tolerance) || X_AB.R.determinant() < 0.0) {
      return fail(Status::failed, "the pose's matrix is not a rotation");
    }
    return Status::ok;
  }

  DistanceOracle oracle_;
  DistanceQuery distance_query_;
  bool warm_start_;
};

class ExactAlgorithm final : public Algorithm {
 public:
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return std::make_unique<ExactQuery>(a, b, settings.choice("warm_start") == "on");
  }

 private:
  Traits traits_{.name = "exact",
                 .version = SIXDOF_VERSION,
                 .summary = "exact distance and yes/no over a bounding-volume tree: truth, and its price",
                 .answers = {.collide = true, .distance = true, .respond = false},
                 .law = ResponseLaw::none,
                 .knobs = {{.name = "warm_start",
                            .meaning = "begin each query with the closest triangles of the last one; never changes a "
                                       "distance",
                            .unit = "1",
                            .standard = "off",
                            .choices = {"off", "on"}}}};
};

}  // namespace

std::unique_ptr<Algorithm> make_exact_algorithm() { return std::make_unique<ExactAlgorithm>(); }

}  // namespace sixdof
