#include "bench/harness/cast_check.h"

#include <algorithm>

namespace sixdof::bench {

bool has_contacts(const CatalogueEntry& pair) {
  return std::ranges::find(pair.buckets, k_contact) != pair.buckets.end();
}

std::vector<Motion> motions_from_contacts(PairCache& cache, const CatalogueEntry& pair, MotionKind kind, double percent,
                                          std::size_t most, std::uint64_t seed) {
  const BucketSample& bucket = cache.bucket(pair, k_contact);
  const std::size_t count = std::min(most, bucket.poses.size());
  return motions_of(std::span(bucket.poses).first(count), cache.mesh(pair.a), cache.mesh(pair.b), kind, percent, seed);
}

Outcome<Impact> ask_cast(Query& query, const Motion& motion, std::string& words) {
  words.clear();
  Outcome<Impact> answer =
      ask_guarded([&] { return query.cast(motion); }, [&](const std::string& why) { words = why; });
  if (words.empty()) examine(query, answer, [&](const std::string& why) { words = why; });
  return answer;
}

double CastJudge::distance_at(const Motion& motion, double t) {
  if (!query_) query_.emplace(oracle_.emplace(a_, b_));
  return query_->distance(motion.pose_at(t)).distance;
}

JudgedImpact CastJudge::judge(const Motion& motion, const ImpactBracket& truth, const Outcome<Impact>& answer) {
  const bool is_phantom = answer.ok() && answer.value.hit && truth.kind == ImpactBracket::Kind::none;
  const double gap = is_phantom ? distance_at(motion, answer.value.t) : -1.0;
  return judge_impact(truth, answer, impact_tolerance(motion, b_.box(), a_.diagonal()), gap,
                      k_impact_slack * a_.diagonal());
}

std::size_t CastCounts::faults() const {
  return count(ImpactVerdict::late) + count(ImpactVerdict::missed) + count(ImpactVerdict::phantom) +
         count(ImpactVerdict::false_contact);
}

void CastCounts::add(const ImpactBracket& truth, const Outcome<Impact>& answer, const JudgedImpact& judged,
                     const std::string& words) {
  using Kind = ImpactBracket::Kind;
  ++asked;
  ++of[static_cast<std::size_t>(judged.verdict)];
  hits += truth.kind == Kind::hit || truth.kind == Kind::at_start ? 1 : 0;
  early_max = std::max(early_max, judged.early);
  late_max = std::max(late_max, judged.late);
  if (judged.verdict == ImpactVerdict::right) normal_max = std::max(normal_max, judged.normal_angle);
  for (std::size_t k = 0; k < statuses.size(); ++k) {
    if (answer.status == k_counted_statuses[k]) ++statuses[k];
  }
  if (first_failure.empty()) first_failure = words;
}

void CastCounts::add(const CastCounts& other) {
  for (std::size_t i = 0; i < of.size(); ++i) of[i] += other.of[i];
  for (std::size_t i = 0; i < statuses.size(); ++i) statuses[i] += other.statuses[i];
  asked += other.asked;
  hits += other.hits;
  early_max = std::max(early_max, other.early_max);
  late_max = std::max(late_max, other.late_max);
  normal_max = std::max(normal_max, other.normal_max);
  if (first_failure.empty()) first_failure = other.first_failure;
}

std::map<std::string, double> CastCounts::values() const {
  const auto number = [](std::size_t n) { return static_cast<double>(n); };
  std::map<std::string, double> values{{"configurations", number(asked)},
                                       {"hits", number(hits)},
                                       {"failed", number(count(ImpactVerdict::failed))},
                                       {"judged", number(judged())},
                                       {"mismatch", number(faults())},
                                       {"grazing", number(count(ImpactVerdict::not_judged))},
                                       {"early", number(count(ImpactVerdict::early))},
                                       {"early_max", early_max},
                                       {"late_hits", number(count(ImpactVerdict::late))},
                                       {"late_max", late_max},
                                       {"missed_hits", number(count(ImpactVerdict::missed))},
                                       {"phantom_hits", number(count(ImpactVerdict::phantom))},
                                       {"false_starts", number(count(ImpactVerdict::false_contact))}};
  if (normal_max >= 0.0) values["normal_max_deg"] = normal_max;
  for (std::size_t k = 0; k < statuses.size(); ++k) {
    if (statuses[k] > 0) values[std::string(to_string(k_counted_statuses[k]))] = number(statuses[k]);
  }
  return values;
}

}  // namespace sixdof::bench
