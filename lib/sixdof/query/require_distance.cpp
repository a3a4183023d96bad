#include <sixdof/query/require_distance.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

void require_distance_queries(const Algorithm& algorithm) {
  if (algorithm.traits().answers.distance) return;
  throw BadArgument(fmt::format("algorithm {}: answers no distance queries", algorithm.traits().name));
}

Separation require_distance(Query& query, const std::string& name, const Pose& X_AB) {
  const Outcome<Separation> answer = query.distance(X_AB);
  if (answer.ok()) return answer.value;
  throw Error(fmt::format("{}: distance {}: {}", name, to_string(answer.status), query.diagnosis()));
}

}  // namespace sixdof
