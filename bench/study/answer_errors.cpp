#include "bench/study/answer_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <type_traits>
#include <utility>

#include <sixdof/measure/direction.h>
#include <sixdof/measure/magnitude.h>
#include "bench/harness/judge.h"
#include "bench/harness/query_kind.h"
#include "bench/harness/response_error.h"

namespace sixdof::study {
namespace {

using bench::Errors;
using bench::GuardedQuery;
using Counters = std::map<std::string, double>;
using Indices = std::span<const std::size_t>;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// Nearest rank, as in measure/latency.h.
double quantile(std::vector<double> values, double q) {
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const std::size_t place = std::max<std::size_t>(rank, 1) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

/// Judged and wrong answers by how far the bodies are from contact.
class ByNearness {
 public:
  void add(Nearness nearness, bool judged, bool wrong) {
    const auto i = static_cast<std::size_t>(nearness);
    judged_[i] += judged;
    wrong_[i] += wrong;
  }
  void count(Counters& counters) const {
    constexpr const char* k_names[] = {"apart", "near", "overlapping"};
    for (std::size_t i = 0; i < 3; ++i) {
      counters[std::string("judged_") + k_names[i]] = judged_[i];
      counters[std::string("wrong_") + k_names[i]] = wrong_[i];
    }
  }

 private:
  std::array<double, 3> judged_{}, wrong_{};
};

/// Answers yes/no.
class Collisions {
 public:
  void add(const Reference& reference, bool answer) {
    judgements_.push_back(bench::judge(reference.known, answer));
    nearness_.push_back(reference.nearness);
    yes_.push_back(answer);
  }
  std::size_t size() const { return yes_.size(); }
  Counters counters(Indices chosen) const {
    Counters counts{
        {"mismatch", 0}, {"false_positives", 0}, {"false_negatives", 0}, {"touching", 0}, {"touching_yes", 0}};
    ByNearness by_nearness;
    for (const std::size_t i : chosen) {
      by_nearness.add(nearness_[i], judgements_[i].judged, judgements_[i].wrong);
      if (!judgements_[i].judged) {
        ++counts["touching"];
        if (yes_[i]) ++counts["touching_yes"];
      } else if (judgements_[i].wrong) {
        ++counts["mismatch"];
        ++counts[yes_[i] ? "false_positives" : "false_negatives"];
      }
    }
    by_nearness.count(counts);
    return counts;
  }

 private:
  std::vector<bench::Judgement> judgements_;
  std::vector<Nearness> nearness_;
  std::vector<bool> yes_;
};

class Distances {
 public:
  void add(const Reference& reference, const Separation& answer) {
    judgements_.push_back(bench::judge(reference.known, answer));
    nearness_.push_back(reference.nearness);
  }
  std::size_t size() const { return judgements_.size(); }
  Counters counters(Indices chosen) const {
    Errors absolute;
    double sum = 0.0;
    Counters counts{{"too_small", 0}, {"too_large", 0}};
    ByNearness by_nearness;
    for (const std::size_t i : chosen) {
      by_nearness.add(nearness_[i], judgements_[i].judged, judgements_[i].wrong);
      const double error = *judgements_[i].error;
      absolute.add(error);
      sum += error;
      if (judgements_[i].wrong) ++counts[error < 0.0 ? "too_small" : "too_large"];
    }
    counts["error_mean"] = sum / static_cast<double>(chosen.size());
    counts["error_rms"] = absolute.rms();
    counts["error_max"] = absolute.largest();
    by_nearness.count(counts);
    return counts;
  }

 private:
  std::vector<bench::Judgement> judgements_;
  std::vector<Nearness> nearness_;
};

/// Forces or torques.
class VectorAnswers {
 public:
  explicit VectorAnswers(std::string suffix) : suffix_(std::move(suffix)) {}

  void add(const Eigen::Vector3d& exact, const Eigen::Vector3d& vector, double scale) {
    series_.add(exact, vector, scale);
    angles_.push_back(exact.isZero(0.0) || vector.isZero(0.0) ? k_nan : angle_degrees(exact, vector));
  }

  void count(Indices chosen, Counters& counters) const {
    std::vector<double> exact, measured, angles;
    for (const std::size_t i : chosen) {
      exact.push_back(series_.exact_magnitudes[i]);
      measured.push_back(series_.magnitudes[i]);
      if (std::isfinite(angles_[i])) angles.push_back(angles_[i]);
    }
    if (const auto error = magnitude_error(exact, measured)) {
      counters["gain_" + suffix_] = error->gain;
      counters["magnitude_error_" + suffix_] = error->relative;
    }
    if (angles.empty()) return;
    const double sum = std::accumulate(angles.begin(), angles.end(), 0.0);
    counters["gamma_" + suffix_ + "_deg"] = sum / static_cast<double>(angles.size());
    counters["gamma_max_" + suffix_ + "_deg"] = *std::ranges::max_element(angles);
    counters["gamma_" + suffix_ + "_p95_deg"] = quantile(std::move(angles), 0.95);
  }

 private:
  const std::string suffix_;
  bench::VectorSeries series_;
  std::vector<double> angles_;  ///< Degrees; NaN where a vector is zero.
};

class Responses {
 public:
  void add(const Reference& reference, const Response& answer) {
    const Response& exact = reference.exact;
    const auto [response, scale] = bench::scaled_about(answer, exact.reference);
    forces_.add(exact.force, response.force, scale);
    torques_.add(exact.torque, response.torque, scale);
    judgements_.push_back(bench::judge(reference.known, answer));
    volumes_.push_back(reference.known.target);
    penalties_.push_back(std::min(std::abs(answer.penalty), bench::k_largest_error));
    has_volume_ = has_volume_ && judgements_.back().error.has_value();
  }
  std::size_t size() const { return judgements_.size(); }
  Counters counters(Indices chosen) const {
    Counters counters{{"misses", 0}, {"judged_overlapping", static_cast<double>(chosen.size())}};
    std::vector<double> volumes, penalties;
    double volume_error = 0.0;
    for (const std::size_t i : chosen) {
      if (judgements_[i].missed) ++counters["misses"];
      volumes.push_back(volumes_[i]);
      penalties.push_back(penalties_[i]);
      volume_error += std::abs(judgements_[i].error.value_or(0.0));
    }
    forces_.count(chosen, counters);
    torques_.count(chosen, counters);
    if (const auto error = magnitude_error(volumes, penalties)) counters["penalty_error"] = error->relative;
    if (has_volume_) counters["volume_error_mean"] = volume_error / static_cast<double>(chosen.size());
    return counters;
  }

 private:
  VectorAnswers forces_{"F"}, torques_{"T"};
  std::vector<bench::Judgement> judgements_;
  std::vector<double> volumes_, penalties_;
  bool has_volume_ = true;
};

bool is_count(const std::string& counter) {
  if (counter.starts_with("judged_") || counter.starts_with("wrong_")) return true;
  for (const char* const count : {"mismatch", "false_positives", "false_negatives", "touching", "touching_yes",
                                  "too_small", "too_large", "misses"}) {
    if (counter == count) return true;
  }
  return false;
}

/// The value over all answers, and the quantiles over resamples of them.
template <class Answers>
std::map<std::string, Estimate> estimate(const Answers& answers, std::uint64_t seed) {
  std::vector<std::size_t> all(answers.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (all.empty()) return {};
  std::map<std::string, std::vector<double>> spread;
  std::mt19937_64 random(seed);
  std::vector<std::size_t> drawn(all.size());
  for (std::size_t k = 0; k < k_resamples; ++k) {
    // Not a std distribution: its numbers differ between standard libraries.
    for (std::size_t& i : drawn) i = random() % all.size();
    for (const auto& [name, value] : answers.counters(drawn)) spread[name].push_back(value);
  }
  std::map<std::string, Estimate> values;
  for (const auto& [name, value] : answers.counters(all)) {
    const auto resampled = spread.find(name);
    if (is_count(name) || resampled == spread.end()) {
      values[name] = Estimate::exactly(value);
    } else {
      // A maximum over a resample is never larger than that over all.
      values[name] = {value, std::min(value, quantile(resampled->second, 0.025)),
                      std::max(value, quantile(resampled->second, 0.975))};
    }
  }
  return values;
}

void keep_force(const Response& answer, Eigen::Vector3d& force) { force = answer.force; }
void keep_force(const auto& /*answer*/, Eigen::Vector3d& /*force*/) {}

/// Collects the answers to a kind of query.
template <class Value>
using AnswersTo = std::conditional_t<std::is_same_v<Value, bool>, Collisions,
                                     std::conditional_t<std::is_same_v<Value, Separation>, Distances, Responses>>;

}  // namespace

std::vector<std::string> error_metrics(bench::QueryKind question) {
  if (question == bench::QueryKind::collide) return {"mismatch", "false_positives", "false_negatives", "failed"};
  if (question == bench::QueryKind::distance) {
    return {"error_rms", "error_mean", "error_max", "too_small", "too_large", "failed"};
  }
  return {"gamma_F_deg",
          "gamma_F_p95_deg",
          "gamma_max_F_deg",
          "gamma_T_deg",
          "gamma_T_p95_deg",
          "gamma_max_T_deg",
          "magnitude_error_F",
          "magnitude_error_T",
          "penalty_error",
          "volume_error_mean",
          "misses",
          "failed"};
}

void AnswerErrors::add_failures(std::size_t count, const std::string& first) {
  if (count == 0) return;
  if (failed == 0) first_failure = first;
  failed += count;
  values["failed"] = Estimate::exactly(static_cast<double>(failed));
}

AnswerErrors measure_errors(Query& query, const StudySample& sample, std::uint64_t seed) {
  AnswerErrors errors;
  errors.forces.assign(sample.references.size(), Eigen::Vector3d::Zero());
  bench::Failures failures;
  bench::with_query_kind(query, sample.question, failures, [&](auto guarded) {
    AnswersTo<decltype(guarded.ask(sample.poses[0]).value)> answers;
    for (std::size_t i = 0; i < sample.poses.size(); ++i) {
      const auto answer = guarded.ask(sample.poses[i]);
      if (!answer.ok()) continue;
      errors.answered.push_back(sample.poses[i]);
      if (i >= sample.references.size()) continue;
      answers.add(sample.references[i], answer.value);
      keep_force(answer.value, errors.forces[i]);
    }
    errors.values = estimate(answers, seed);
    errors.values["configurations"] = Estimate::exactly(static_cast<double>(answers.size()));
  });
  errors.failed = failures.count();
  errors.first_failure = failures.first();
  errors.values["failed"] = Estimate::exactly(static_cast<double>(failures.count()));
  for (const Status status : k_counted_statuses) {
    const std::size_t count = failures.count(status);
    if (count > 0) errors.values[std::string(to_string(status))] = Estimate::exactly(static_cast<double>(count));
  }
  return errors;
}

}  // namespace sixdof::study
