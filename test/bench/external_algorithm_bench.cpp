// A whole program that benchmarks an external algorithm: the algorithm, a Registrar, and sixdof::bench_main at the
// link.

#include <memory>

#include <sixdof/query/registrar.h>

namespace {

/// Answers with the distance of the bounding spheres about both boxes' centres: fast, and rarely right.
class BallQuery final : public sixdof::Query {
 public:
  BallQuery(const sixdof::Mesh& a, const sixdof::Mesh& b)
      : center_a_(a.center()), center_b_(b.center()), radii_((a.diagonal() + b.diagonal()) / 2) {}

  sixdof::Outcome<sixdof::Separation> distance(const sixdof::Pose& X_AB) override {
    const double gap = (X_AB * center_b_ - center_a_).norm() - radii_;
    return sixdof::Separation{.distance = gap > 0.0 ? gap : 0.0};
  }
  sixdof::Footprint footprint() const override { return {.bytes = sizeof(*this), .counts = {{"spheres", 2.0}}}; }

 private:
  Eigen::Vector3d center_a_, center_b_;
  double radii_;
};

class BallAlgorithm final : public sixdof::Algorithm {
 public:
  const sixdof::Traits& traits() const override { return traits_; }
  std::unique_ptr<sixdof::Query> prepare(const sixdof::Mesh& a, const sixdof::Mesh& b,
                                         const sixdof::Settings&) const override {
    return std::make_unique<BallQuery>(a, b);
  }

 private:
  sixdof::Traits traits_{
      .name = "ball", .version = "1", .summary = "one bounding sphere each", .answers = {.distance = true}};
};

const sixdof::Registrar ball([] { return std::make_unique<BallAlgorithm>(); });

}  // namespace
