#include <sixdof/report/figure_files.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>

extern char** environ;

namespace sixdof::report {
namespace {

bool is_in_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

/// @throws BadFile if not all of it can be read
std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || !in || text.view().size() != size) throw BadFile(path.string(), "cannot be read");
  return text.str();
}

/// The exit code of write_figures.js for a choice that no figure offers.
constexpr int k_no_such_choice = 3;

/// Reads to the end of what the other end of a pipe writes.
std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count > 0) text.append(block.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Runs a program to its end in `folder`, so that none of its words needs the folder's name, which may be no UTF-8.
/// @return what it printed; by a pipe, so that a full disk does not swallow why it failed
/// @throws BadArgument with its words if it ends with k_no_such_choice; BadFile with its words for another end but 0
std::string run(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(fmt::format("pipe: {}", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  std::string printed = failure == 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  if (failure != 0) throw Error(fmt::format("{} cannot be started: {}", words[0], std::strerror(failure)));
  const int status = wait_for(child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return printed;
  while (printed.ends_with('\n')) printed.pop_back();
  std::ranges::replace(printed, '\n', ' ');
  printed = visible_words(printed);
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_no_such_choice) throw BadArgument(printed);
  throw BadFile(folder.string(), fmt::format("{} failed: {}", words[0], printed));
}

/// Bounds of a width: a figure has axes, and a page an end.
constexpr double k_least_px = 120.0, k_most_px = 4000.0;

/// In CSS pixels, of which an inch has 96. @throws BadArgument
double pixels_of(const std::string& width) {
  constexpr std::array<std::pair<std::string_view, double>, 3> units{{{"mm", 96.0 / 25.4}, {"in", 96.0}, {"px", 1.0}}};
  for (const auto& [unit, pixels] : units) {
    if (!width.ends_with(unit)) continue;
    double number = 0.0;
    const char* const end = width.data() + width.size() - unit.size();
    const auto [at, error] = std::from_chars(width.data(), end, number);
    if (error == std::errc() && at == end && number * pixels >= k_least_px && number * pixels <= k_most_px) {
      return number * pixels;
    }
  }
  throw BadArgument(fmt::format("--width {}: not a width between 32mm and 1058mm, e.g. 84mm, 3.3in or 320px", width));
}

/// What page/write_figures.js reads.
std::string json_of(const FigureStyle& style, FigureFormat format) {
  nlohmann::json json = {{"title", style.has_title}, {"format", format == FigureFormat::tikz ? "tikz" : "svg"}};
  if (!style.width.empty()) json["width"] = pixels_of(style.width);
  if (!style.width.empty()) json["written"] = style.width;
  if (!style.font.empty()) json["font"] = style.font;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void need(const char* program, const char* package) {
  if (!is_in_path(program)) {
    throw BadArgument(fmt::format("{} is not in PATH (package {}; cmake/setup report installs it)", program, package));
  }
}

}  // namespace

std::vector<std::string> write_figures(const Report& report, const PageFiles& files,
                                       const std::filesystem::path& folder, FigureFormat format,
                                       const FigureStyle& style) {
  const std::string looks = json_of(style, format);
  need("node", "nodejs");
  if (format == FigureFormat::pdf) need("rsvg-convert", "librsvg2-bin");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadFile(folder.string(), "cannot be made: " + error.message());
  const PrivateFolder work(folder / "sixdof-figures");
  write_file_atomically(work.path() / "data.json", page_data(report, files));
  const std::filesystem::path programs = std::filesystem::absolute(files.folder);
  std::vector<std::string> names;
  std::istringstream lines(
      run({"node", (programs / "page" / "write_figures.js").string(), programs.string(), "data.json", ".", looks},
          work.path()));
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  for (std::string& name : names) {
    if (format == FigureFormat::pdf) {
      const std::string svg = name;
      name = std::filesystem::path(svg).replace_extension(".pdf").string();
      run({"rsvg-convert", "--format=pdf", "--output=" + name, svg}, work.path());
    }
    write_file_atomically(folder / name, text_of(work.path() / name));
  }
  return names;
}

}  // namespace sixdof::report
