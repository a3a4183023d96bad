#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include <sixdof/results/fault.h>
#include <sixdof/results/frontier.h>
#include <sixdof/results/row.h>
#include "bench/study/answer_errors.h"
#include "bench/study/sweep.h"
#include "bench/study/timing_rounds.h"

/// Run time against error: every algorithm at every resolution of its sweep, asked the same configurations of a pair.

namespace sixdof::study {

struct PrecisionPlan {
  bench::QueryKind question = bench::QueryKind::respond;
  std::vector<const Algorithm*> algorithms;  ///< Those that answer the question.
  std::vector<SweptValues> values;           ///< Instead of the algorithms' own sweeps.
  std::string cost = "cpu_time";             ///< Metrics that span the plane of the frontier.
  std::string error = "gamma_F_deg";
  std::uint64_t seed = 1;
  double budget_s = std::numeric_limits<double>::infinity();  ///< Wall time.
  bool single_queries = false;                                ///< Also times single queries, for percentiles.
  /// A point of which more than half of the first queries take longer is left out, and so are the finer ones of its
  /// algorithm.
  double deadline_ns = std::numeric_limits<double>::infinity();
  std::size_t rounds = 5;        ///< Of timing, for every point.
  std::size_t most_rounds = 15;  ///< For points that are not told apart by `rounds`.
};

/// What a point may cost, by names of PrecisionPoint::metric().
std::vector<std::string> cost_metrics();

/// One algorithm with one setting.
struct PrecisionPoint {
  const Algorithm* algorithm = nullptr;
  SweepPoint sweep;
  double prepare_s = 0.0;  ///< Wall time of the first preparation, which the cache on disk may shorten.
  std::size_t bytes = 0;   ///< Footprint.
  AnswerErrors errors;
  TimingRounds times;
  std::optional<SingleQueries> single;
  std::string left_out;  ///< Why it was not measured; empty if it was.

  bool measured() const { return left_out.empty() && times.count() > 0; }
  /// By results::own_faults(). @param asked configurations
  std::vector<results::Fault> faults(std::size_t asked = 0) const;
  bool faulty() const { return !faults().empty(); }
  /// A metric by its name: an error, cpu_time, real_time, p99_ns, p999_ns, ..., bytes, prepare_ns. Empty if the point
  /// has no such value.
  std::optional<Estimate> metric(const std::string& name) const;
};

/// The configurations of a study: `count` of them, or fewer if the budget is too short for all points to be asked them
/// all; at least k_fewest_configurations. How long a query takes is measured at the coarsest point of every algorithm.
/// @throws what draw_sample() throws
StudySample draw_affordable_sample(const PrecisionPlan& plan, bench::PairCache& cache, const CatalogueEntry& pair,
                                   std::size_t count);

inline constexpr std::size_t k_fewest_configurations = 32;

/// The study of one pair.
class PrecisionStudy {
 public:
  /// @param pair, sample, cache outlive the study
  PrecisionStudy(PrecisionPlan plan, bench::PairCache& cache, const CatalogueEntry& pair, const StudySample& sample);

  using Progress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

  /// Errors of every point first, coarse ones first, then rounds of timing over all points; the time that is left goes
  /// to points that the frontier does not tell apart. A point that would not fit into the budget is left out, with the
  /// reason. A BadMesh or another error of one point leaves that point out.
  /// @param finished is called after every step, when points() are whole
  /// @throws Interrupted
  void run(const Progress& progress, const std::function<void()>& finished);

  const std::vector<PrecisionPoint>& points() const { return points_; }

  /// Of the plane of the plan's cost and error.
  std::vector<results::OnFrontier> frontiers() const;

  /// Per point: the mean angle in degrees between its forces and those of the finest point of its algorithm that was
  /// measured without a fault. It shows what the resolution does, apart from the limit to which the algorithm's law
  /// tends. Empty for the finest points themselves, for algorithms of one point, and for other questions.
  std::vector<std::optional<double>> angles_to_finest() const;

  /// Points of the frontier whose costs are not told apart from those of others on it.
  std::size_t undecided() const;

  /// One row per point, "precision/QUESTION/algorithm:NAME/pair:PAIR/PARAMETER:VALUE...", with "/order:motion" if
  /// motions were timed. Bounds of the intervals of METRIC are METRIC_low and METRIC_high.
  std::vector<results::Row> rows() const;

  const PrecisionPlan& plan() const { return plan_; }
  const CatalogueEntry& pair() const { return pair_; }
  const StudySample& sample() const { return sample_; }

 private:
  /// Of the points that have both metrics of the plane: places in points_ of those that results::uncertain() names.
  std::vector<std::size_t> uncertain_places() const;
  double left_s() const;
  Query& query_of(const PrecisionPoint& point);
  double slowest_preparation(const PrecisionPoint& point) const;
  std::string why_left_out(const PrecisionPoint& point) const;
  void check_first_queries(Query& query) const;
  void measure(PrecisionPoint& point);
  bool affordable(const PrecisionPoint& point) const;
  void time_once(PrecisionPoint& point);
  TimedPoses timed_poses(const PrecisionPoint& point) const;
  std::vector<std::size_t> timed_points() const;
  std::vector<std::size_t> uncertain_points() const;
  results::Row row(const PrecisionPoint& point) const;
  std::vector<results::Row> measured_rows() const;

  const PrecisionPlan plan_;
  bench::PairCache& cache_;
  const CatalogueEntry& pair_;
  const StudySample& sample_;
  double started_s_ = 0.0;
  std::vector<PrecisionPoint> points_;  ///< Of each algorithm from coarse to fine.
};

/// How an error of an algorithm falls with its resolution.
struct ErrorOrder {
  std::string algorithm, metric, parameter;
  double order = 0.0, standard_error = 0.0;  ///< error ~ parameter^order.
  std::size_t points = 0;
};

/// For every algorithm with three points or more, that differ in the first of their parameters: of the plan's error and
/// of gamma_F_finest_deg (angles_to_finest()).
std::vector<ErrorOrder> error_orders(const PrecisionStudy& study);

}  // namespace sixdof::study
