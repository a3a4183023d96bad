#include <sixdof/algorithm/core_algorithms.h>

#include <cmath>
#include <optional>

#include <sixdof/algorithm/rotation_check.h>
#include <sixdof/oracle/cast_search.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/translation_cast.h>

namespace sixdof {
namespace {

constexpr double k_most_threads = 64.0;

class ExactQuery final : public Query {
 public:
  ExactQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : oracle_(a, b),
        distance_query_(oracle_),
        cast_search_(oracle_.tree_a(), oracle_.tree_b()),
        warm_start_(settings.choice("warm_start") == "on"),
        center_b_(b.center()) {
    for (const Mesh* mesh : {&a, &b}) {
      if (!mesh->solid()) {
        why_no_response_ = mesh->name() + ": " + mesh->why_not_solid() + k_repair_hint;
        return;
      }
    }
    solid_a_.emplace(a, oracle_.tree_a());
    if (&a != &b) solid_b_.emplace(b, oracle_.tree_b());
    overlap_query_.emplace(*solid_a_, solid_b_ ? *solid_b_ : *solid_a_,
                           static_cast<unsigned>(settings.number("threads")));
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (const Status status = check(X_AB); status != Status::ok) return status;
    return distance_query_.collide(X_AB, warm_start_);
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (const Status status = check(X_AB); status != Status::ok) return status;
    const Separation separation = distance_query_.distance(X_AB, warm_start_);
    if (!std::isfinite(separation.distance)) {
      return fail(Status::non_finite, "the distance is larger than the largest double");
    }
    return separation;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (const Status status = check(X_AB); status != Status::ok) return status;
    if (!overlap_query_) return fail(Status::failed, why_no_response_);
    if (oracle_.certainly_apart(X_AB)) return no_response(X_AB);
    const Overlap overlap = overlap_query_->evaluate(X_AB, warm_start_);
    return Response{.penalty = overlap.volume,
                    .volume = overlap.volume,
                    .force = -overlap.area,
                    .torque = -overlap.moment,
                    .reference = overlap.reference};
  }

  Outcome<Impact> cast(const Motion& motion) override {
    if (const char* const why = motion.why_invalid(); why != nullptr) return fail(Status::non_finite, why);
    if (const Status status = check(motion.start); status != Status::ok) return status;
    if (motion.is_translation()) {
      if (!translation_cast_) translation_cast_.emplace(oracle_.tree_a(), oracle_.tree_b());
      // Bodies that come from outside are apart at the start.
      if (const auto apart = translation_cast_->find(motion)) {
        return apart->next ? decided(cast_search_.find_after(motion, apart->t, *apart->next)) : Impact{};
      }
    }
    if (distance_query_.collide(motion.start, warm_start_)) return contact_at_start(motion.start);
    return decided(cast_search_.find(motion));
  }

  Footprint footprint() const override {
    const auto nodes = [](const Tree& tree) { return static_cast<double>(tree.nodes().size()); };
    std::size_t bytes = oracle_.bytes();
    for (const auto* solid : {&solid_a_, &solid_b_}) bytes += *solid ? (*solid)->bytes() : 0;
    if (overlap_query_) bytes += overlap_query_->bytes();
    if (translation_cast_) bytes += translation_cast_->bytes();
    return {bytes, {{"nodes_a", nodes(oracle_.tree_a())}, {"nodes_b", nodes(oracle_.tree_b())}}};
  }

 private:
  Status check(const Pose& X_AB) {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    if (!is_rotation(X_AB.R)) return fail(Status::failed, "the pose's matrix is not a rotation");
    return Status::ok;
  }

  Response no_response(const Pose& X_AB) const {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    return {.penalty = 0.0, .volume = 0.0, .force = zero, .torque = zero, .reference = X_AB * center_b_};
  }

  Outcome<Impact> decided(const Outcome<Impact>& impact) {
    if (!impact.ok()) return fail(impact.status, "the bodies are too close for too long to decide when they touch");
    return impact;
  }

  /// With a common point where the surfaces have one, which bodies of which one is inside the other do not.
  Impact contact_at_start(const Pose& X_AB) {
    const Separation closest = distance_query_.distance(X_AB, warm_start_);
    Impact impact{.hit = true};
    if (closest.distance > 0.0) return impact;
    impact.has_witnesses = true;
    impact.witness_a = closest.witness_a;
    impact.witness_b = closest.witness_b;
    return impact;
  }

  DistanceOracle oracle_;
  DistanceQuery distance_query_;
  CastSearch cast_search_;
  std::optional<TranslationCast> translation_cast_;  ///< Made by the first translation.
  bool warm_start_;
  Eigen::Vector3d center_b_;  ///< Of B's box, in its frame.
  std::optional<Solid> solid_a_;
  std::optional<Solid> solid_b_;  ///< None if both meshes are the same object.
  std::optional<OverlapQuery> overlap_query_;
  std::string why_no_response_;
};

}  // namespace

std::unique_ptr<Algorithm> make_exact_algorithm() {
  return make_algorithm<ExactQuery>(
      {.name = "exact",
       .version = SIXDOF_VERSION,
       .summary =
           "exact distance, yes/no, first contact, and overlap volume with its gradient: the reference for the others",
       .answers = {.collide = true, .distance = true, .respond = true, .cast = true},
       .law = ResponseLaw::volume,
       .parameters = {
           Parameter::choice("warm_start",
                             "start each query from the closest triangles of the last one, and keep "
                             "candidates for poses near by; changes "
                             "no distance and no response",
                             "off", {"off", "on"}),
           Parameter::count("threads", "threads that a response without a warm start may use; changes no response", "1",
                            1.0, k_most_threads)}});
}

}  // namespace sixdof
