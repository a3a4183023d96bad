#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/measure/contact_score.h>
#include <sixdof/measure/direction.h>
#include <sixdof/query/ask.h>
#include <sixdof/query/contacts.h>
#include "bench/harness/check.h"
#include "bench/harness/motion.h"
#include "bench/harness/query_command.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Contacts that are asked for: more than libraries find on the pairs of the sets.
constexpr std::size_t k_most_contacts = 16'384;

/// Configurations whose contacts are judged at most, and those of them that are asked again with A and B exchanged and
/// after a motion: exact geometry takes longer than most libraries.
constexpr std::size_t k_most_judged = 64;
constexpr std::size_t k_most_changed = 16;
/// Of the poses of a motion every so-many-th is judged; all of them are compared with the one before.
constexpr std::size_t k_judged_steps = 16;

/// Configurations of a trial, and seconds to judge one.
constexpr std::size_t k_trial = 4;
constexpr double k_judging_seconds = 0.02;

/// Behind a command line that asks at one configuration.
constexpr const char* k_asks_contacts = " --contacts 64";

/// A rigid motion of a body of some size, with a rotation about no axis of symmetry.
Pose scene_motion(double diagonal) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.46, -0.31, 0.67, 0.49).normalized();
  return {q.toRotationMatrix(), diagonal * Eigen::Vector3d(0.37, -0.59, 0.83)};
}

Mesh moved(const Mesh& mesh, const Pose& X) {
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3d& p : mesh.vertices()) vertices.push_back(X * p);
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name());
}

/// The counter whose configuration is drawn with its contacts.
constexpr const char* k_pictured = "contact_normal_max_deg";

/// Contacts and segments that a picture has at most.
constexpr std::size_t k_most_drawn_contacts = 64, k_most_segments = 256;

/// Evenly from all of them.
results::ContactPicture picture(const Contacts& contacts, const ContactTruth& truth) {
  const double unit = std::pow(10.0, 6.0 - std::floor(std::log10(truth.diagonal())));
  const auto both = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, double unit_q) {
    std::array<double, 6> numbers{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      numbers[k] = std::round(unit * p[axis]) / unit;
      numbers[k + 3] = std::round(unit_q * q[axis]) / unit_q;
    }
    return numbers;
  };
  results::ContactPicture drawn;
  const std::size_t count = std::min(contacts.list.size(), k_most_drawn_contacts);
  for (std::size_t i = 0; i < count; ++i) {
    const Contact& each = contacts.list[i * contacts.list.size() / count];
    constexpr double k_normal_unit = 1e4;
    drawn.contacts.push_back(both(each.point, each.normal, k_normal_unit));
  }
  const std::size_t segments = std::min(truth.curve().size(), k_most_segments);
  for (std::size_t i = 0; i < segments; ++i) {
    const Segment& each = truth.curve()[i * truth.curve().size() / segments];
    drawn.curve.push_back(both(each.start, each.end, unit));
  }
  return drawn;
}

/// What the first call of a row found.
struct Found {
  ContactScores scores;
  std::size_t asked = 0, failed = 0, full = 0;
  std::array<std::size_t, k_counted_statuses.size()> statuses{};
  std::size_t non_finite = 0;
  std::string first_failure;
  std::vector<Pose> answered;
  Latency latency, least;
  results::Outliers worst;
};

