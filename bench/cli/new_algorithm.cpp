#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/common/build_info.h"

namespace sixdof::cli {
namespace {

using Path = std::filesystem::path;

struct Arguments {
  std::string name;
  std::string output;
  std::string ci;  ///< "github", "gitlab" or empty.
};

/// @throws BadArgument unless an algorithm, a file, a class and a CMake target can have names made of this one
void check_form(const std::string& name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_allowed = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (name.empty() || !is_letter(name.front()) || name.back() == '-' || !std::ranges::all_of(name, is_allowed)) {
    throw BadArgument(
        fmt::format("{}: a name begins with a letter, has only a-z, 0-9 and '-', and does not end in '-'", name));
  }
}

/// @throws BadArgument for an algorithm that there is
void check_is_new(const std::string& name) {
  Registry registry;
  register_all_algorithms(registry);
  for (const auto& algorithm : registry.all()) {
    if (algorithm->traits().name == name)
      throw BadArgument(fmt::format("{}: there is an algorithm of this name", name));
  }
}

/// "fast-boxes" gives "fast_boxes".
std::string file_stem(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

/// "fast-boxes" gives "FastBoxesQuery".
std::string class_name(const std::string& name) {
  std::string result;
  bool begins_word = true;
  for (const char c : name) {
    if (c != '-') result += begins_word ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins_word = c == '-';
  }
  return result + "Query";
}

/// The sixdof that the project uses.
struct Root {
  Path path;
  bool is_source = false;  ///< The source that this program was built in; else the installation that it is part of.
};

Root find_root() {
  std::error_code ignored;
  const Path root = std::filesystem::weakly_canonical(data_folder() / "bench", ignored).parent_path();
  if (std::filesystem::exists(root / "lib" / "CMakeLists.txt", ignored)) return {root, true};
  return {root.parent_path().parent_path(), false};
}

using Words = std::vector<std::pair<std::string, std::string>>;

/// The template with each word "@KEY@" replaced. @throws BadFile
std::string fill_in(const Path& file, const Words& words) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  std::ostringstream whole;
  whole << in.rdbuf();
  std::string text = whole.str();
  for (const auto& [key, value] : words) {
    const std::string place = "@" + key + "@";
    for (std::size_t at = 0; (at = text.find(place, at)) != std::string::npos; at += value.size()) {
      text.replace(at, place.size(), value);
    }
  }
  return text;
}

/// A folder that gets its name when it is whole.
class NewFolder {
 public:
  /// @throws BadArgument if the name is taken, BadFile if the folder cannot be made
  explicit NewFolder(const Path& target)
      : target_(target.has_filename() ? target : target.parent_path()), unfinished_(free(target_)) {}

  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((unfinished_.path() / file).parent_path());
    write_file_atomically(unfinished_.path() / file, text);
  }

  const Path& path() const { return unfinished_.path(); }

  void commit() { unfinished_.commit(free(target_)); }

 private:
  static const Path& free(const Path& target) {
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(target, ignored))) {
      throw BadArgument(fmt::format("{}: exists already, and is not overwritten", target.string()));
    }
    return target;
  }

  Path target_;
  PrivateFolder unfinished_;
};

/// The revision of sixdof that a job of continuous integration builds: this program's.
std::string own_revision() {
  for (const auto& [key, value] : build_info()) {
    if (key == "commit" && !value.empty() && value != "unknown") return value;
  }
  return fmt::format("v{}", SIXDOF_VERSION);
}

/// The script that judges a change, and the job that calls it, as (template, place in the project).
Words ci_files(const std::string& ci) {
  return {{"gate.in", "ci/gate"},
          {ci + ".yml.in", ci == "github" ? ".github/workflows/sixdof-gate.yml" : ".gitlab-ci.yml"}};
}

