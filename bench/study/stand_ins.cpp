#include "bench/study/stand_ins.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <sixdof/algorithm/core_algorithms.h>

namespace sixdof::study {
namespace {

using bench::QueryKind;

constexpr int k_rounds = 3;

void compare_yes_no(Query& stand_ins, const StudySample& sample, StandInErrors& errors) {
  for (std::size_t i = 0; i < sample.references.size(); ++i) {
    const Reference& reference = sample.references[i];
    const bool truth = reference.known.key.kind == BucketKind::volume;
    StandInErrors::Share& share = errors.yes_no[static_cast<std::size_t>(reference.nearness)];
    ++share.of;
    share.wrong += stand_ins.collide(sample.poses[i]).value != truth;
  }
}

void compare_distances(Query& stand_ins, const StudySample& sample, StandInErrors& errors) {
  for (std::size_t i = 0; i < sample.references.size(); ++i) {
    const bench::KnownAnswer& known = sample.references[i].known;
    // Bodies of which one is inside the other overlap, though their surfaces are apart.
    const bool overlap = stand_ins.collide(sample.poses[i]).value;
    const double distance = overlap ? 0.0 : stand_ins.distance(sample.poses[i]).value.distance;
    errors.bias.push_back((distance - known.target) / known.diagonal);
  }
  std::ranges::sort(errors.bias);
}

}  // namespace

double StandInErrors::mean_bias() const {
  return std::accumulate(bias.begin(), bias.end(), 0.0) / static_cast<double>(bias.size());
}

double StandInErrors::quantile(double share) const {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(bias.size())));
  return bias[std::max<std::size_t>(rank, 1) - 1];
}

StandInErrors measure_stand_ins(const Mesh& a, const Mesh& b, const Mesh& stand_in_a, const Mesh& stand_in_b,
                                const StudySample& yes_no, const StudySample& distance) {
  const auto exact = make_exact_algorithm();
  const auto meshes = exact->prepare(a, b, exact->settings());
  const auto stand_ins = exact->prepare(stand_in_a, stand_in_b, exact->settings());
  StandInErrors errors;
  compare_yes_no(*stand_ins, yes_no, errors);
  compare_distances(*stand_ins, distance, errors);
  for (int round = 0; round < k_rounds; ++round) {
    errors.yes_no_meshes.add(*meshes, QueryKind::collide, yes_no.poses);
    errors.yes_no_stand_ins.add(*stand_ins, QueryKind::collide, yes_no.poses);
    errors.distance_meshes.add(*meshes, QueryKind::distance, distance.poses);
    errors.distance_stand_ins.add(*stand_ins, QueryKind::distance, distance.poses);
  }
  return errors;
}

Mesh joined(const std::vector<Mesh>& parts, const std::string& name) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (const Mesh& part : parts) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), part.vertices().begin(), part.vertices().end());
    for (const Triangle& t : part.triangles()) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return Mesh::build(std::move(vertices), std::move(triangles), name);
}

}  // namespace sixdof::study