struct ContactRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  BucketKey key;
  bool is_motion;
  std::optional<Found> found = {};

  std::string name() const {
    std::string bucket = key.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("contacts/algorithm:{}/pair:{}/{}{}", algorithm.traits().name, pair.pair, bucket,
                       is_motion ? "/order:motion" : "");
  }
  results::RowFields fields() const {
    return {.query = "contacts",
            .algorithm = algorithm.traits().name,
            .settings = resources.settings_of(algorithm).to_string(),
            .pair = pair.pair,
            .bucket = key,
            .order = is_motion ? "motion" : "random",
            .runtime = algorithm.traits().runtime,
            .cache = "warm",
            .isolated = is_isolated(algorithm),
            .approximates = algorithm.traits().approximates};
  }

  void run(benchmark::State& state, const Share& share) {
    require_solids(mesh(pair.a), mesh(pair.b));
    if (!found) find(poses(share.configurations));
    if (found->answered.empty()) throw Error(fmt::format("no configuration has an answer: {}", found->first_failure));
    Query& query = prepared();
    time_rounds(state, found->answered.size(), query,
                [&](std::size_t i) { return ask_timed(query, found->answered[i]); });
    report(state);
  }

  double trial(double seconds) {
    Query& query = prepared();
    const std::vector<Pose> first = poses(k_trial);
    const double one = seconds_of_one(std::span(first).first(std::min(first.size(), k_trial)), seconds,
                                      [&](const Pose& pose) { return ask_timed(query, pose); });
    // In the check, the timed round, the passes, and twice after a change.
    return one > 0.0 ? (4.0 + k_latency_passes) * one + k_judging_seconds : 0.0;
  }

  /// PlannedRow::outliers.
  results::Outliers outliers() const { return found ? found->worst : results::Outliers(); }

 private:
  const Mesh& mesh(const std::string& name) const { return resources.cache.mesh(name); }
  const Settings& settings() const { return resources.settings_of(algorithm); }
  Query& prepared() const { return resources.cache.query(algorithm, settings(), pair.a, pair.b); }

  static Outcome<Contacts> ask_timed(Query& query, const Pose& X_AB) {
    return ask_guarded([&] { return query.contacts(X_AB, k_most_contacts); }, [](const std::string&) {});
  }

  /// The first configurations of the bucket; of a row of motions as many poses along motions from some of them.
  std::vector<Pose> poses(std::size_t most) const {
    const BucketSample& bucket = resources.cache.bucket(pair, key);
    if (bucket.poses.empty()) throw BadArgument(key.name() + ": no configuration of this bucket can be reached");
    const std::size_t count = std::min(most, bucket.poses.size());
    const std::span<const Pose> first = std::span(bucket.poses).first(count);
    if (!is_motion) return {first.begin(), first.end()};
    const std::size_t motions = (count + Motion::k_poses - 1) / Motion::k_poses;
    return poses_of_motions(first.first(motions), Motion::k_poses, mesh(pair.a), mesh(pair.b), resources.seed);
  }

  /// Asks and judges every pose, then times those with an answer.
  void find(const std::vector<Pose>& poses) {
    found.emplace();
    found->asked = poses.size();
    const auto word_of = [&](const std::string& name) {
      const CatalogueMesh* const each = resources.catalogue.mesh(name);
      return each == nullptr || each->identity.path.empty() ? name : each->identity.path;
    };
    found->worst.a = word_of(pair.a);
    found->worst.b = word_of(pair.b);
    found->worst.command = query_command(found->worst.a, found->worst.b, algorithm, settings()) + k_asks_contacts;
    Query& query = prepared();
    std::vector<Contacts> answers;
    for (const Pose& X_AB : poses) {
      Outcome<Contacts> answer = ask_contacts(query, X_AB, k_most_contacts, [&](const std::string& words) {
        if (found->first_failure.empty()) found->first_failure = words;
      });
      if (answer.ok()) {
        found->full += answer.value.list.size() == k_most_contacts ? 1 : 0;
        found->answered.push_back(X_AB);
        answers.push_back(std::move(answer.value));
        continue;
      }
      count_failure(answer.status, X_AB);
    }
    is_motion ? judge_motion(answers, query) : judge(answers, query);
    time_each(prepared());
  }

  void count_failure(Status status, const Pose& X_AB) {
    if (found->failed++ == 0) found->worst.add("failed", X_AB);
    found->non_finite += status == Status::non_finite ? 1 : 0;
    for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
      found->statuses[k] += status == k_counted_statuses[k] ? 1 : 0;
    }
  }

  void judge(const std::vector<Contacts>& answers, const Query& query) {
    ContactTruth truth(mesh(pair.a), mesh(pair.b));
    const double resolution = resolution_of(algorithm, query);
    double largest_off = -1.0, largest_angle = -1.0;
    for (std::size_t i = 0; i < std::min(answers.size(), k_most_judged); ++i) {
      truth.move_to(found->answered[i]);
      const ContactScore score = score_contacts(answers[i], truth, resolution);
      found->scores.add(score);
      if (score.is_faulty() && found->scores.faulty() == 1) found->worst.add("mismatch", found->answered[i]);
      if (score.off_max > largest_off) found->worst.add("contact_off_max", found->answered[i]);
      if (score.normal_max > largest_angle) {
        found->worst.add(k_pictured, found->answered[i]);
        found->worst.contacts[k_pictured] = picture(answers[i], truth);
      }
      largest_off = std::max(largest_off, score.off_max);
      largest_angle = std::max(largest_angle, score.normal_max);
    }
    compare(answers);
  }

  /// With A and B exchanged, and after a rigid motion of both.
  void compare(const std::vector<Contacts>& answers) {
    const Mesh &a = mesh(pair.a), &b = mesh(pair.b);
    const std::size_t count = std::min(answers.size(), k_most_changed);
    const auto contacts_of = [](Query& query, const Pose& X) {
      return ask_contacts(query, X, k_most_contacts, [](const std::string&) {});
    };
    {
      const auto exchanged_query = resources.cache.prepare(algorithm, settings(), b, a);
      for (std::size_t i = 0; i < count; ++i) {
        const Pose& X_AB = found->answered[i];
        const Outcome<Contacts> back = contacts_of(*exchanged_query, X_AB.inverse());
        if (back.ok()) {
          found->scores.add_exchange(compare_contacts(answers[i], exchanged(back.value, X_AB), a.diagonal()));
        } else {
          found->scores.add_exchange(std::nullopt);
        }
      }
    }
    const Pose X = scene_motion(a.diagonal());
    const Mesh moved_a = moved(a, X), moved_b = moved(b, X);
    const auto moved_query = resources.cache.prepare(algorithm, settings(), moved_a, moved_b);
    for (std::size_t i = 0; i < count; ++i) {
      const Outcome<Contacts> there = contacts_of(*moved_query, X * found->answered[i] * X.inverse());
      if (there.ok()) {
        found->scores.add_motion(compare_contacts(answers[i], sixdof::moved(there.value, X.inverse()), a.diagonal()));
      } else {
        found->scores.add_motion(std::nullopt);
      }
    }
  }

  /// Each pose against the one before on the same motion. @pre poses that gave no answer are few
  void judge_motion(const std::vector<Contacts>& answers, const Query& query) {
    const Mesh &a = mesh(pair.a), &b = mesh(pair.b);
    ContactTruth truth(a, b);
    const double resolution = resolution_of(algorithm, query), longest_step = 4.0 * Motion::k_step * a.diagonal();
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), center = force;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      truth.move_to(found->answered[i]);
      if (i % k_judged_steps == 0) found->scores.add(score_contacts(answers[i], truth, resolution));
      const Eigen::Vector3d next_force = truth.force_direction(), next_center = truth.overlap().centroid;
      const bool follows =
          i > 0 && (found->answered[i] * b.center() - found->answered[i - 1] * b.center()).norm() <= longest_step;
      if (follows && next_center.allFinite() && center.allFinite()) {
        found->scores.add_step(compare_contacts(answers[i - 1], answers[i], a.diagonal()),
                               angle_degrees(force, next_force), (next_center - center).norm() / a.diagonal());
      }
      force = next_force;
      center = next_center;
    }
  }

  void time_each(Query& query) {
    const std::vector<Pose>& answered = found->answered;
    const PassTimes times =
        time_singles(answered.size(), query, [&](std::size_t i) { return ask_timed(query, answered[i]); });
    found->latency = sixdof::latency(times.once_ns);
    found->least = sixdof::latency(times.least_ns);
  }

  void report(benchmark::State& state) const {
    const auto count = [&](std::string_view name, auto value) {
      state.counters[std::string(name)] = static_cast<double>(value);
    };
    count("configurations", found->asked);
    count("failed", found->failed);
    for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
      if (found->statuses[k] > 0) count(to_string(k_counted_statuses[k]), found->statuses[k]);
    }
    count("non_finite", found->non_finite);
    count("judged", found->scores.scored());
    count("mismatch", found->scores.faulty());
    count("full_answers", found->full);
    found->scores.for_each([&](std::string_view counter, double value) { count(counter, value); });
    count("p50_ns", found->latency.p50);
    if (found->latency.p99) count("p99_ns", *found->latency.p99);
    count("max_ns", found->latency.max);
    count("max_least_ns", found->least.max);
    std::string label = settings().to_string();
    label += fmt::format("{}depth of {}", label.empty() ? "" : "; ", to_string(algorithm.traits().depth));
    if (!found->first_failure.empty()) label += fmt::format("; first failure: {}", found->first_failure);
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<PlannedRow> contact_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const BucketKey key : pair.buckets) {
      if (key.kind != BucketKind::volume || !(key.percent > 0.0)) continue;
      for (const auto& algorithm : resources.registry.all()) {
        const Traits& traits = algorithm->traits();
        if (!traits.timed || !traits.answers.contacts || traits.body != Body::mesh) continue;
        for (const bool is_motion : {false, true}) {
          const auto row = std::make_shared<ContactRow>(ContactRow{resources, *algorithm, pair, key, is_motion});
          rows.push_back({.name = row->name(),
                          .run = [row](benchmark::State& state, const Share& share) { row->run(state, share); },
                          .fields = row->fields(),
                          .trial = [row](double seconds) { return row->trial(seconds); },
                          .outliers = [row] { return row->outliers(); },
                          .manual_time = is_isolated(*algorithm)});
        }
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