/// Writes them into a folder, nothing if one of them is there. @throws BadArgument, BadFile
void write_ci(const std::string& name, const std::string& ci, const Path& project) {
  const Words words{{"NAME", name}, {"REVISION", own_revision()}};
  std::error_code ignored;
  for (const auto& [from, to] : ci_files(ci)) {
    if (std::filesystem::exists(std::filesystem::symlink_status(project / to, ignored))) {
      throw BadArgument(fmt::format("{}: exists already, and is not overwritten", (project / to).string()));
    }
  }
  for (const auto& [from, to] : ci_files(ci)) {
    std::filesystem::create_directories((project / to).parent_path());
    write_file_atomically(project / to, fill_in(data_folder() / "bench" / "new_algorithm" / "ci" / from, words));
  }
  using enum std::filesystem::perms;
  std::filesystem::permissions(project / "ci" / "gate", owner_exec | group_exec | others_exec,
                               std::filesystem::perm_options::add);
}

void write_project(const Arguments& arguments) {
  const std::string& name = arguments.name;
  check_form(name);
  const Path there = arguments.output;
  if (!arguments.ci.empty() && !there.empty() && std::filesystem::exists(there / "CMakeLists.txt")) {
    write_ci(name, arguments.ci, there);
    fmt::print("{0}: gained ci/gate and a job that calls it. Both build {1}-bench and {1}-sixdof, in .sixdof/\n",
               there.string(), name);
    return;
  }
  check_is_new(name);
  const Path templates = data_folder() / "bench" / "new_algorithm";
  const std::string stem = file_stem(name);
  const Root root = find_root();
  const Words words{{"NAME", name}, {"FILE", stem}, {"CLASS", class_name(name)}, {"SIXDOF", root.path.string()}};
  const Path output = arguments.output.empty() ? name : arguments.output;
  NewFolder folder(output);
  folder.write("CMakeLists.txt", fill_in(templates / "CMakeLists.txt.in", words));
  folder.write("README.md", fill_in(templates / "README.md.in", words));
  folder.write(stem + ".cpp", fill_in(templates / "algorithm.cpp.in", words));
  folder.write(stem + "_conformance.cpp", fill_in(templates / "conformance.cpp.in", words));
  if (!arguments.ci.empty()) {
    write_ci(name, arguments.ci, folder.path());
    folder.write(".gitignore", "/.sixdof/\n/build/\n");
  }
  folder.commit();
  fmt::print(
      "{0}: a project with the algorithm {1}. It uses {2}\n"
      "To build it and see its first row:\n"
      "  cd {3} && cmake -S . -B build && cmake --build build -j \"$(nproc)\"\n"
      "  build/{1}-bench --a cone-1k --b torus-1k\n",
      output.string(), name,
      root.is_source
          ? fmt::format("the source of sixdof, {}, and builds it in many minutes.\nWith an installation it builds in "
                        "one: cmake prints how to make one.",
                        root.path.string())
          : fmt::format("the installation of sixdof in {}.", root.path.string()),
      shell_quoted(output.string()));
}

}  // namespace

void add_new_algorithm_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("new-algorithm", "Write a C++ project with an algorithm of your own, which builds as it is");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("name", arguments->name, "The algorithm's name: a-z, 0-9 and '-'")->required()->type_name("NAME");
  command->add_option("-o,--output", arguments->output, "The folder to make, which must not exist")
      ->type_name("FOLDER")
      ->default_str("NAME");
  command
      ->add_option(
          "--ci", arguments->ci,
          "Also ci/gate, which judges a change (sixdof gate), and a job that calls it; into a FOLDER that has a "
          "CMakeLists.txt only these")
      ->type_name("SERVICE")
      ->check(CLI::IsMember({"github", "gitlab"}));
  command->callback([arguments] { write_project(*arguments); });
  add_examples(*command, "sixdof new-algorithm fast-boxes", "sixdof new-algorithm fast-boxes -o my-project");
}

}  // namespace sixdof::cli
