#include "bench/study/survey.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/geometry/typed_pose.h>
#include "bench/common/interrupt.h"
#include "bench/harness/judge.h"
#include "bench/harness/timing.h"

namespace sixdof::study {
namespace {

/// A query that seems to be the longest is asked so often in all.
constexpr int k_times = 3;
/// Queries between two looks for an interrupt.
constexpr std::size_t k_between_checks = 256;

bool is_in(ShardNumber shard, std::size_t rotation) { return rotation % shard.count == shard.number - 1; }

/// Poses that are reachable, in the order in which they are asked; counts into the cell.
std::vector<Pose> poses_of(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const SurveyOptions& options,
                           SurveyCell& cell) {
  const Grid& grid = set.grid(cell.key.kind);
  const std::vector<double> translations = set.read(cell.key);
  const std::size_t directions = grid.directions.size();
  std::vector<std::size_t> places;
  for (std::size_t r = 0; r < grid.rotations.size(); ++r) {
    if (!is_in(options.shard, r)) continue;
    cell.configurations += directions;
    for (std::size_t u = 0; u < directions; ++u) {
      if (!std::isnan(translations[r * directions + u])) places.push_back(r * directions + u);
    }
  }
  cell.reachable = places.size();
  cell.asked = options.sample == 0 ? places.size() : std::min(options.sample, places.size());
  std::vector<Pose> poses;
  poses.reserve(cell.asked);
  for (const std::size_t i : random_order(places.size(), options.seed)) {
    if (poses.size() == cell.asked) break;
    const std::size_t place = places[i];
    const ConfigurationRay ray(a, b, grid.rotations[place / directions], grid.directions[place % directions]);
    poses.push_back(ray.pose(translations[place]));
  }
  return poses;
}

void note(SurveyCell& cell, const char* counter, const Pose& X_AB) { cell.poses[counter] = TypedPose::of(X_AB).text(); }

/// Counts a judgement, and the poses of the first and the worst.
void add_judgement(SurveyCell& cell, const bench::Judgement& judgement, const Pose& X_AB) {
  if (judgement.wrong && cell.wrong == 0) note(cell, "mismatch", X_AB);
  if (judgement.missed && cell.missed == 0) note(cell, "misses", X_AB);
  cell.judged += judgement.judged;
  cell.wrong += judgement.wrong;
  cell.missed += judgement.missed;
  if (judgement.error) {
    const double error = std::min(std::abs(*judgement.error), bench::k_largest_error);
    cell.error_sum += error;
    cell.error_squares += error * error;
    if (error > cell.error_max) {
      cell.error_max = error;
      note(cell, cell.question == bench::QueryKind::distance ? "error_max" : "volume_error_max", X_AB);
    }
  }
  if (judgement.phantom_force) {
    ++cell.phantoms;
    cell.phantom_sum += *judgement.phantom_force;
    if (*judgement.phantom_force > cell.phantom_max) {
      cell.phantom_max = *judgement.phantom_force;
      note(cell, "phantom_force_max", X_AB);
    }
  }
}

/// Asks one pose, counts its time and its answer.
template <class Ask>
void ask(SurveyCell& cell, const bench::KnownAnswer& known, const Pose& X_AB, bench::GuardedQuery<Ask>& query) {
  const auto [answer, took_ns] = bench::ask_with_clock(X_AB, query);
  if (!answer.ok()) return;
  cell.sum_ns += took_ns;
  if (took_ns > cell.max_ns) {
    cell.max_ns = took_ns;
    note(cell, "max_ns", X_AB);
  }
  double least_ns = took_ns;
  for (int i = 1; i < k_times && least_ns > cell.max_least_ns; ++i) {
    least_ns = std::min(least_ns, bench::ask_with_clock(X_AB, query).second);
  }
  if (least_ns > cell.max_least_ns) {
    cell.max_least_ns = least_ns;
    note(cell, "max_least_ns", X_AB);
  }
  if constexpr (requires { answer.value.force; }) {
    if (cell.key.kind == BucketKind::volume) {
      cell.force_sum += std::min(answer.value.force.stableNorm(), bench::k_largest_error);
    }
  }
  add_judgement(cell, bench::judge(known, answer.value), X_AB);
}

}  // namespace

SurveyCell survey_bucket(const ConfigurationSet& set, BucketKey key, bench::QueryKind question, const Mesh& a,
                         const Mesh& b, Query& query, const SurveyOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  SurveyCell cell{.question = question, .key = key};
  const std::vector<Pose> poses = poses_of(set, a, b, options, cell);
  const BucketSummary& summary = set.summary(key);
  const bench::KnownAnswer known{.key = key,
                                 .target = summary.target,
                                 .tolerance = summary.tolerance,
                                 .diagonal = a.diagonal(),
                                 .resolution = options.resolution};
  bench::Failures failures;
  bench::with_query_kind(query, question, failures, [&](auto guarded) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (i % k_between_checks == 0) InterruptGuard::check();
      ask(cell, known, poses[i], guarded);
    }
  });
  cell.failed = failures.count();
  if (failures.first_pose()) note(cell, "failed", *failures.first_pose());
  cell.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return cell;
}

void add_to(SurveyCell& sum, const SurveyCell& part) {
  const auto larger = [&](double SurveyCell::*value, const char* counter) {
    if (!(part.*value > sum.*value)) return;
    sum.*value = part.*value;
    if (const auto pose = part.poses.find(counter); pose != part.poses.end()) sum.poses[counter] = pose->second;
  };
  larger(&SurveyCell::max_ns, "max_ns");
  larger(&SurveyCell::max_least_ns, "max_least_ns");
  larger(&SurveyCell::error_max, sum.question == bench::QueryKind::distance ? "error_max" : "volume_error_max");
  larger(&SurveyCell::phantom_max, "phantom_force_max");
  for (const char* const first : {"failed", "mismatch", "misses"}) {
    if (const auto pose = part.poses.find(first); pose != part.poses.end()) sum.poses.try_emplace(first, pose->second);
  }
  for (const auto count : {&SurveyCell::configurations, &SurveyCell::reachable, &SurveyCell::asked, &SurveyCell::failed,
                           &SurveyCell::judged, &SurveyCell::wrong, &SurveyCell::missed, &SurveyCell::phantoms}) {
    sum.*count += part.*count;
  }
  for (const auto value : {&SurveyCell::sum_ns, &SurveyCell::error_sum, &SurveyCell::error_squares,
                           &SurveyCell::force_sum, &SurveyCell::phantom_sum, &SurveyCell::seconds}) {
    sum.*value += part.*value;
  }
}

}  // namespace sixdof::study
