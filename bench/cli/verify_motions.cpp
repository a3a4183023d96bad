#include "bench/cli/verify.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/generation/impact_verification.h>
#include <sixdof/generation/motions.h>
#include <sixdof/generation/stored_impacts.h>
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"

namespace sixdof::cli {
namespace {

constexpr BucketKey k_contact{BucketKind::distance, 0};

struct Line {
  MotionKind kind;
  double percent;
  ImpactsVerdict verdict;
};

nlohmann::ordered_json as_json(const Line& line) {
  const ImpactsVerdict& v = line.verdict;
  return {{"motion", to_string(line.kind)},
          {"percent", line.percent},
          {"motions", v.motions},
          {"hits", v.hits},
          {"misses", v.misses},
          {"at_start", v.at_start},
          {"grazing", v.grazing},
          {"widest", v.widest},
          {"wide", v.wide},
          {"changed", v.changed},
          {"earlier", v.earlier},
          {"apart", v.apart},
          {"problems", v.problems}};
}

void print_table(const std::vector<Line>& lines) {
  fmt::print("{:<20} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>8} {:>8} {:>8} {:>8}\n", "motion", "motions", "hits",
             "misses", "at start", "grazing", "widest", "wide", "changed", "earlier", "apart");
  for (const auto& [kind, percent, v] : lines) {
    fmt::print("{:<20} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10.1e} {:>8} {:>8} {:>8} {:>8}\n",
               fmt::format("{} {} %", to_string(kind), percent), v.motions, v.hits, v.misses, v.at_start, v.grazing,
               v.widest, v.wide, v.changed, v.earlier, v.apart);
  }
  fmt::print(
      "percent: of A's diagonal; widest: bracket of a first contact, in units of the motion; problems: wide, "
      "changed, earlier, apart\n");
}

}  // namespace

void verify_motions(const VerifyArguments& arguments, const ConfigurationSet& set, const Mesh& a, const Mesh& b,
                    const Algorithm& oracle) {
  const auto buckets = set.buckets();
  if (std::ranges::find(buckets, k_contact, &BucketSummary::key) == buckets.end()) {
    throw BadArgument(fmt::format("{}: has no poses of contact (distance 0 %), where motions begin", arguments.file));
  }
  const BucketSample contacts = sample_bucket(set, k_contact, a, b, arguments.motions, arguments.seed);
  std::vector<Line> lines;
  {
    ProgressLine progress("verified");
    const std::uint64_t total = k_motion_kinds.size() * k_motion_steps.size() * contacts.poses.size();
    std::uint64_t before = 0;
    for (const MotionKind kind : k_motion_kinds) {
      for (const double percent : k_motion_steps) {
        const std::vector<Motion> motions = motions_of(contacts.poses, a, b, kind, percent, arguments.seed);
        const std::vector<ImpactBracket> truths = stored_impacts(a, b, motions);
        ImpactsVerdict verdict =
            verify_impacts(a, b, motions, truths, oracle, {.seed = arguments.seed},
                           {.progress = [&](std::uint64_t done, std::uint64_t) { progress.show(before + done, total); },
                            .cancelled = InterruptGuard::requested});
        before += motions.size();
        lines.push_back({kind, percent, std::move(verdict)});
      }
    }
  }
  const bool ok = std::ranges::all_of(lines, [](const Line& line) { return line.verdict.ok(); });
  if (arguments.json) {
    auto list = nlohmann::ordered_json::array();
    for (const Line& line : lines) list.push_back(as_json(line));
    fmt::print("{}\n", json_text({{"file", arguments.file},
                                  {"oracle", {{"name", oracle.traits().name}, {"version", oracle.traits().version}}},
                                  {"seed", arguments.seed},
                                  {"ok", ok},
                                  {"motions", std::move(list)}}));
  } else {
    fmt::print("{}: first contacts of motions from {} poses of contact, distances by {} {}, seed {}\n", arguments.file,
               contacts.poses.size(), oracle.traits().name, oracle.traits().version, arguments.seed);
    print_table(lines);
    for (const Line& line : lines) {
      for (const std::string& problem : line.verdict.problems) {
        fmt::print("{} {} %: {}\n", to_string(line.kind), line.percent, problem);
      }
    }
  }
  if (!ok) throw Error(fmt::format("{}: verification of motions failed", arguments.file));
}

}  // namespace sixdof::cli
