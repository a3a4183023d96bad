#include "bench/harness/hull_truth.h"

#include <algorithm>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include "bench/common/hulls.h"

namespace sixdof::bench {

HullTruth::HullTruth(const Mesh& a, const Mesh& b)
    : a_(hull_of(a)), b_(hull_of(b)), diagonal_(a.diagonal()), smaller_volume_(std::min(a_.volume(), b_.volume())) {
  const auto exact = make_exact_algorithm();
  query_ = exact->prepare(a_, b_, exact->settings());
}

std::optional<KnownAnswer> HullTruth::at(const Pose& X_AB) {
  const Outcome<bool> touches = query_->collide(X_AB);
  if (!touches.ok()) return std::nullopt;
  KnownAnswer known{.key = {BucketKind::volume, 1.0}, .diagonal = diagonal_};  // any volume
  if (touches.value) {
    const Outcome<Response> overlap = query_->respond(X_AB);
    if (!overlap.ok() || overlap.value.volume < k_contact * smaller_volume_) return std::nullopt;
    known.target = overlap.value.volume;
  } else {
    const Outcome<Separation> gap = query_->distance(X_AB);
    if (!gap.ok() || gap.value.distance < k_contact * diagonal_) return std::nullopt;
    known.target = gap.value.distance;
    known.key = {BucketKind::distance, 100.0 * known.target / diagonal_};
  }
  return known;
}

std::vector<Response> HullTruth::responses(std::span<const Pose> poses) {
  std::vector<Response> responses;
  for (const Pose& pose : poses) {
    const Outcome<Response> answer = query_->respond(pose);
    if (!answer.ok()) throw Error("exact gives no response of the hulls: " + query_->diagnosis());
    responses.push_back(answer.value);
  }
  return responses;
}

}  // namespace sixdof::bench
