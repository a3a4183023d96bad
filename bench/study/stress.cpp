#include "bench/study/stress.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/parallel.h>
#include <sixdof/geometry/save.h>

namespace sixdof::study {
namespace {

using namespace stability;

/// Whether the algorithm declares a resolution: asked on a small pair.
bool declares_resolution(const Prepare& prepare) {
  const Genes genes = sample_genes(families().front(), 0, 0, 1);
  Draw draw(genes);
  const Case probe = families().front().make(draw);
  PreparedPairs pairs(prepare, {});
  return pairs.ask(probe.shots.front()).resolution > 0.0;
}

/// An algorithm, ready to be asked anything.
struct Subject {
  const Algorithm* algorithm;
  Settings settings;
  Prepare prepare;
  Profile profile;
  bool approximate;

  explicit Subject(const Algorithm& of) : algorithm(&of), settings(coarse_settings(of)) {
    prepare = [&of, chosen = settings](const Mesh& a, const Mesh& b) { return of.prepare(a, b, chosen); };
    profile = profile_of(of.traits(), prepare);
    approximate = declares_resolution(prepare);
  }
};

/// All pairs of triangles take too long; such an algorithm is a check for small meshes (Traits::timed).
bool too_large(const Case& member, const Algorithm& algorithm) {
  constexpr std::size_t k_most_pairs = 100'000;
  return !algorithm.traits().timed && std::ranges::any_of(member.shots, [](const Shot& shot) {
    return shot.a->triangles().size() * shot.b->triangles().size() > k_most_pairs;
  });
}

Judgement judge_case(const Case& member, const Subject& subject) {
  if (!too_large(member, *subject.algorithm)) return judge(member, subject.profile, subject.prepare);
  Judgement judgement;
  judgement.findings.push_back(
      {.verdict = Verdict::unsupported, .metric = "size", .unit = "1", .words = "a check for small meshes"});
  return judgement;
}

void add(StressCell& cell, Case member, const Judgement& judgement) {
  const Finding& worst = judgement.worst();
  if (judgement.slowest_seconds > cell.slowest_seconds) {
    cell.slowest_seconds = judgement.slowest_seconds;
    cell.slow_shot = judgement.slowest_shot;
    cell.slow_member = member;
  }
  // Refusals say something only where there is nothing else.
  const bool refused = worst.verdict == Verdict::unsupported;
  if (refused) ++cell.unsupported;
  const bool only_refusals = cell.unsupported == cell.cases + (refused ? 1 : 0);
  if (cell.cases++ == 0 ||
      (refused ? only_refusals : cell.worst.verdict == Verdict::unsupported || worst.worse_than(cell.worst))) {
    cell.worst = worst;
    cell.member = std::move(member);
  }
}

StressCell run_cell(const Family& family, const Subject& subject, const StressPlan& plan) {
  StressCell cell{.family = &family,
                  .algorithm = subject.algorithm,
                  .settings = subject.settings,
                  .member = {},
                  .worst = {},
                  .slow_member = {}};
  if (family.field_cases != nullptr) {
    for (Case& member : family.field_cases()) {
      const Judgement judgement = judge_case(member, subject);
      add(cell, std::move(member), judgement);
    }
  }
  const std::size_t samples = subject.approximate ? plan.effort.declared_samples : plan.effort.samples;
  Judged worst, slowest;
  for (std::size_t i = 0; i < samples; ++i) {
    Judged sample{.genes = sample_genes(family, plan.seed, i, samples), .member = {}, .judgement = {}};
    Draw draw(sample.genes);
    sample.member = family.make(draw);
    sample.judgement = judge_case(sample.member, subject);
    add(cell, sample.member, sample.judgement);
    if (i == 0 || worse_answer(sample.judgement, worst.judgement)) worst = sample;
    if (i == 0 || slower(sample.judgement, slowest.judgement)) slowest = sample;
  }
  const StressEffort& effort = plan.effort;
  const bool searches = subject.algorithm->traits().timed;  // a check for small meshes must not be led to larger ones
  const std::size_t generations = !searches ? 0 : subject.approximate ? effort.generations / 2 : effort.generations;
  worst = search_worst(family, std::move(worst), subject.profile, subject.prepare, worse_answer, generations,
                       effort.children, plan.seed);
  // What is slow depends on the machine's other work, so the search for it must not decide a verdict.
  slowest = search_worst(family, std::move(slowest), subject.profile, subject.prepare, slower, generations,
                         effort.children, plan.seed + 1);
  add(cell, std::move(worst.member), worst.judgement);
  if (slowest.judgement.slowest_seconds > cell.slowest_seconds) {
    cell.slowest_seconds = slowest.judgement.slowest_seconds;
    cell.slow_shot = slowest.judgement.slowest_shot;
    cell.slow_member = std::move(slowest.member);
  }
  return cell;
}

/// "name=value" of every parameter.
std::vector<std::string> assignments(const Settings& settings) {
  std::vector<std::string> parts;
  std::istringstream text(settings.to_string());
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  return parts;
}

std::string mesh_file(const Mesh& mesh, const std::filesystem::path& folder) {
  constexpr std::size_t k_digits = 12;
  const std::string name = mesh.hash().substr(0, k_digits) + ".off";
  if (folder.empty()) return name;
  const std::filesystem::path file = folder / name;
  if (!std::filesystem::exists(file)) save_mesh(mesh, file);
  return file.string();
}

}  // namespace

std::vector<StressCell> run_stress(const StressPlan& plan,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<Subject> subjects;
  for (const Algorithm* algorithm : plan.algorithms) subjects.emplace_back(*algorithm);
  std::vector<StressCell> cells(plan.families.size() * subjects.size());
  std::mutex mutex;
  std::size_t done = 0;
  parallel::for_each(cells.size(), [&](std::size_t i) {
    cells[i] = run_cell(*plan.families[i / subjects.size()], subjects[i % subjects.size()], plan);
    const std::lock_guard lock(mutex);
    progress(++done, cells.size());
  });
  return cells;
}

std::string reproduction(const Shot& shot, const Algorithm& algorithm, const Settings& settings,
                         const std::filesystem::path& folder) {
  // The program refuses a pose that is none: such a line shows the meshes and the numbers.
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  const bool rotates = !shot.raw || shot.raw->R.allFinite();
  const Eigen::Quaterniond q = rotates ? shot.X_AB.q : Eigen::Quaterniond(k_nan, k_nan, k_nan, k_nan);
  const Eigen::Vector3d t = shot.raw ? shot.raw->t : shot.X_AB.t;
  std::string line = fmt::format("sixdof query --a {} --b {} --pose \"{} {} {} {} {} {} {}\" --algorithm {}",
                                 mesh_file(*shot.a, folder), mesh_file(*shot.b, folder), t.x(), t.y(), t.z(), q.w(),
                                 q.x(), q.y(), q.z(), algorithm.traits().name);
  const std::vector<std::string> chosen = assignments(settings), defaults = assignments(algorithm.settings());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != defaults[i]) line += " -p " + chosen[i];
  }
  return line;
}

}  // namespace sixdof::study
