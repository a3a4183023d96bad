#include <sixdof/conformance/subject.h>

#include <map>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/query/ask.h>

namespace sixdof::conformance {
namespace {

/// Whether a command that takes the mesh's name gets this mesh.
bool is_model(const Mesh& mesh) {
  try {
    return !names_file(mesh.name()) && load_model(mesh.name()).hash() == mesh.hash();
  } catch (const Error&) {
    return false;  // No model of the catalogue.
  }
}

/// The word for the mesh on a command line: its name, or a file that is written.
std::string word_of(const Mesh& mesh, const std::filesystem::path& folder) {
  static std::map<std::string, bool> models;  // by content; making a model may take long
  const auto [known, is_new] = models.try_emplace(mesh.hash());
  if (is_new) known->second = is_model(mesh);
  if (known->second) return mesh.name();
  const std::filesystem::path file = folder / ("sixdof-conformance-" + mesh.hash() + ".ply");
  if (!folder.empty()) std::filesystem::create_directories(folder);
  if (!std::filesystem::exists(file)) save_mesh(mesh, file);
  return file.string();
}

template <class T>
void ask_into(Query& query, Outcome<T> (Query::*question)(const Pose&), const Pose& X_AB, Outcome<T>& answer,
              std::string& words) {
  const auto failed = [&words](const std::string& why) { words = why; };
  answer = ask_guarded([&] { return (query.*question)(X_AB); }, failed);
  if (words.empty()) examine(query, answer, failed);
}

}  // namespace

Subject::Subject(const Algorithm& asked, Declaration declaration, Commands how)
    : algorithm(asked), declared(std::move(declaration)), commands(std::move(how)), settings(asked.settings()) {
  settings.set_all(declared.settings);
}

std::unique_ptr<Query> Subject::prepare(const Mesh& a, const Mesh& b) const {
  return algorithm.prepare(a, b, settings);
}

Answers Subject::ask(Query& query, Kind kind, const Pose& X_AB) const {
  Answers result;
  if (kind == Kind::collide) ask_into(query, &Query::collide, X_AB, result.collide, result.words);
  if (kind == Kind::distance) ask_into(query, &Query::distance, X_AB, result.distance, result.words);
  if (kind == Kind::respond) ask_into(query, &Query::respond, X_AB, result.respond, result.words);
  return result;
}

Answers Subject::ask(Query& query, const Pose& X_AB) const {
  Answers all;
  for (const Kind kind : k_kinds) {
    if (!answers(kind)) continue;
    const Answers one = ask(query, kind, X_AB);
    if (kind == Kind::collide) all.collide = one.collide;
    if (kind == Kind::distance) all.distance = one.distance;
    if (kind == Kind::respond) all.respond = one.respond;
    if (!one.words.empty()) all.words = one.words;
  }
  return all;
}

std::string meshes_of(const At& at) { return fmt::format("{} (A), {} (B)", at.a.name(), at.b.name()); }

std::string command_of(const At& at) {
  const Subject& subject = at.subject;
  const auto word = [&](const Mesh& mesh) { return shell_quoted(word_of(mesh, subject.commands.folder)); };
  std::string command = fmt::format("{} query --a {} --b {} --pose '{}' --algorithm {}", subject.commands.program,
                                    word(at.a), word(at.b), at.pose.text(), subject.traits().name);
  for (const std::string& setting : subject.declared.settings) command += " -p " + shell_quoted(setting);
  return command + subject.commands.options;
}

}  // namespace sixdof::conformance
