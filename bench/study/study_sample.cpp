#include "bench/study/study_sample.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/harness/motion.h"

namespace sixdof::study {
namespace {

using bench::QueryKind;

/// The sample of one bucket, with responses where they are asked for.
struct BucketTruth {
  const BucketSample* sample;
  std::vector<Response> exact;
};

BucketTruth truth_of(bench::PairCache& cache, const CatalogueEntry& pair, QueryKind question, BucketKey key,
                     std::size_t count) {
  const BucketSample& sample = cache.bucket(pair, key);
  BucketTruth truth{&sample, {}};
  if (question == QueryKind::respond) {
    const auto exact = cache.exact_responses(pair, key, count);
    truth.exact.assign(exact.begin(), exact.end());
  }
  return truth;
}

Nearness nearness_of(BucketKey key) {
  if (key.kind == BucketKind::volume) return key.percent > 0 ? Nearness::overlapping : Nearness::near;
  return key.percent < 100.0 * k_near ? Nearness::near : Nearness::apart;
}

}  // namespace

StudySample draw_sample(bench::PairCache& cache, const CatalogueEntry& pair, QueryKind question,
                        const std::vector<BucketKey>& buckets, std::size_t count) {
  StudySample sample{.question = question};
  for (const BucketKey key : buckets) {
    if (bench::suits(key, question)) sample.buckets.push_back(key);
  }
  if (sample.buckets.empty()) {
    throw BadArgument(fmt::format("{}: its set has no {}, which {} needs (sixdof generate makes such a set)", pair.pair,
                                  question == QueryKind::respond ? "volumes" : "distances", to_string(question)));
  }
  const std::size_t each = count == 0 ? count : (count + sample.buckets.size() - 1) / sample.buckets.size();
  std::vector<BucketTruth> truths;
  std::size_t longest = 0;
  for (const BucketKey key : sample.buckets) {
    truths.push_back(truth_of(cache, pair, question, key, count == 0 ? bench::PairCache::k_most_exact : each));
    longest = std::max(longest, truths.back().sample->poses.size());
  }
  bool judged = true;
  for (std::size_t i = 0; i < (each == 0 ? longest : std::min(each, longest)); ++i) {
    for (const BucketTruth& bucket : truths) {
      if (i >= bucket.sample->poses.size() || (count > 0 && sample.poses.size() == count)) continue;
      const BucketSample& from = *bucket.sample;
      sample.poses.push_back(from.poses[i]);
      judged = judged && (question != QueryKind::respond || i < bucket.exact.size());
      if (!judged) continue;
      sample.references.push_back({.known = bench::KnownAnswer::of(from),
                                   .nearness = nearness_of(from.key),
                                   .exact = question == QueryKind::respond ? bucket.exact[i] : Response{}});
    }
  }
  if (sample.poses.empty()) throw BadArgument(fmt::format("{}: no configuration can be reached", pair.pair));
  return sample;
}

TimedPoses TimedPoses::first(std::size_t count) const {
  TimedPoses some = *this;
  some.poses.resize(std::min(poses.size(), count * period));
  return some;
}

TimedPoses draw_motions(const StudySample& sample, const Mesh& a, const Mesh& b, std::uint64_t seed) {
  // Two motions of this length instead of one twice as long meet twice as many places; what an algorithm keeps from
  // query to query it has found after the first few.
  constexpr std::size_t k_length = 64, k_lead = 8, k_counted = k_length - k_lead;
  const std::size_t count = (sample.poses.size() + k_counted - 1) / k_counted;
  return {bench::poses_of_motions(std::span(sample.poses).first(count), k_length, a, b, seed), k_length, k_lead};
}

}  // namespace sixdof::study
