#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <sixdof/base/error.h>
#include <sixdof/query/algorithm.h>

/// The lines that this program and the process of an algorithm exchange, each a JSON object; README.md describes them.
/// Numbers keep all bits of a double.

namespace sixdof::protocol {

inline constexpr int k_version = 1;

/// Poses of one Time request at most: its line stays below a few megabytes.
inline constexpr std::size_t k_most_poses = 4096;

/// A line that cannot be read, or lacks something.
struct Malformed : Error {
  using Error::Error;
};

/// The kind of query that has an Answer.
template <class Answer>
inline constexpr std::string_view k_query;
template <>
inline constexpr std::string_view k_query<bool> = "collide";
template <>
inline constexpr std::string_view k_query<Separation> = "distance";
template <>
inline constexpr std::string_view k_query<Response> = "respond";
template <>
inline constexpr std::string_view k_query<Impact> = "cast";
template <>
inline constexpr std::string_view k_query<Contacts> = "contacts";

// Requests.

struct Hello {};

/// Where a mesh is: vertices as float64, triangles as uint32, three of each, in the order of the machine.
struct MeshPlace {
  std::string name, vertices, triangles;  ///< Name of the mesh, paths of files.
  std::size_t vertex_count = 0, triangle_count = 0;
};

struct Prepare {
  MeshPlace a, b;
  std::vector<std::pair<std::string, std::string>> settings;  ///< Every parameter of the algorithm with its value.
  std::string progress;  ///< File of 8 bytes: how many queries of a Time request have begun.
};

struct Ask {
  std::string query;
  Pose X_AB;                          ///< Of a cast the start of the motion.
  std::optional<Motion> motion = {};  ///< Of a cast.
  std::size_t most = 0;               ///< Of contacts: how many at most.
};

/// Asks the poses in order, `passes` times. Not for casts and contacts.
struct Time {
  std::string query;
  std::vector<Pose> poses;
  std::size_t passes = 1;
  bool each = false;            ///< Times of single queries instead of those of all passes together.
  std::size_t evict_bytes = 0;  ///< Before each query a buffer of this size is read.
};

using Request = std::variant<Hello, Prepare, Ask, Time>;

std::string to_line(const Request& request);
/// @throws Malformed
Request request_of(const std::string& line);

// Replies.

struct Greeting {
  Traits traits;
  bool times = false;     ///< Understands Time.
  bool progress = false;  ///< Counts in Prepare::progress.
  bool again = false;     ///< May prepare another pair in place of the one before.
};

/// What Prepare has made.
struct Prepared {
  std::optional<double> wall_ns, cpu_ns;
  Footprint footprint;
};

/// Why a request cannot be honoured.
struct Refusal {
  enum class Kind {
    other,
    bad_mesh,
    bad_argument
  };
  Kind kind = Kind::other;
  std::string words;
};

template <class Answer>
struct Asked {
  Outcome<Answer> outcome;
  std::string words;         ///< Of an outcome that is not ok.
  std::optional<double> ns;  ///< Wall time of the query.
  std::vector<Work> work;
};

/// A query of a Time request that gave no answer.
struct Failed {
  std::size_t place = 0;  ///< Of its pose.
  Status status = Status::failed;
  std::string words;
};

/// What Time has measured.
struct Timed {
  std::vector<double> once_ns, least_ns;  ///< By pose, where `each`: of the first pass, of the least of all.
  double wall_ns = 0.0, cpu_ns = 0.0;     ///< Of all passes together, else.
  std::vector<Failed> failed;
};

std::string to_line(const Greeting& greeting);
std::string to_line(const Prepared& prepared);
std::string to_line(const Refusal& refusal);
template <class Answer>
std::string to_line(const Asked<Answer>& asked);
std::string to_line(const Timed& timed);

/// @throws Malformed, also for another version of the protocol; BadArgument for parameters that no Settings can have
Greeting greeting_of(const std::string& line);
/// @throws Malformed
std::variant<Prepared, Refusal> prepared_of(const std::string& line);
/// @throws Malformed
template <class Answer>
Asked<Answer> asked_of(const std::string& line);
/// The same for who asks: an answer that is not finite becomes Status::non_finite. @throws Malformed
template <class Answer>
Asked<Answer> answer_of(const std::string& line);
/// @throws Malformed, also where there is not one time for each of `count` poses, or a place is none of theirs or there
/// twice
Timed timed_of(const std::string& line, std::size_t count, bool each);

}  // namespace sixdof::protocol
