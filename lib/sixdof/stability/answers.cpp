#include <sixdof/stability/answers.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>

#include <sixdof/base/error.h>
#include <sixdof/query/ask.h>

namespace sixdof::stability {
namespace {

template <class T>
void ask_one(Query& query, bool asked, Outcome<T> (Query::*question)(const Pose&), const Pose& X_AB, Asked<T>& result,
             Answers& answers) {
  if (!asked) return;
  const auto note = [&](const std::string& words) { result.words = words; };
  const auto begin = std::chrono::steady_clock::now();
  const double cpu = thread_seconds();
  result.outcome = ask_guarded([&] { return (query.*question)(X_AB); }, note);
  answers.seconds = std::max(answers.seconds, thread_seconds() - cpu);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  answers.wall_seconds = std::max(answers.wall_seconds, wall.count());
  if (result.words.empty()) examine(query, result.outcome, note);
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Settings coarse_settings(const Algorithm& algorithm) {
  Settings settings = algorithm.settings();
  if (!algorithm.traits().approximates) return settings;
  for (const Parameter& parameter : algorithm.traits().parameters) {
    if (!parameter.sweep.empty()) settings.set(parameter.name, parameter.sweep.front());
  }
  return settings;
}

Answers ask(Query& query, const QuerySet& kinds, const Pose& X_AB) {
  Answers answers;
  ask_one(query, kinds.collide, &Query::collide, X_AB, answers.collide, answers);
  ask_one(query, kinds.distance, &Query::distance, X_AB, answers.distance, answers);
  ask_one(query, kinds.respond, &Query::respond, X_AB, answers.respond, answers);
  return answers;
}

double declared_resolution(const Query& query) {
  for (const auto& [name, value] : query.footprint().counts) {
    if (name == "resolution") return value;
  }
  return 0.0;
}

PreparedPairs::Pair& PreparedPairs::pair_of(const Shot& shot) {
  for (Pair& pair : pairs_) {
    if (pair.a == shot.a && pair.b == shot.b) return pair;
  }
  Pair& pair = pairs_.emplace_back(Pair{shot.a, shot.b, nullptr, 0.0, {}});
  try {
    pair.query = prepare_(*shot.a, *shot.b);
    if (approximates_) pair.resolution = declared_resolution(*pair.query);
  } catch (const BadMesh& e) {
    pair.failure.refused = true;
    pair.failure.words = e.what();
  } catch (const BadArgument& e) {
    pair.failure.refused = true;
    pair.failure.words = e.what();
  } catch (const std::exception& e) {
    pair.failure.prepare_threw = true;
    pair.failure.words = e.what();
  }
  return pair;
}

Answers PreparedPairs::ask(const Shot& shot) {
  Pair& pair = pair_of(shot);
  if (!pair.query) return pair.failure;
  Answers answers = stability::ask(*pair.query, kinds_, shot.pose());
  answers.resolution = pair.resolution;
  return answers;
}

}  // namespace sixdof::stability
