#include "bench/study/cast_agreement.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/stored_impacts.h>
#include "bench/harness/query_command.h"

namespace sixdof::study {
namespace {

std::string text_of(const Outcome<Impact>& answer, const std::string& words) {
  if (!answer.ok()) return fmt::format("{}: {}", to_string(answer.status), words);
  return answer.value.hit ? fmt::format("t {}", answer.value.t) : "no contact";
}

std::string text_of(const ImpactBracket& truth) {
  switch (truth.kind) {
    case ImpactBracket::Kind::none:
      return "no contact";
    case ImpactBracket::Kind::at_start:
      return "t 0";
    case ImpactBracket::Kind::hit:
      return fmt::format("t {}", truth.t_touch);
    case ImpactBracket::Kind::grazing:
      break;
  }
  return fmt::format("no contact before t {}", truth.t_free);
}

/// Motions of one kind and step, with their truths.
struct Group {
  MotionKind kind;
  double percent;
  std::vector<Motion> motions;
  std::vector<ImpactBracket> truths;
};

Group group_of(bench::PairCache& cache, const CatalogueEntry& pair, MotionKind kind, double percent,
               std::uint64_t seed) {
  constexpr std::size_t k_all = std::numeric_limits<std::size_t>::max();
  Group group{kind, percent, bench::motions_from_contacts(cache, pair, kind, percent, k_all, seed), {}};
  for (Motion& motion : group.motions) motion.start = TypedPose::of(motion.start).X_AB;
  group.truths = stored_impacts(cache.mesh(pair.a), cache.mesh(pair.b), group.motions);
  return group;
}

}  // namespace

std::string motion_words(const Motion& motion) {
  const Eigen::Vector3d &v = motion.translation, &w = motion.rotation;
  return fmt::format("--pose '{}' --motion '{} {} {} {} {} {}'", TypedPose::of(motion.start).text(), v.x(), v.y(),
                     v.z(), w.x(), w.y(), w.z());
}

std::vector<CastAnswers> PairCasts::totals() const {
  std::vector<CastAnswers> totals;
  for (const CastAnswers& each : answers) {
    auto found = std::ranges::find(totals, each.algorithm, &CastAnswers::algorithm);
    if (found == totals.end()) found = totals.insert(found, {.algorithm = each.algorithm, .counts = {}});
    found->counts.add(each.counts);
  }
  return totals;
}

PairCasts compare_casts(bench::PairCache& cache, const CatalogueEntry& pair, const MeshWords& meshes,
                        const std::vector<AskedAlgorithm>& wanted, std::uint64_t seed, const RunOptions& run) {
  if (!bench::has_contacts(pair)) {
    throw BadArgument(
        fmt::format("{}: its set has no poses of contact (distance 0 %), where motions begin", pair.pair));
  }
  PairCasts result{.pair = pair.pair, .answers = {}, .refusals = {}, .differences = {}};
  const std::vector<AskedAlgorithm> algorithms = usable(cache, pair, wanted, result.refusals);
  bench::CastJudge judge(cache.mesh(pair.a), cache.mesh(pair.b));
  std::uint64_t done = 0;
  for (const MotionKind kind : k_motion_kinds) {
    for (const double percent : k_motion_steps) {
      const Group group = group_of(cache, pair, kind, percent, seed);
      for (const AskedAlgorithm& asked : algorithms) {
        if (run.progress) run.progress(done++, k_cast_groups * algorithms.size());
        const std::string& name = asked.algorithm->traits().name;
        Query& query = cache.query(*asked.algorithm, asked.settings, pair.a, pair.b);
        CastAnswers& row = result.answers.emplace_back(CastAnswers{name, kind, percent, {}});
        for (std::size_t i = 0; i < group.motions.size(); ++i) {
          run.check_cancelled();
          std::string words;
          const Outcome<Impact> answer = bench::ask_cast(query, group.motions[i], words);
          const JudgedImpact judged = judge.judge(group.motions[i], group.truths[i], answer);
          row.counts.add(group.truths[i], answer, judged, words);
          if (!is_fault(judged.verdict) && judged.verdict != ImpactVerdict::failed) continue;
          const std::string command = bench::query_command(meshes.a, meshes.b, *asked.algorithm, asked.settings);
          result.differences.push_back({.algorithm = name,
                                        .kind = kind,
                                        .percent = percent,
                                        .place = i,
                                        .verdict = judged.verdict,
                                        .answer = text_of(answer, words),
                                        .truth = text_of(group.truths[i]),
                                        .command = fmt::format("{} {}", command, motion_words(group.motions[i]))});
        }
      }
    }
  }
  return result;
}

}  // namespace sixdof::study
