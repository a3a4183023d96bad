#include "bench/study/stress.h"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/geometry/save.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/ray_algorithm.h>
#include <sixdof/stability/search.h>
#include "bench/harness/query_command.h"

namespace sixdof::study {
namespace {

using namespace stability;

/// Tells a watch what is asked.
class WatchedQuery final : public Query {
 public:
  WatchedQuery(std::unique_ptr<Query> inner, const StressWatch& watch) : inner_(std::move(inner)), watch_(watch) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    return ask(X_AB, [&] { return inner_->collide(X_AB); });
  }
  Outcome<Separation> distance(const Pose& X_AB) override {
    return ask(X_AB, [&] { return inner_->distance(X_AB); });
  }
  Outcome<Response> respond(const Pose& X_AB) override {
    return ask(X_AB, [&] { return inner_->respond(X_AB); });
  }
  Outcome<Impact> cast(const Motion& motion) override {
    return ask(motion.start, [&] { return inner_->cast(motion); });
  }
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    return ask(X_AB, [&] { return inner_->contacts(X_AB, most); });
  }
  Footprint footprint() const override { return inner_->footprint(); }

 private:
  /// @param question gives an Outcome; it is asked at X_AB, or begins there
  template <class Question>
  std::invoke_result_t<Question> ask(const Pose& X_AB, const Question& question) {
    watch_.asks(X_AB);
    std::invoke_result_t<Question> answer = question();
    if (!answer.ok()) fail(answer.status, inner_->diagnosis());
    return answer;
  }

  std::unique_ptr<Query> inner_;
  const StressWatch& watch_;
};

/// An algorithm, ready to be asked anything.
struct Subject {
  const Algorithm& algorithm;
  const StressWatch& watch;
  Settings settings;
  Prepare prepare;

  Subject(const Algorithm& of, StressSettings which, const StressWatch& watching)
      : algorithm(of), watch(watching), settings(settings_of(of, which)), prepare([this](const Mesh& a, const Mesh& b) {
          watch.prepares();
          return std::make_unique<WatchedQuery>(algorithm.prepare(a, b, settings), watch);
        }) {}
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
};

/// All pairs of triangles take too long; such an algorithm is a check for small meshes (Traits::timed).
bool too_large(const Case& member, const Algorithm& algorithm) {
  constexpr std::size_t k_most_pairs = 100'000;
  return !algorithm.traits().timed && std::ranges::any_of(member.shots, [](const Shot& shot) {
    return shot.a->triangles().size() * shot.b->triangles().size() > k_most_pairs;
  });
}

Judgement declined(const char* metric, const char* words) {
  Judgement judgement;
  judgement.findings.push_back({.verdict = Verdict::unsupported, .metric = metric, .unit = "1", .words = words});
  return judgement;
}

Judgement judge_case(const Case& member, const Subject& subject) {
  if (const auto* const rays = dynamic_cast<const RayAlgorithm*>(&subject.algorithm))
    return rays->judge_rays(member, subject.watch.asks);
  if (too_large(member, subject.algorithm)) return declined("size", "a check for small meshes");
  Traits traits = subject.algorithm.traits();
  if (traits.body == Body::convex_hull) {
    if (!member.convex) return declined("bodies", "they are not convex: their hulls are other bodies");
    traits.limits.distance_of_bodies = true;
  }
  return judge(member, traits, subject.prepare);
}

void note_time(StressCell& cell, const CaseId& id, const Judgement& judgement) {
  if (judgement.slowest_seconds <= cell.slowest_seconds) return;
  cell.slowest_seconds = judgement.slowest_seconds;
  cell.slow_shot = judgement.slowest_shot;
  cell.slow_id = id;
}

void add(StressCell& cell, const CaseId& id, const Judgement& judgement) {
  note_time(cell, id, judgement);
  const Finding& worst = judgement.worst();
  // Refusals say something only where there is nothing else.
  const bool refused = worst.verdict == Verdict::unsupported;
  if (refused) ++cell.unsupported;
  const bool first = cell.cases++ == 0, only_refusals = cell.unsupported == cell.cases;
  const bool worse =
      refused ? only_refusals : cell.worst.verdict == Verdict::unsupported || worst.worse_than(cell.worst);
  if (!first && !worse) return;
  cell.worst = worst;
  cell.id = id;
}

std::string mesh_file(const Mesh& mesh, const std::filesystem::path& folder) {
  constexpr std::size_t k_digits = 12;
  const std::filesystem::path file = folder / (mesh.hash().substr(0, k_digits) + ".off");
  if (!std::filesystem::exists(file)) save_mesh(mesh, file);
  return file.string();
}

/// The ray turned to z and B to the identity: the first configuration of the coarsest grid.
std::string reproduction_of_ray(const Case& member, const Shot& shot, const RayAlgorithm& algorithm,
                                const std::filesystem::path& folder) {
  const RayProblem ray = algorithm.problem(member.shots.front(), shot);
  const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(ray.direction, Eigen::Vector3d::UnitZ());
  const Mesh a = *transformed(*shot.a, {Eigen::Vector3d::Zero(), q});
  const Mesh b = *transformed(*shot.b, {Eigen::Vector3d::Zero(), (q * shot.X_AB.q).normalized()});
  const bool distances = algorithm.kind() == TargetKind::distance;
  std::string percents;
  for (const double target : ray.targets) {
    const double part = target / (distances ? a.diagonal() : std::abs(a.volume()));
    percents += fmt::format("{}{:.3f}", percents.empty() ? "" : ",", std::min(100.0, 100.0 * part));
  }
  return own_command(fmt::format("sixdof generate --a {} --b {} --grid 180 --{} {} -o rays.h5",
                                 shell_quoted(mesh_file(a, folder)), shell_quoted(mesh_file(b, folder)),
                                 distances ? "distances" : "volumes", percents));
}

}  // namespace

