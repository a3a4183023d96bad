#include <sixdof/report/figure_files.h>

#include <algorithm>
#include <cerrno>
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

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>

extern char** environ;

namespace sixdof::report {
namespace {

/// Longest text of a failed program that goes into a message.
constexpr std::size_t k_last_words = 300;

bool is_in_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder in `parent` that is removed with all that it holds.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& parent)
      : path_(parent / fmt::format(".sixdof-figures-{}.partial", ::getpid())) {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    if (error) throw BadFile(parent.string(), "cannot be made: " + error.message());
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs a program to its end; its output goes to `log`. @throws Error with its last words unless it ends with 0
void run(const std::vector<std::string>& words, const std::filesystem::path& log) {
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw Error(fmt::format("{} cannot be started: {}", words[0], std::strerror(failure)));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  std::string last = text_of(log);
  if (last.size() > k_last_words) last.erase(0, last.size() - k_last_words);
  std::ranges::replace(last, '\n', ' ');
  throw Error(fmt::format("{} failed: {}", words[0], last));
}

void need(const char* program, const char* package) {
  if (!is_in_path(program)) {
    throw BadArgument(fmt::format("{} is not in PATH (package {}; cmake/setup report installs it)", program, package));
  }
}

}  // namespace

std::vector<std::string> write_figures(const Report& report, const PageFiles& files,
                                       const std::filesystem::path& folder, FigureFormat format) {
  need("node", "nodejs");
  if (format == FigureFormat::pdf) need("rsvg-convert", "librsvg2-bin");
  const WorkFolder work(folder);
  const std::filesystem::path log = work.path() / "log", data = work.path() / "data.json";
  write_file_atomically(data, page_data(report, files));
  run({"node", (files.folder / "page" / "write_svg.js").string(), files.folder.string(), data.string(),
       work.path().string()},
      log);
  std::vector<std::string> names;
  std::istringstream lines(text_of(log));
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  for (std::string& name : names) {
    std::filesystem::path made = work.path() / name;
    if (format == FigureFormat::pdf) {
      const std::filesystem::path svg = made;
      made.replace_extension(".pdf");
      run({"rsvg-convert", "--format=pdf", "--output=" + made.string(), svg.string()}, log);
      name = made.filename().string();
    }
    write_file_atomically(folder / name, text_of(made));
  }
  return names;
}

}  // namespace sixdof::report
