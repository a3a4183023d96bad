#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <sixdof/configuration/bucket.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/guarded_query.h"

namespace sixdof::bench {

/// What a row or a study asks an algorithm.
enum class Question {
  collide,
  distance,
  respond
};

inline constexpr std::array<Question, 3> k_questions{Question::collide, Question::distance, Question::respond};

constexpr std::string_view to_string(Question question) {
  constexpr std::string_view k_names[] = {"collide", "distance", "respond"};
  return k_names[static_cast<std::size_t>(question)];
}

/// Whether an algorithm of these answers can be asked.
constexpr bool answers(const QuerySet& set, Question question) {
  return question == Question::collide ? set.collide : question == Question::distance ? set.distance : set.respond;
}

/// Whether a bucket's configurations are asked: the distance of overlapping bodies is 0 by definition, and bodies that
/// only touch have no force.
inline bool suits(BucketKey key, Question question) {
  if (question == Question::distance) return key.kind == BucketKind::distance;
  if (question == Question::respond) return key.kind == BucketKind::volume && key.percent > 0;
  return true;
}

/// Calls use(GuardedQuery) with this question. @param failures counts configurations without an answer
template <class Use>
void with_question(Query& query, Question question, Failures& failures, Use use) {
  if (question == Question::collide) {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.collide(pose); }, failures));
  } else if (question == Question::distance) {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.distance(pose); }, failures));
  } else {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.respond(pose); }, failures));
  }
}

}  // namespace sixdof::bench
