#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <sixdof/configuration/bucket.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/guarded_query.h"

namespace sixdof::bench {

/// What a row or a study asks an algorithm.
enum class QueryKind {
  collide,
  distance,
  respond
};

inline constexpr std::array<QueryKind, 3> k_query_kinds{QueryKind::collide, QueryKind::distance, QueryKind::respond};

constexpr std::string_view to_string(QueryKind kind) {
  constexpr std::string_view k_names[] = {"collide", "distance", "respond"};
  return k_names[static_cast<std::size_t>(kind)];
}

/// Whether an algorithm of these answers can be asked.
constexpr bool answers(const QuerySet& set, QueryKind kind) {
  return kind == QueryKind::collide ? set.collide : kind == QueryKind::distance ? set.distance : set.respond;
}

/// Whether a bucket's configurations are asked: the distance of overlapping bodies is 0 by definition, and bodies that
/// only touch have no force.
inline bool suits(BucketKey key, QueryKind kind) {
  if (kind == QueryKind::distance) return key.kind == BucketKind::distance;
  if (kind == QueryKind::respond) return key.kind == BucketKind::volume && key.percent > 0;
  return true;
}

/// Whether rows ask them: also responses of bodies that are apart, for their time and for forces that are none.
inline bool has_row(BucketKey key, QueryKind kind) {
  return suits(key, kind) || (kind == QueryKind::respond && key.kind == BucketKind::distance);
}

/// Calls use(GuardedQuery) with queries of this kind. @param failures counts configurations without an answer
template <class Use>
void with_query_kind(Query& query, QueryKind kind, Failures& failures, Use use) {
  if (kind == QueryKind::collide) {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.collide(pose); }, failures));
  } else if (kind == QueryKind::distance) {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.distance(pose); }, failures));
  } else {
    use(GuardedQuery(
        query, [&query](const Pose& pose) { return query.respond(pose); }, failures));
  }
}

}  // namespace sixdof::bench
