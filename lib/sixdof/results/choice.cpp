#include <sixdof/results/choice.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/results/fault.h>

namespace sixdof::results {
namespace {

/// Kinds of poses, and the counters of the judged and of the wrong answers to them.
struct Place {
  const char *words, *judged, *wrong;
};
constexpr Place k_apart{"apart", "judged_apart", "wrong_apart"};
constexpr Place k_near{"near contact", "judged_near", "wrong_near"};
constexpr Place k_overlapping{"overlapping", "judged_overlapping", "wrong_overlapping"};
constexpr Place k_contacts{"with a first contact", "hits", "missed_hits"};
constexpr std::array k_places{k_apart, k_near, k_overlapping};

/// What a verdict on a query needs.
std::vector<Place> needed(const std::string& query) {
  if (query == "collide") return {k_apart, k_near, k_overlapping};
  if (query == k_cast) return {k_contacts};
  return {query == "distance" ? k_apart : k_overlapping};
}

/// Why the rows cannot say anything; empty if they can. All rows are of the same poses, so the most judged counts.
std::string missing_poses(std::span<const Row> rows, const std::string& query) {
  if (std::ranges::none_of(rows, [](const Row& row) { return row.error.empty(); })) return {};  // nothing was judged
  const char* const what = query == k_cast ? "motions" : "poses";
  std::vector<std::string> lacking;
  for (const Place& place : needed(query)) {
    double most = 0.0;
    for (const Row& row : rows) most = std::max(most, row.count(place.judged));
    if (most < k_fewest_judged) {
      lacking.push_back(
          fmt::format("{:.0f} of the {:.0f} {} {} that it needs", most, k_fewest_judged, what, place.words));
    }
  }
  return lacking.empty() ? std::string() : fmt::format("there are {}", fmt::join(lacking, ", and "));
}

/// "12 of 2,100 wrong (near contact 12 of 500)"; empty for none.
std::string wrong_answers(const Row& row) {
  double judged = 0.0, wrong = 0.0;
  std::vector<std::string> where;
  for (const Place& place : k_places) {
    judged += row.count(place.judged);
    wrong += row.count(place.wrong);
    if (row.count(place.wrong) > 0.0) {
      where.push_back(fmt::format("{} {:.0f} of {:.0f}", place.words, row.count(place.wrong), row.count(place.judged)));
    }
  }
  if (wrong == 0.0) return {};
  return fmt::format("{:.0f} of {:.0f} answers wrong ({})", wrong, judged, fmt::join(where, ", "));
}

/// "12 of 2,100 contacts wrong (10 missed, 2 late)"; empty for none.
std::string wrong_casts(const Row& row) {
  constexpr std::pair<const char*, const char*> k_kinds[]{{"missed_hits", "missed"},
                                                          {"late_hits", "late"},
                                                          {"phantom_hits", "phantom"},
                                                          {"false_starts", "contact at the start"}};
  if (row.count("mismatch") == 0.0) return {};
  std::vector<std::string> texts;
  for (const auto& [counter, words] : k_kinds) {
    if (row.count(counter) > 0.0) texts.push_back(fmt::format("{:.0f} {}", row.count(counter), words));
  }
  return fmt::format("{:.0f} of {:.0f} contacts wrong ({})", row.count("mismatch"), row.count("judged"),
                     fmt::join(texts, ", "));
}

/// Why the row's answers may not be used at all; empty if they may.
std::string why_unsafe(const Row& row, const std::string& query) {
  if (query == k_cast) return wrong_casts(row);
  const bool approximates = row.fields.approximates;
  if (query == "collide" || (query == "distance" && !approximates)) return wrong_answers(row);
  const auto angle = row.value("gamma_F_deg");
  if (query == "respond" && angle && *angle >= k_useless_angle_deg) {
    return fmt::format("its forces are no better than a constant one: mean angle {:.0f} degrees", *angle);
  }
  return {};
}

/// How many waits were late, of as many as the row has queries, in the worst of the loops that asked nothing. Noise
/// changes from second to second, so a row may have met what another row's loop did; but longer waits meet more of it,
/// so only those of at most twice the row's median time count.
double idle_late(const Row& row, std::span<const Row> rows) {
  constexpr double k_longer = 2.0;
  double most = 0.0;
  for (const Row& other : rows) {
    const double timed = other.count("timed");
    if (timed == 0.0 || other.count("p50_ns") > k_longer * row.count("p50_ns")) continue;
    most = std::max(most, other.count("idle_late") / timed);
  }
  return most * row.count("timed");
}

/// Whether one count of rare events has clearly more of them than another: 95 % confidence, by the normal approximation
/// of the difference of the square roots of two Poisson variables, whose variances are 1/4.
bool clearly_more(double count, double other) { return std::sqrt(count) - std::sqrt(other) > 1.645 * std::sqrt(0.5); }

/// Judges a row by the deadline; gives no reason if it keeps it.
void judge_lateness(Candidate& candidate, double idle) {
  if (candidate.late <= k_most_late * candidate.timed) return;
  const bool clear = idle == 0.0 || clearly_more(candidate.late, idle);
  candidate.standing = clear ? Standing::late : Standing::undecided;
  candidate.reason = fmt::format("{:.0f} of {:.0f} queries late", candidate.late, candidate.timed);
  if (!clear) candidate.reason += fmt::format(", the loop that asks nothing up to {:.0f}", idle);
}

Candidate candidate_of(const Row& row, std::size_t place, const std::string& query, const std::string& error,
                       std::span<const Row> rows) {
  Candidate candidate{.place = place};
  if (!row.error.empty()) {
    constexpr std::string_view k_prefix = "left out: ";
    candidate.reason = row.error.starts_with(k_prefix) ? row.error.substr(k_prefix.size()) : row.error;
    return candidate;
  }
  candidate.late = row.count("late");
  candidate.timed = row.count("timed");
  candidate.mean_ns = row.estimate(k_wall_mean).value_or(Estimate{});
  candidate.error = row.estimate(error).value_or(Estimate{});
  const std::vector<Fault> faults = own_faults(row);
  if (!faults.empty()) {
    candidate.standing = Standing::faulty;
    candidate.reason = to_string(faults);
  } else if (!row.value(error) || candidate.timed == 0.0) {
    candidate.standing = Standing::faulty;
    candidate.reason = row.value(error) ? "no time could be measured" : "its error could not be measured";
  } else if (const std::string why = why_unsafe(row, query); !why.empty()) {
    candidate.standing = Standing::unsafe;
    candidate.reason = why;
  } else {
    candidate.standing = Standing::not_ranked;
    const bool has_error = query == "respond" || query == k_cast;
    const bool no_error = !has_error || candidate.error.value <= k_rounding;
    candidate.exact = !row.fields.approximates && no_error;
    const std::string interpreter = interpreter_of(row.fields);
    candidate.interpreted = !interpreter.empty();
    if (candidate.interpreted) candidate.reason = fmt::format("runs in {}: not ranked with compiled code", interpreter);
    judge_lateness(candidate, idle_late(row, rows));
  }
  return candidate;
}

/// How right a candidate is, the best first: answers that promise nothing after those that do, then the error.
auto rightness_of(const Candidate& candidate) {
  const double error = candidate.exact || candidate.error.value <= k_rounding ? 0.0 : candidate.error.value;
  return std::tuple(!candidate.exact, error);
}

/// The same, then the time.
auto rank_of(const Candidate& candidate) {
  return std::tuple_cat(rightness_of(candidate), std::tuple(candidate.mean_ns.value));
}

/// Why nothing can be taken for the noise of the machine: what keeps the deadline is less right than something that is
/// undecided, or nothing keeps it. Empty if something can.
std::string too_noisy(std::span<const Candidate> candidates, std::span<const Row> rows) {
  const Candidate *kept = nullptr, *undecided = nullptr;
  for (const Candidate& candidate : candidates) {
    if (candidate.interpreted) continue;
    const Candidate** const best = candidate.standing == Standing::not_ranked  ? &kept
                                   : candidate.standing == Standing::undecided ? &undecided
                                                                               : nullptr;
    if (best != nullptr && (*best == nullptr || rank_of(candidate) < rank_of(**best))) *best = &candidate;
  }
  if (undecided == nullptr || (kept != nullptr && rightness_of(*kept) <= rightness_of(*undecided))) return {};
  return fmt::format("the machine is too noisy for the deadline ({}: {})", rows[undecided->place].fields.algorithm,
                     undecided->reason);
}

/// Says of the candidates that keep the deadline which is taken, and what the others lack.
void judge_the_rest(std::vector<Candidate>& candidates) {
  Candidate* best = nullptr;
  const auto is_rankable = [](const Candidate& candidate) {
    return candidate.standing == Standing::not_ranked && !candidate.interpreted;
  };
  for (Candidate& candidate : candidates) {
    if (is_rankable(candidate) && (best == nullptr || rank_of(candidate) < rank_of(*best))) best = &candidate;
  }
  if (best == nullptr) return;
  for (Candidate& candidate : candidates) {
    if (!is_rankable(candidate) || &candidate == best) continue;
    const bool as_right = candidate.exact == best->exact && (candidate.exact || overlap(candidate.error, best->error));
    if (!as_right) {
      candidate.standing = Standing::less_right;
      candidate.reason = candidate.exact == best->exact ? "larger error" : "approximate";
    } else if (overlap(candidate.mean_ns, best->mean_ns)) {
      candidate.standing = Standing::tied;
      candidate.reason = "its time does not differ clearly";
    } else {
      candidate.standing = Standing::slower;
      candidate.reason = fmt::format("takes {:.3g} times as long", candidate.mean_ns.value / best->mean_ns.value);
    }
  }
  best->standing = Standing::taken;
}

}  // namespace

std::string_view to_string(Standing standing) {
  constexpr std::string_view k_names[] = {"taken",     "tied", "slower", "less right", "not ranked",
                                          "undecided", "late", "unsafe", "faulty",     "left out"};
  return k_names[static_cast<std::size_t>(standing)];
}

const Candidate* Choice::taken() const {
  return !candidates.empty() && candidates.front().standing == Standing::taken ? &candidates.front() : nullptr;
}

Choice choose(std::span<const Row> rows, const std::string& query, const std::string& error) {
  Choice choice{.candidates = {}, .missing = missing_poses(rows, query)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    choice.candidates.push_back(candidate_of(rows[i], i, query, error, rows));
  }
  if (choice.missing.empty()) choice.missing = too_noisy(choice.candidates, rows);
  if (choice.missing.empty()) judge_the_rest(choice.candidates);
  std::ranges::stable_sort(choice.candidates, {}, [](const Candidate& candidate) {
    return std::tuple_cat(std::tuple(candidate.standing), rank_of(candidate));
  });
  return choice;
}

double most_wrong(double count) { return count > 0.0 ? std::min(1.0, 3.0 / count) : 1.0; }

}  // namespace sixdof::results
