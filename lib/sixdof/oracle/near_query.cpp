#include <sixdof/oracle/near_query.h>

#include <cmath>
#include <utility>

#include <sixdof/oracle/far_pair.h>

namespace sixdof {

template <class Ask>
auto NearQuery::with_search(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, const Ask& ask) {
  detail::DistanceSearch search{std::move(scratch_), *a.body_, *b.body_, X_AB};
  search.ties = detail::TieWindow::of(search.a, search.b, X_AB);
  search.measured.clear();
  const auto answer = ask(search);
  scratch_ = std::move(static_cast<detail::DistanceScratch&>(search));
  counts_.nodes += search.counts.nodes;
  counts_.leaf_pairs += search.counts.leaf_pairs;
  counts_.triangles += search.counts.triangles;
  return answer;
}

std::optional<double> NearQuery::distance(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, double limit,
                                          NearHint& hint) {
  return with_search(a, b, X_AB, [&](detail::DistanceSearch& s) -> std::optional<double> {
    // The answer may exceed the smallest distance by the width of ties.
    s.best = limit + s.ties.width;
    if (detail::are_far(s.a, s.b, X_AB)) {
      detail::take_far_pair(s);
    } else {
      if (hint.known()) detail::try_update(s, hint.triangles);
      if (!s.found && std::isinf(limit)) detail::seed_search(s);
      if (!(s.found && s.best == 0.0)) detail::find_pair(s, false);
    }
    if (!s.found) return std::nullopt;
    const double distance = detail::points_of(s).distance;
    if (!(distance <= limit)) return std::nullopt;
    hint.triangles = s.pair;
    return distance;
  });
}

bool NearQuery::surfaces_meet(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, NearHint& hint) {
  return with_search(a, b, X_AB, [&](detail::DistanceSearch& s) {
    if (detail::are_far(s.a, s.b, X_AB)) return false;
    if (hint.known() && detail::intersects(s, hint.triangles)) {
      ++s.counts.triangles;
      return true;
    }
    detail::find_pair(s, true);
    if (s.found) hint.triangles = s.pair;
    return s.found;
  });
}

bool NearQuery::are_far(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB) {
  return detail::are_far(*a.body_, *b.body_, X_AB);
}

}  // namespace sixdof
