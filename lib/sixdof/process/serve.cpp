#include <sixdof/process/serve.h>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/process/child_process.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/shared_memory.h>
#include <sixdof/query/ask.h>
#include <sixdof/query/timed_loop.h>

namespace sixdof {
namespace {

using namespace protocol;

/// For on_no_memory(), which has no arguments.
int note_output = -1;

/// Tells the other side before the allocation fails: what follows may end the process.
void on_no_memory() {
  constexpr std::array<char, ChildProcess::k_memory_note.size() + 1> k_line = [] {
    std::array<char, ChildProcess::k_memory_note.size() + 1> line{};
    for (std::size_t i = 0; i < ChildProcess::k_memory_note.size(); ++i) line[i] = ChildProcess::k_memory_note[i];
    line.back() = '\n';
    return line;
  }();
  [[maybe_unused]] const ssize_t written = ::write(note_output, k_line.data(), k_line.size());
  throw std::bad_alloc();
}

/// Lines of a descriptor.
class LineReader {
 public:
  explicit LineReader(int input) : input_(input) {}

  /// Without its break; nothing once the input has ended.
  std::optional<std::string> next() {
    std::size_t searched = 0;
    while (true) {
      if (const std::size_t end = text_.find('\n', searched); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      searched = text_.size();
      std::array<char, 1 << 16> block;
      const ssize_t count = ::read(input_, block.data(), block.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      text_.append(block.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  const int input_;
  std::string text_;
};

template <class Element>
std::vector<Element> read_elements(const std::string& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw BadFile(path, "cannot be opened");
  // Before anything is allocated: the count may be any.
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || count > size / sizeof(Element)) {
    throw BadFile(path, fmt::format("fewer than {} elements of {} bytes", count, sizeof(Element)));
  }
  std::vector<Element> elements(count);
  const auto bytes = static_cast<std::streamsize>(count * sizeof(Element));
  file.read(reinterpret_cast<char*>(elements.data()), bytes);
  if (file.gcount() != bytes) throw BadFile(path, fmt::format("fewer than {} bytes", bytes));
  return elements;
}

Mesh read_mesh(const MeshPlace& place) {
  return Mesh::build(read_elements<Eigen::Vector3d>(place.vertices, place.vertex_count),
                     read_elements<Triangle>(place.triangles, place.triangle_count), place.name);
}

/// Reads every cache line of a buffer.
class Eviction {
 public:
  explicit Eviction(std::size_t bytes) : buffer_(bytes / sizeof(std::uint64_t), 1) {}
  void operator()() {
    constexpr std::size_t k_step = 64 / sizeof(std::uint64_t);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < buffer_.size(); i += k_step) sum += buffer_[i];
    keep(sum);
  }

 private:
  std::vector<std::uint64_t> buffer_;
};

/// A prepared query, asked for one kind of answer. An exception becomes a Status; `words` has why.
template <class Answer, class Input = Pose>
struct Asker {
  Query& query;
  Outcome<Answer> (Query::*question)(const Input&);
  std::string words = {};

  Outcome<Answer> operator()(const Input& input) {
    return ask_guarded([&] { return (query.*question)(input); }, [this](std::string why) { words = std::move(why); });
  }
  /// Turns an answer that is not finite into a Status.
  void examine(Outcome<Answer>& answer) {
    if (answer.ok()) words.clear();
    sixdof::examine(query, answer, [this](std::string why) {
      if (words.empty()) words = std::move(why);
    });
  }
};

/// The same for contacts, of which a number is asked for.
struct ContactsAsker {
  Query& query;
  std::size_t most;
  std::string words = {};

  Outcome<Contacts> operator()(const Pose& X_AB) {
    return ask_guarded([&] { return query.contacts(X_AB, most); }, [this](std::string why) { words = std::move(why); });
  }
  void examine(Outcome<Contacts>& answer) {
    if (answer.ok()) words.clear();
    sixdof::examine(query, answer, [this](std::string why) {
      if (words.empty()) words = std::move(why);
    });
  }
};

class Server {
 public:
  explicit Server(const Algorithm& algorithm) : algorithm_(algorithm) {}

  std::string reply(const std::string& line) {
    try {
      return std::visit([this](const auto& request) { return handle(request); }, request_of(line));
    } catch (const BadMesh& e) {
      return to_line(Refusal{Refusal::Kind::bad_mesh, e.what()});
    } catch (const BadArgument& e) {
      return to_line(Refusal{Refusal::Kind::bad_argument, e.what()});
    } catch (const std::bad_alloc&) {
      return to_line(Refusal{Refusal::Kind::other, "out of memory"});
    } catch (const std::exception& e) {
      return to_line(Refusal{Refusal::Kind::other, e.what()});
    }
  }

 private:
  std::string handle(const Hello&) const {
    return to_line(Greeting{.traits = algorithm_.traits(), .times = true, .progress = true});
  }

  std::string handle(const Prepare& request) {
    query_.reset();
    progress_ = std::make_unique<SharedCounter>(request.progress);
    a_ = std::make_unique<const Mesh>(read_mesh(request.a));
    const bool copies = request.a.vertices == request.b.vertices && request.a.triangles == request.b.triangles;
    b_ = copies ? nullptr : std::make_unique<const Mesh>(read_mesh(request.b));
    Settings settings = algorithm_.settings();
    for (const auto& [name, value] : request.settings) settings.set(name, value);
    const double cpu_start = processor_ns();
    auto [query, wall_ns] = with_clock([&] { return algorithm_.prepare(*a_, copies ? *a_ : *b_, settings); });
    const double cpu_ns = processor_ns() - cpu_start;
    if (!query) throw Error("prepare() returned a null pointer");
    query_ = std::move(query);
    return to_line(Prepared{wall_ns, cpu_ns, query_->footprint()});
  }

  std::string handle(const Ask& request) {
    if (request.query == k_query<Impact>) {
      if (!query_) throw BadArgument("nothing is prepared");
      return ask_once(Asker<Impact, Motion>{*query_, &Query::cast}, *request.motion);
    }
    if (request.query == k_query<Contacts>) {
      if (!query_) throw BadArgument("nothing is prepared");
      return ask_once(ContactsAsker{*query_, request.most}, request.X_AB);
    }
    return with_asker(request.query, [&](auto asker) { return ask_once(std::move(asker), request.X_AB); });
  }

  template <class AnyAsker, class Input>
  std::string ask_once(AnyAsker asker, const Input& input) {
    auto [outcome, took_ns] = with_clock([&] { return asker(input); });
    asker.examine(outcome);
    Asked<decltype(outcome.value)> asked{std::move(outcome), asker.words, took_ns, {}};
    if (asked.outcome.ok()) asked.work = query_->work();
    return to_line(asked);
  }

  std::string handle(const Time& request) {
    if (request.passes > std::numeric_limits<int>::max()) {
      throw BadArgument(fmt::format("{} passes", request.passes));
    }
    return with_asker(request.query, [&](auto asker) {
      return to_line(request.each ? time_each(request, asker) : time_passes_together(request, asker));
    });
  }

  /// Calls use(Asker) of a kind of query.
  template <class Use>
  std::string with_asker(const std::string& kind, Use use) {
    if (!query_) throw BadArgument("nothing is prepared");
    if (kind == k_query<bool>) return use(Asker<bool>{*query_, &Query::collide});
    if (kind == k_query<Separation>) return use(Asker<Separation>{*query_, &Query::distance});
    if (kind == k_query<Response>) return use(Asker<Response>{*query_, &Query::respond});
    throw BadArgument(fmt::format("\"{}\" is no kind of query", kind));
  }

  template <class Answer>
  Timed time_each(const Time& request, Asker<Answer>& asker) {
    std::vector<bool> has_failed(request.poses.size());
    Timed timed;
    Eviction evict(request.evict_bytes);
    std::uint64_t begun = 0;
    PassTimes times = time_passes(
        request.poses.size(), static_cast<int>(request.passes),
        [&](std::size_t) {
          progress_->set(++begun);
          evict();
        },
        [&](std::size_t i) { return asker(request.poses[i]); },
        [&](std::size_t i, Outcome<Answer>& answer) {
          asker.examine(answer);
          if (answer.ok() || has_failed[i]) return;
          has_failed[i] = true;
          timed.failed.push_back({i, answer.status, asker.words});
        });
    timed.once_ns = std::move(times.once_ns);
    timed.least_ns = std::move(times.least_ns);
    return timed;
  }

  template <class Answer>
  Timed time_passes_together(const Time& request, Asker<Answer>& asker) {
    std::uint64_t begun = 0;
    Timed timed;
    const auto ask = [&](std::size_t i) {
      progress_->set(++begun);
      return asker(request.poses[i]);
    };
    const double cpu_start = processor_ns();
    const auto [done, wall_ns] = with_clock([&] {
      for (std::size_t pass = 0; pass < request.passes; ++pass) ask_all(request.poses.size(), ask);
      return true;
    });
    timed.cpu_ns = processor_ns() - cpu_start;
    timed.wall_ns = wall_ns;
    return timed;
  }

  const Algorithm& algorithm_;
  std::unique_ptr<SharedCounter> progress_;
  std::unique_ptr<const Mesh> a_, b_;  ///< Outlive the query; `b_` is null for a copy of A.
  std::unique_ptr<Query> query_;
};

}  // namespace

void serve(const Algorithm& algorithm, int input, int output) {
  note_output = output;
  const std::new_handler before = std::set_new_handler(on_no_memory);
  Server server(algorithm);
  LineReader lines(input);
  while (const auto line = lines.next()) write_line(output, server.reply(*line));
  std::set_new_handler(before);
}

void serve_on_standard_streams(const Algorithm& algorithm) {
  const int input = high_descriptor(::dup(STDIN_FILENO)), output = high_descriptor(::dup(STDOUT_FILENO));
  if (const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC); nothing >= 0) {
    ::dup2(nothing, STDIN_FILENO);
    ::close(nothing);
  }
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  serve(algorithm, input, output);
}

}  // namespace sixdof
