#include "bench/study/set_agreement.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/ask.h>
#include "bench/harness/judge.h"
#include "bench/harness/query_command.h"

namespace sixdof::study {
namespace {

using bench::QueryKind;

std::string as_word(bool answer) { return answer ? "yes" : "no"; }
std::string as_word(const Separation& answer) { return fmt::format("{}", answer.distance); }

/// What is true, as an answer of the same kind.
bool true_answer(const bench::KnownAnswer& known, bool /*answer*/) { return known.key.kind == BucketKind::volume; }
Separation true_answer(const bench::KnownAnswer& known, const Separation& /*answer*/) {
  return {.distance = known.key.kind == BucketKind::volume ? 0.0 : known.target};
}

/// What is asked of one bucket, and where differences go.
struct Bucket {
  const BucketSample& sample;
  std::vector<TypedPose> poses;
  const MeshWords& meshes;
  std::vector<Difference>& differences;
  const RunOptions& run;
  bench::HullTruth* hulls;  ///< The truth of answers about convex hulls; null of others.
};

std::string command_of(const Bucket& bucket, const AskedAlgorithm& asked, const TypedPose& pose) {
  return fmt::format("{} --pose '{}'",
                     bench::query_command(bucket.meshes.a, bucket.meshes.b, *asked.algorithm, asked.settings),
                     pose.text());
}

/// Asks one kind of query at every pose. Failures go to `counts`, and each answer to `answered`.
template <class T, class Answered>
bench::JudgedAnswers ask_bucket(const Bucket& bucket, const AskedAlgorithm& asked, Query& query, QueryKind question,
                                Outcome<T> (Query::*kind)(const Pose&), AnswerCounts& counts,
                                const Answered& answered) {
  bench::KnownAnswer known = bench::KnownAnswer::of(bucket.sample);
  bench::JudgedAnswers judged;
  for (std::size_t i = 0; i < bucket.poses.size(); ++i) {
    bucket.run.check_cancelled();
    if (bucket.hulls != nullptr) known = bucket.hulls->at(bucket.sample, bucket.poses[i].X_AB);
    std::string words;
    const auto failed = [&words](const std::string& why) { words = why; };
    Outcome<T> outcome = ask_guarded([&] { return (query.*kind)(bucket.poses[i].X_AB); }, failed);
    if (words.empty()) examine(query, outcome, failed);
    std::string answer;
    if (outcome.ok()) {
      const bench::Judgement judgement = bench::judge(known, outcome.value);
      judged.add(judgement);
      answered(i, outcome.value);
      if (!judgement.wrong) continue;
      answer = as_word(outcome.value);
    } else {
      ++counts.failed;
      answer = fmt::format("{}: {}", to_string(outcome.status), words);
    }
    bucket.differences.push_back({.algorithm = asked.algorithm->traits().name,
                                  .bucket = bucket.sample.key,
                                  .cell = bucket.sample.cells[i],
                                  .question = question,
                                  .answer = answer,
                                  .truth = as_word(true_answer(known, outcome.value)),
                                  .pose = bucket.poses[i],
                                  .command = command_of(bucket, asked, bucket.poses[i])});
  }
  return judged;
}

/// Of each configuration, which yes/no the algorithms gave.
class Votes {
 public:
  explicit Votes(std::size_t configurations) : yes_(configurations), no_(configurations) {}
  void add(std::size_t i, bool answer) { (answer ? yes_ : no_)[i] = true; }
  std::size_t split() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < yes_.size(); ++i) count += yes_[i] && no_[i];
    return count;
  }

 private:
  std::vector<bool> yes_, no_;
};

