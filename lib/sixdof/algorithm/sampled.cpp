#include <sixdof/algorithm/core_algorithms.h>

#include <sixdof/oracle/distance.h>

namespace sixdof {
namespace {

constexpr const char* k_steps = "steps";
constexpr double k_most_steps = 1e6;

/// Halvings of a step: the answer is within 1e-12 of a step.
constexpr int k_halvings = 40;

class SampledQuery final : public Query {
 public:
  SampledQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : oracle_(a, b), query_(oracle_), steps_(static_cast<int>(settings.number(k_steps))) {}

  Outcome<Impact> cast(const Motion& motion) override {
    if (const char* const why = motion.why_invalid(); why != nullptr) return fail(Status::non_finite, why);
    for (int i = 0; i <= steps_; ++i) {
      const double t = static_cast<double>(i) / steps_;
      if (!query_.collide(motion.pose_at(t))) continue;
      return i == 0 ? Impact{.hit = true} : impact_between(motion, static_cast<double>(i - 1) / steps_, t);
    }
    return Impact{};
  }

  Footprint footprint() const override { return {oracle_.bytes(), {}}; }

 private:
  Impact impact_between(const Motion& motion, double apart, double touching) {
    for (int i = 0; i < k_halvings; ++i) {
      const double middle = 0.5 * (apart + touching);
      (query_.collide(motion.pose_at(middle)) ? touching : apart) = middle;
    }
    Impact impact{.hit = true, .t = touching};
    const Separation closest = query_.distance(motion.pose_at(apart));
    impact.has_witnesses = true;
    impact.witness_a = closest.witness_a;
    impact.witness_b = closest.witness_b;
    return impact;
  }

  DistanceOracle oracle_;
  DistanceQuery query_;
  const int steps_;
};

}  // namespace

std::unique_ptr<Algorithm> make_sampled_algorithm() {
  return make_algorithm<SampledQuery>(
      {.name = "sampled",
       .version = SIXDOF_VERSION,
       .summary =
           "first contact by exact yes/no at equal steps of the motion and bisection; contacts between are missed",
       .answers = {.cast = true},
       .parameters =
           {Parameter::count(k_steps, "steps of a motion", "16", 1.0, k_most_steps).swept({"4", "16", "64", "256"})},
       .by_default = false});
}

}  // namespace sixdof
