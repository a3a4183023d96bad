#include "bench/harness/hull_truth.h"

#include <fmt/format.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include "bench/common/hulls.h"

namespace sixdof::bench {
namespace {

/// Any bucket but that of contact.
constexpr double k_percent = 1.0;

template <class T>
T required(const Query& exact, const Outcome<T>& answer) {
  if (!answer.ok()) throw Error(fmt::format("exact gives no answer about convex hulls: {}", exact.diagnosis()));
  return answer.value;
}

}  // namespace

HullTruth::HullTruth(const Mesh& a, const Mesh& b) : diagonal_(a.diagonal()), a_(hull_of(a)) {
  if (&a != &b) b_ = std::make_unique<const Mesh>(hull_of(b));
  const auto exact = make_exact_algorithm();
  exact_ = exact->prepare(a_, b_ ? *b_ : a_, exact->settings());
}

KnownAnswer HullTruth::at(const BucketSample& bucket, const Pose& X_AB) {
  KnownAnswer known{.key = {BucketKind::distance, k_percent}, .target = 0.0, .tolerance = 0.0, .diagonal = diagonal_};
  const double of_meshes = bucket.key.percent == 0 ? bucket.target + bucket.tolerance : 0.0;
  const double near = of_meshes + k_distance_slack * diagonal_;
  if (!required(*exact_, exact_->collide(X_AB))) {
    known.target = required(*exact_, exact_->distance(X_AB)).distance;
    if (known.target <= near) known.key.percent = 0.0;
    return known;
  }
  const Response response = required(*exact_, exact_->respond(X_AB));
  known.key.kind = BucketKind::volume;
  known.target = response.volume;
  if (response.force.isZero(0.0)) {  // one hull is within the other, or the overlap is too thin for a force
    if (response.volume <= near * diagonal_ * diagonal_) known.key.percent = 0.0;
    return known;
  }
  Pose out = X_AB;
  out.t += 2.0 * near * response.force.normalized();
  if (!required(*exact_, exact_->collide(out))) known.key.percent = 0.0;
  return known;
}

std::vector<Response> HullTruth::responses(std::span<const Pose> poses) {
  std::vector<Response> list;
  for (const Pose& pose : poses) list.push_back(required(*exact_, exact_->respond(pose)));
  return list;
}

}  // namespace sixdof::bench