AnswerCounts ask_algorithm(const Bucket& bucket, const AskedAlgorithm& asked, Query& query, Votes& votes) {
  const Traits& traits = asked.algorithm->traits();
  AnswerCounts counts{.algorithm = traits.name};
  if (traits.answers.collide) {
    const auto count = [&](std::size_t i, bool answer) {
      if (bucket.hulls == nullptr) votes.add(i, answer);
      counts.yes += answer;
    };
    const bench::JudgedAnswers judged =
        ask_bucket(bucket, asked, query, QueryKind::collide, &Query::collide, counts, count);
    counts.judged_collide = judged.judged;
    counts.wrong_collide = judged.wrong;
  }
  if (traits.answers.distance) {
    const bench::JudgedAnswers judged = ask_bucket(bucket, asked, query, QueryKind::distance, &Query::distance, counts,
                                                   [](std::size_t, const Separation&) {});
    counts.judged_distance = judged.judged;
    counts.wrong_distance = judged.wrong;
    counts.largest_distance_error = judged.errors.largest();
  }
  return counts;
}

bool is_about_hulls(const AskedAlgorithm& asked) { return asked.algorithm->traits().body == Body::convex_hull; }

}  // namespace

std::vector<AskedAlgorithm> usable(bench::PairCache& cache, const CatalogueEntry& pair,
                                   const std::vector<AskedAlgorithm>& algorithms, std::vector<std::string>& refusals) {
  std::vector<AskedAlgorithm> kept;
  for (const AskedAlgorithm& asked : algorithms) {
    try {
      if (is_about_hulls(asked)) static_cast<void>(cache.hull_truth(pair));
      static_cast<void>(cache.query(*asked.algorithm, asked.settings, pair.a, pair.b));
      kept.push_back(asked);
    } catch (const BadMesh& e) {
      refusals.push_back(fmt::format("{}: {}", asked.algorithm->traits().name, e.what()));
    } catch (const Error& e) {
      // A program that is not there, or ends, costs its own answers only.
      if (!is_isolated(*asked.algorithm)) throw;
      refusals.push_back(e.what());
    }
  }
  return kept;
}

std::vector<AnswerCounts> PairAgreement::totals() const {
  std::vector<AnswerCounts> totals;
  for (const BucketAgreement& bucket : buckets) {
    totals.resize(bucket.algorithms.size());
    for (std::size_t i = 0; i < totals.size(); ++i) {
      const AnswerCounts& counts = bucket.algorithms[i];
      totals[i].algorithm = counts.algorithm;
      totals[i].yes += counts.yes;
      totals[i].judged_collide += counts.judged_collide;
      totals[i].wrong_collide += counts.wrong_collide;
      totals[i].judged_distance += counts.judged_distance;
      totals[i].wrong_distance += counts.wrong_distance;
      totals[i].failed += counts.failed;
      totals[i].largest_distance_error = std::max(totals[i].largest_distance_error, counts.largest_distance_error);
    }
  }
  return totals;
}

std::size_t PairAgreement::configurations() const {
  std::size_t count = 0;
  for (const BucketAgreement& bucket : buckets) count += bucket.configurations;
  return count;
}

PairAgreement compare_with_set(bench::PairCache& cache, const CatalogueEntry& pair, const MeshWords& meshes,
                               const std::vector<AskedAlgorithm>& wanted, const RunOptions& run) {
  PairAgreement result{.pair = pair.pair};
  const std::vector<AskedAlgorithm> algorithms = usable(cache, pair, wanted, result.refusals);
  std::uint64_t done = 0;
  const std::uint64_t total = pair.buckets.size() * algorithms.size();
  for (const BucketKey key : pair.buckets) {
    Bucket bucket{cache.bucket(pair, key), {}, meshes, result.differences, run, nullptr};
    for (const Pose& pose : bucket.sample.poses) bucket.poses.push_back(TypedPose::of(pose));
    Votes votes(bucket.poses.size());
    BucketAgreement& agreement = result.buckets.emplace_back();
    agreement.bucket = key;
    agreement.configurations = bucket.poses.size();
    for (const AskedAlgorithm& asked : algorithms) {
      if (run.progress) run.progress(done++, total);
      bucket.hulls = is_about_hulls(asked) ? &cache.hull_truth(pair) : nullptr;
      Query& query = cache.query(*asked.algorithm, asked.settings, pair.a, pair.b);
      agreement.algorithms.push_back(ask_algorithm(bucket, asked, query, votes));
    }
    agreement.split = votes.split();
  }
  return result;
}

}  // namespace sixdof::study