Case make_case(const Family& family, const CaseId& id) {
  if (id.field != CaseId::k_generated) return family.field_cases().at(id.field);
  Draw draw(id.genes);
  return family.make(draw);
}

Settings settings_of(const Algorithm& algorithm, StressSettings which) {
  return which == StressSettings::defaults ? algorithm.settings() : coarse_settings(algorithm);
}

bool has_finer_defaults(const Algorithm& algorithm) {
  return algorithm.settings().to_string() != coarse_settings(algorithm).to_string();
}

std::string StressCell::name() const {
  return algorithm->traits().name + (which == StressSettings::defaults ? " at defaults" : "");
}

StressCell run_cell(const Family& family, const Algorithm& algorithm, StressSettings which, const StressEffort& effort,
                    std::uint64_t seed, const StressWatch& watch) {
  const Subject subject(algorithm, which, watch);
  StressCell cell{.family = &family,
                  .algorithm = &algorithm,
                  .which = which,
                  .settings = subject.settings.to_string(),
                  .id = {},
                  .worst = {},
                  .slow_id = {}};
  const auto judge_announced = [&](const CaseId& id, const Case& member) {
    watch.begins_case(id);
    return judge_case(member, subject);
  };
  if (family.field_cases != nullptr) {
    const std::vector<Case> members = family.field_cases();
    for (std::size_t i = 0; i < members.size(); ++i) add(cell, {.field = i}, judge_announced({.field = i}, members[i]));
  }
  const JudgeCase judge_genes = [&](const Genes& genes, const Case& member) {
    return judge_announced({.genes = genes}, member);
  };
  const bool approximates = algorithm.traits().approximates;
  const std::size_t samples = approximates ? effort.declared_samples : effort.samples;
  Judged worst, slowest;
  for (std::size_t i = 0; i < samples; ++i) {
    Judged sample{.genes = sample_genes(family, seed, i, samples), .member = {}, .judgement = {}};
    Draw draw(sample.genes);
    sample.member = family.make(draw);
    sample.judgement = judge_genes(sample.genes, sample.member);
    add(cell, {.genes = sample.genes}, sample.judgement);
    if (i == 0 || worse_answer(sample.judgement, worst.judgement)) worst = sample;
    if (i == 0 || slower(sample.judgement, slowest.judgement)) slowest = sample;
  }
  // A check for small meshes must not be led to larger ones. What declares a resolution prepares for long.
  const std::size_t part = approximates ? 2 : 1;
  const bool searched = algorithm.traits().timed && which == StressSettings::coarsest;
  const std::size_t generations = searched ? effort.generations / part : 0;
  const std::size_t children = effort.children / part;
  worst = search_worst(family, std::move(worst), judge_genes, worse_answer, generations, children, seed);
  add(cell, {.genes = worst.genes}, worst.judgement);
  // What is slow depends on the machine's other work, so the search for it must not decide a verdict.
  slowest = search_worst(family, std::move(slowest), judge_genes, slower, generations, children, seed + 1);
  note_time(cell, {.genes = slowest.genes}, slowest.judgement);
  return cell;
}

namespace {

/// " --motion '...'", all digits.
std::string motion_option(const Motion& motion) {
  std::string numbers;
  for (const Eigen::Vector3d& v : {motion.translation, motion.rotation, motion.reference}) {
    for (const double x : v) numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", x);
  }
  return fmt::format(" --motion '{}'", numbers);
}

/// What a case asks besides the queries of a pose, as far as it is answered.
std::string asked_besides(const Case& member, const QuerySet& answers) {
  if (member.cast && answers.cast) return motion_option(*member.cast);
  return member.relation == stability::Relation::contacts && answers.contacts ? " --contacts 64" : "";
}

}  // namespace

std::string reproduction(const Case& member, std::size_t index, const Algorithm& algorithm, const Settings& settings,
                         const std::filesystem::path& folder) {
  const Shot& shot = member.shots.at(index);
  if (const auto* const rays = dynamic_cast<const RayAlgorithm*>(&algorithm))
    return reproduction_of_ray(member, shot, *rays, folder);
  std::string pose;
  const auto append = [&](double number) { pose += fmt::format("{}{}", pose.empty() ? "" : " ", number); };
  if (shot.raw) {
    for (int i = 0; i < 9; ++i) append(shot.raw->R(i / 3, i % 3));
    for (const double number : shot.raw->t) append(number);
  } else {
    const Eigen::Quaterniond& q = shot.X_AB.q;
    for (const double number : shot.X_AB.t) append(number);
    for (const double number : {q.w(), q.x(), q.y(), q.z()}) append(number);
  }
  return fmt::format("{} --pose '{}'{}",
                     bench::query_command(mesh_file(*shot.a, folder), mesh_file(*shot.b, folder), algorithm, settings),
                     pose, asked_besides(member, algorithm.traits().answers));
}

}  // namespace sixdof::study
