// sixdof or sixdof-bench with an algorithm of your own: link sixdof::cli_main or sixdof::bench_main, which have main().
#include <algorithm>

#include <sixdof/query/registrar.h>

namespace {

/// Balls around the boxes of both meshes.
class BallQuery final : public sixdof::Query {
 public:
  BallQuery(const sixdof::Mesh& a, const sixdof::Mesh& b, const sixdof::Settings& /*settings*/)
      : center_a_(a.center()), center_b_(b.center()), radii_((a.diagonal() + b.diagonal()) / 2.0) {}

  sixdof::Outcome<sixdof::Separation> distance(const sixdof::Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(sixdof::Status::non_finite, "the pose is not finite");
    return sixdof::Separation{.distance = std::max(0.0, (X_AB * center_b_ - center_a_).norm() - radii_)};
  }

 private:
  Eigen::Vector3d center_a_, center_b_;  // each in its own frame
  double radii_;
};

const sixdof::Registrar k_balls([] {
  return sixdof::make_algorithm<BallQuery>(
      {.name = "balls", .version = "1.0", .summary = "balls around the bounding boxes", .answers = {.distance = true}});
});

}  // namespace
