#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/query/algorithm.h>

/// For callers of queries: an exception or a NaN becomes one failed configuration with a message.

namespace sixdof {

/// A yes or no always is.
inline bool is_finite(bool) { return true; }
/// Of the distance; witnesses are not looked at.
inline bool is_finite(const Separation& answer) { return std::isfinite(answer.distance); }
/// A volume may be absent, which is NaN.
inline bool is_finite(const Response& answer) {
  return std::isfinite(answer.penalty) && !std::isinf(answer.volume) && answer.force.allFinite() &&
         answer.torque.allFinite() && answer.reference.allFinite();
}
/// Of the time; points and normal are not looked at.
inline bool is_finite(const Impact& answer) { return !answer.hit || std::isfinite(answer.t); }

/// Of points, normals and depths.
inline bool is_finite(const Contacts& answer) {
  return std::ranges::all_of(answer.list, [](const Contact& each) {
    return each.point.allFinite() && each.normal.allFinite() && std::isfinite(each.depth);
  });
}

/// Largest difference of a normal's length from 1: libraries in single precision normalise by estimates.
inline constexpr double k_unit_normal_tolerance = 1e-3;

/// Why a finite answer is none, in words; null if it is one.
template <class T>
const char* why_no_answer(const T&) {
  return nullptr;
}
/// The time is from 0 to 1.
inline const char* why_no_answer(const Impact& answer) {
  if (!answer.hit || (answer.t >= 0.0 && answer.t <= 1.0)) return nullptr;
  return "the time of impact is not from 0 to 1";
}

/// Normals are unit vectors.
inline const char* why_no_answer(const Contacts& answer) {
  const bool all_unit = std::ranges::all_of(
      answer.list, [](const Contact& each) { return std::abs(each.normal.norm() - 1.0) <= k_unit_normal_tolerance; });
  return all_unit ? nullptr : "a contact's normal is no unit vector";
}

/// The Outcome of ask(). An exception becomes Status::failed, or Status::out_of_memory where it is std::bad_alloc, and
/// calls failed(visible words); without one it costs nothing.
template <class Ask, class Failed>
auto ask_guarded(Ask&& ask, const Failed& failed) -> decltype(ask()) {
  try {
    return ask();
  } catch (const std::bad_alloc& e) {
    failed(visible_words(e.what()));
    return Status::out_of_memory;
  } catch (const std::exception& e) {
    failed(visible_words(e.what()));
  } catch (...) {
    failed("an exception of unknown type was thrown");
  }
  return Status::failed;
}

/// Turns an answer of `query` that holds a NaN or an infinity into Status::non_finite, and one that is none
/// (why_no_answer()) into Status::failed. Calls failed(words) for an answer that is not ok.
template <class T, class Failed>
void examine(const Query& query, Outcome<T>& answer, const Failed& failed) {
  if (answer.ok() && !is_finite(answer.value)) {
    answer = Status::non_finite;
    failed("the answer is not finite");
  } else if (const char* const why = answer.ok() ? why_no_answer(answer.value) : nullptr; why != nullptr) {
    answer = Status::failed;
    failed(why);
  } else if (!answer.ok()) {
    failed(answer.status == Status::unsupported ? "the algorithm gives no such answer" : query.diagnosis());
  }
}

/// Asks for contacts as ask_guarded() and examine() do. More of them than `most` are no answer.
template <class Failed>
Outcome<Contacts> ask_contacts(Query& query, const Pose& X_AB, std::size_t most, const Failed& failed) {
  bool has_words = false;
  const auto keep = [&](const std::string& words) {
    if (!has_words) failed(words);
    has_words = true;
  };
  Outcome<Contacts> answer = ask_guarded([&] { return query.contacts(X_AB, most); }, keep);
  examine(query, answer, keep);
  if (answer.ok() && answer.value.list.size() > most) {
    answer = Status::failed;
    failed(fmt::format("more contacts than the {} that were asked for", most));
  }
  return answer;
}

/// @throws BadArgument if the algorithm answers no distance queries
inline void require_distance_queries(const Algorithm& algorithm) {
  if (algorithm.traits().answers.distance) return;
  throw BadArgument(fmt::format("algorithm {}: answers no distance queries", algorithm.traits().name));
}

/// For callers that cannot go on without an answer.
/// @param name of the algorithm, for the message
/// @throws Error with the status and the query's diagnosis if there is no distance
inline Separation require_distance(Query& query, const std::string& name, const Pose& X_AB) {
  const Outcome<Separation> answer = query.distance(X_AB);
  if (answer.ok()) return answer.value;
  throw Error(fmt::format("{}: distance {}: {}", name, to_string(answer.status), query.diagnosis()));
}

}  // namespace sixdof
