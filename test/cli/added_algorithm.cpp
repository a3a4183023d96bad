// The program sixdof with an algorithm that a Registrar adds: the balls around the bounding boxes, as if they were the
// bodies.
#include <algorithm>

#include <sixdof/query/registrar.h>

namespace {

class BallsQuery final : public sixdof::Query {
 public:
  BallsQuery(const sixdof::Mesh& a, const sixdof::Mesh& b, const sixdof::Settings& settings)
      : center_a_(a.center()),
        center_b_(b.center()),
        radii_(settings.number("scale_a") * a.diagonal() / 2 + settings.number("scale_b") * b.diagonal() / 2) {}

  sixdof::Outcome<bool> collide(const sixdof::Pose& X_AB) override { return gap(X_AB) <= 0.0; }
  sixdof::Outcome<sixdof::Separation> distance(const sixdof::Pose& X_AB) override {
    return sixdof::Separation{.distance = std::max(0.0, gap(X_AB))};
  }
  sixdof::Outcome<sixdof::Response> respond(const sixdof::Pose& X_AB) override {
    const double depth = std::max(0.0, -gap(X_AB));
    const Eigen::Vector3d center = X_AB * center_b_;
    return sixdof::Response{
        .penalty = depth, .force = depth * (center - center_a_).stableNormalized(), .reference = center};
  }

 private:
  double gap(const sixdof::Pose& X_AB) const { return (X_AB * center_b_ - center_a_).norm() - radii_; }

  Eigen::Vector3d center_a_, center_b_;
  double radii_;
};

const sixdof::Registrar k_balls([] {
  const auto scale = [](const char* name) {
    return sixdof::Parameter::number(name, "of the ball's radius", "1", "1", 0.1, 1.0).swept({"1", "0.9", "0.8"});
  };
  return sixdof::make_algorithm<BallsQuery>({.name = "balls",
                                             .version = "7.5 0123456789ab",
                                             .summary = "balls around the bounding boxes",
                                             .answers = {.collide = true, .distance = true, .respond = true},
                                             .law = sixdof::ResponseLaw::depth,
                                             .parameters = {scale("scale_a"), scale("scale_b")}});
});

}  // namespace
