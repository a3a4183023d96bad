// Both sides of the protocol of isolated algorithms. The first byte of an input picks the reader, the rest is what the
// other side has written:
//
// 's': requests, line by line, to a server with an algorithm. Files that a line names are replaced by those of a small
//      pair, and passes are few, so that an input cannot touch other files or run for long. Every line has one reply.
// 'q': one request; 'c', 'd', 'r': an answer to collide, distance, respond; 'h': a greeting; 'p': the reply to prepare;
//      't', 'T': times of two poses, each or together.
//
// A line is refused as Malformed, or what is read can be written, and read again as the same. An answer that is not
// finite is none. No text of a reply, and no message, has a character that does not print.
#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <limits>
#include <span>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/serve.h>
#include <sixdof/process/shared_memory.h>
#include <sixdof/query/ask.h>

#include "fuzz.h"
#include "small_meshes.h"

namespace sixdof::fuzz {
namespace {

using namespace protocol;

/// Files of a pair as a program finds them.
struct PairFiles {
  Mesh mesh = tetrahedron();
  MemoryFile vertices{"vertices", std::as_bytes(std::span(mesh.vertices()))};
  MemoryFile triangles{"triangles", std::as_bytes(std::span(mesh.triangles()))};
  MemoryFile progress{"progress", std::as_bytes(std::span("1234567", 8))};

  void replace(MeshPlace& place) const {
    place.vertices = path_of_descriptor(vertices.descriptor());
    place.triangles = path_of_descriptor(triangles.descriptor());
  }
};

/// The line, without what an input may not do.
std::string harmless(const std::string& line) {
  static const PairFiles files;
  constexpr std::size_t k_most_passes = 3, k_most_evict_bytes = 1 << 16;
  try {
    Request request = request_of(line);
    if (auto* const prepare = std::get_if<Prepare>(&request)) {
      files.replace(prepare->a);
      files.replace(prepare->b);
      prepare->progress = path_of_descriptor(files.progress.descriptor());
    } else if (auto* const time = std::get_if<Time>(&request)) {
      if (time->passes <= std::numeric_limits<int>::max()) time->passes = std::min(time->passes, k_most_passes);
      time->evict_bytes = std::min(time->evict_bytes, k_most_evict_bytes);
    }
    return to_line(request);
  } catch (const Malformed&) {
    return line;
  }
}

/// Lines that end in a break.
std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
    lines.emplace_back(text.substr(0, end));
  }
  return lines;
}

int rewound(int descriptor) {
  ::lseek(descriptor, 0, SEEK_SET);
  return descriptor;
}

void check_server(std::string_view text) {
  static const std::unique_ptr<Algorithm> algorithm = make_brute_force_algorithm();
  const int input = ::memfd_create("requests", MFD_CLOEXEC), output = ::memfd_create("replies", MFD_CLOEXEC);
  require(input >= 0 && output >= 0, "there are files in memory");
  const std::vector<std::string> lines = split_lines(text);
  for (const std::string& line : lines) {
    const std::string sent = harmless(line) + "\n";
    require(::write(input, sent.data(), sent.size()) == static_cast<ssize_t>(sent.size()), "there is memory");
  }
  serve(*algorithm, rewound(input), output);
  std::string replies(static_cast<std::size_t>(::lseek(output, 0, SEEK_END)), '\0');
  require(::pread(output, replies.data(), replies.size(), 0) == static_cast<ssize_t>(replies.size()),
          "replies are read");
  ::close(input);
  ::close(output);
  require(split_lines(replies).size() == lines.size(), "every request has one reply");
  require(replies.empty() || replies.back() == '\n', "every reply is a line");
}

void require_visible(std::string_view text) {
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7F'; };
  require(std::ranges::none_of(text, is_control), "a text has no control character");
  require(visible_text(text, k_any_length) == text, "a text is visible");
}

void require_visible(const Traits& traits) {
  for (const std::string* const text : {&traits.name, &traits.version, &traits.summary}) require_visible(*text);
  for (const Parameter& parameter : traits.parameters) {
    for (const std::string* const text :
         {&parameter.name, &parameter.meaning, &parameter.unit, &parameter.default_value}) {
      require_visible(*text);
    }
    for (const auto* const list : {&parameter.choices, &parameter.sweep}) {
      for (const std::string& text : *list) require_visible(text);
    }
  }
}

template <class Answer>
void check_answer(const std::string& line) {
  const Asked<Answer> answer = answer_of<Answer>(line);
  require(!answer.outcome.ok() || is_finite(answer.outcome.value), "an answer that is not finite is none");
  require(!answer.ns || *answer.ns >= 0.0, "a time is not negative");
  require_visible(answer.words);
  for (const Work& each : answer.work) require_visible(each.unit);
  const std::string written = to_line(asked_of<Answer>(line));
  require(to_line(asked_of<Answer>(written)) == written, "an answer that is written is read as the same");
}

void check_times(const std::string& line, bool each) {
  constexpr std::size_t k_poses = 2;
  const Timed timed = timed_of(line, k_poses, each);
  for (const Failed& failed : timed.failed) {
    require(failed.place < k_poses, "failures are of poses that were asked");
    require_visible(failed.words);
  }
  for (const auto& times : {timed.once_ns, timed.least_ns}) {
    require(times.size() == (each ? k_poses : 0), "there is a time for each pose");
    for (const double ns : times) require(ns >= 0.0 && ns <= std::numeric_limits<double>::max(), "times are finite");
  }
  const std::string written = to_line(timed);
  require(to_line(timed_of(written, k_poses, each)) == written, "times that are written are read as the same");
}

void check_line(char kind, const std::string& line) {
  switch (kind) {
    case 'c':
      return check_answer<bool>(line);
    case 'd':
      return check_answer<Separation>(line);
    case 'r':
      return check_answer<Response>(line);
    case 't':
    case 'T':
      return check_times(line, kind == 't');
    case 'h': {
      const Greeting greeting = greeting_of(line);
      require_visible(greeting.traits);
      const std::string written = to_line(greeting);
      return require(to_line(greeting_of(written)) == written, "a greeting that is written is read as the same");
    }
    case 'p': {
      const auto reply = prepared_of(line);
      if (const auto* const refusal = std::get_if<Refusal>(&reply)) return require_visible(refusal->words);
      for (const auto& [name, count] : std::get<Prepared>(reply).footprint.counts) require_visible(name);
      return;
    }
    default: {
      const std::string written = to_line(request_of(line));
      require(to_line(request_of(written)) == written, "a request that is written is read as the same");
    }
  }
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof::fuzz;
  Input input(data, size);
  const char kind = static_cast<char>(input.byte());
  if (kind == 's') {
    check_server(input.rest());
    return 0;
  }
  try {
    check_line(kind, std::string(input.rest()));
  } catch (const sixdof::protocol::Malformed& e) {
    require_visible(e.what());
  } catch (const sixdof::BadArgument& e) {
    require(kind == 'h', "only the parameters of a greeting are bad arguments");
    require_visible(e.what());
  }
  return 0;
}
