#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row.h>

/// Which algorithm, with which parameters, keeps a deadline with right answers or, where no right ones keep it, with
/// the smallest error: the verdict of `sixdof recommend`.
///
/// Rules, by rows of `sixdof precision`:
/// - A row counts only if every query was answered (fault.h).
/// - One first contact that is missed, late, phantom or wrongly at the start is unsafe; an early one is an error.
/// - An algorithm that does not approximate (RowFields::approximates) promises right answers: one wrong answer makes it
///   unsafe. So does one wrong yes/no of any algorithm, and forces that are no better than a constant one.
/// - A deadline is kept if at most k_most_late of the queries were late as they came, in one pass. More are held
/// against
///   an algorithm only if they are clearly more than those of a loop that asked nothing (counter idle_late). Otherwise
///   nothing is said of it, and nothing that has larger errors is taken in its place.
/// - Of those that keep it, answers without an error (above k_rounding) win, then the smallest error. Approximations
///   come after those that promise right answers, also where none of their answers was wrong. Of equal ones the fastest
///   wins; those whose times do not differ clearly are tied with it.
/// - Interpreted algorithms (interpreter_of()) are not ranked: their times hold calls that a user's program need not
///   make.
/// - Without enough judged poses there is no verdict.

namespace sixdof::results {

inline constexpr double k_most_late = 0.001;
inline constexpr double k_fewest_judged = 30;  ///< Of each kind of pose that a verdict needs.
/// Mean angle to the exact force in degrees from which forces say nothing: a constant one has 90 over all directions.
inline constexpr double k_useless_angle_deg = 60.0;

enum class Standing {
  taken,
  tied,        ///< As good as the one that is taken, and not clearly slower.
  slower,      ///< As right, but slower.
  less_right,  ///< Keeps the deadline with larger errors.
  not_ranked,  ///< Keeps the deadline, but there is no verdict, or it is interpreted.
  undecided,   ///< Misses the deadline not clearly more often than the machine does without it.
  late,        ///< Misses the deadline.
  unsafe,      ///< Wrong answers.
  faulty,      ///< Queries without an answer.
  left_out     ///< Not measured.
};

/// "taken", "tied", "slower", "less right", "not ranked", "undecided", "late", "unsafe", "faulty",
/// "left out".
std::string_view to_string(Standing standing);

struct Candidate {
  std::size_t place = 0;  ///< Among the rows.
  Standing standing = Standing::left_out;
  bool interpreted = false;
  bool exact = false;              ///< Promises right answers and gave no wrong one.
  Estimate error;                  ///< The metric.
  Estimate mean_ns;                ///< Wall time of a query, in a loop over all.
  double late = 0.0, timed = 0.0;  ///< Queries over the deadline in one pass, of how many.
  std::string reason;              ///< Why it stands so, in words.
};

struct Choice {
  std::vector<Candidate> candidates;  ///< The one that is taken first, then by standing, error and time.
  std::string missing;                ///< Why there is no verdict; empty if there is one.

  const Candidate* taken() const;
};

/// @param query "collide", "distance", "respond" or "cast"; @param error the metric that is to be small
Choice choose(std::span<const Row> rows, const std::string& query, const std::string& error);

/// An upper bound, with 95 % confidence, on the share of wrong answers where 0 of `count` were wrong (rule of three).
double most_wrong(double count);

}  // namespace sixdof::results
