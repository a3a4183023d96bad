#include <sixdof/generation/impact_verification.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/impact_truth.h>
#include <sixdof/oracle/impact_verdict.h>
#include <sixdof/query/ask.h>

namespace sixdof {
namespace {

using Kind = ImpactBracket::Kind;

/// Everything that is stored; triangles are not. The touching time of a grazing motion is not a number.
bool same_bits(const ImpactBracket& a, const ImpactBracket& b) {
  const bool same_touch = a.t_touch == b.t_touch || (std::isnan(a.t_touch) && std::isnan(b.t_touch));
  return a.kind == b.kind && a.t_free == b.t_free && same_touch && a.closest.distance == b.closest.distance &&
         a.closest.witness_a == b.closest.witness_a && a.closest.witness_b == b.closest.witness_b;
}

class Verification {
 public:
  Verification(const Mesh& a, const Mesh& b, const Algorithm& oracle, const ImpactVerification& options)
      : b_(b),
        diagonal_(a.diagonal()),
        name_(oracle.traits().name),
        truth_(a, b),
        query_(oracle.prepare(a, b, oracle.settings())),
        samples_(options.samples),
        random_(options.seed) {}

  void add(const Motion& motion, const ImpactBracket& truth) {
    ++verdict_.motions;
    switch (truth.kind) {
      case Kind::none:
        ++verdict_.misses;
        break;
      case Kind::hit:
        ++verdict_.hits;
        verdict_.widest = std::max(verdict_.widest, truth.t_touch - truth.t_free);
        break;
      case Kind::at_start:
        ++verdict_.at_start;
        break;
      case Kind::grazing:
        ++verdict_.grazing;
        break;
    }
    if (!same_bits(truth, truth_.find(motion).bracket)) note(verdict_.changed, "its truth has other bits now");
    if (truth.kind == Kind::hit && truth.t_touch - truth.t_free > bracket_width(motion, b_.box())) {
      note(verdict_.wide, fmt::format("its bracket is {:.2e} of the motion wide", truth.t_touch - truth.t_free));
    }
    check_contact(motion, truth);
    check_apart(motion, truth);
  }

  const ImpactsVerdict& verdict() const { return verdict_; }

 private:
  void note(std::size_t& count, const std::string& words) {
    if (++count > 1) return;
    verdict_.problems.push_back(fmt::format("motion {}: {}", verdict_.motions - 1, words));
  }

  double distance(const Motion& motion, double t) {
    return require_distance(*query_, name_, motion.pose_at(t)).distance;
  }

  void check_contact(const Motion& motion, const ImpactBracket& truth) {
    if (truth.kind != Kind::hit && truth.kind != Kind::at_start) return;
    const double t = truth.kind == Kind::hit ? truth.t_touch : 0.0;
    const double gap = distance(motion, t);
    if (gap <= k_impact_slack * diagonal_) return;
    note(verdict_.apart,
         fmt::format("{} measures a gap of {:.2e} diagonals at t {}, where they touch", name_, gap / diagonal_, t));
  }

  void check_apart(const Motion& motion, const ImpactBracket& truth) {
    if (truth.kind == Kind::at_start) return;
    const double end = truth.kind == Kind::none ? 1.0 : truth.t_free - impact_tolerance(motion, b_.box(), diagonal_);
    if (!(end > 0.0)) return;
    for (std::size_t i = 0; i <= samples_; ++i) {
      // Not a std distribution: its numbers differ between standard libraries.
      const double t = i == samples_ ? end : end * (static_cast<double>(random_() >> 11) * 0x1p-53);
      if (distance(motion, t) > 0.0) continue;
      return note(verdict_.earlier, fmt::format("{} measures contact at t {}, before t {}", name_, t, truth.t_free));
    }
  }

  const Mesh& b_;
  const double diagonal_;
  const std::string name_;
  ImpactTruth truth_;
  const std::unique_ptr<Query> query_;
  const std::size_t samples_;
  std::mt19937_64 random_;
  ImpactsVerdict verdict_;
};

}  // namespace

ImpactsVerdict verify_impacts(const Mesh& a, const Mesh& b, std::span<const Motion> motions,
                              std::span<const ImpactBracket> truths, const Algorithm& oracle,
                              const ImpactVerification& options, const RunOptions& run) {
  require_distance_queries(oracle);
  if (truths.size() != motions.size()) throw BadArgument("truths: not as many as motions");
  Verification verification(a, b, oracle, options);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    run.check_cancelled();
    if (run.progress) run.progress(i, motions.size());
    verification.add(motions[i], truths[i]);
  }
  return verification.verdict();
}

}  // namespace sixdof
