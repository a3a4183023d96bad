#pragma once

#include <string>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// For callers that measure with an algorithm and cannot go on without an answer.
/// @throws BadArgument if the algorithm answers no distance queries
void require_distance_queries(const Algorithm& algorithm);

/// @param name of the algorithm, for the message
/// @throws Error with the status and the query's diagnosis if there is no distance
Separation require_distance(Query& query, const std::string& name, const Pose& X_AB);

}  // namespace sixdof
