#include <sixdof/configuration/set_meshes.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

namespace fs = std::filesystem;

bool fits(const MeshIdentity& wanted, const Mesh& mesh) { return wanted.hash.empty() || wanted.hash == mesh.hash(); }

std::string other_hash(const MeshIdentity& wanted, const std::string& where, const Mesh& mesh) {
  return fmt::format("mesh {}: {} has content hash {}, the set was made for {}", wanted.name, where, mesh.hash(),
                     wanted.hash);
}

/// Files that the set says the mesh is, each once.
std::vector<fs::path> stated_places(const MeshIdentity& wanted, const fs::path& set) {
  std::vector<fs::path> list;
  // An absolute path stays itself behind a folder.
  for (const fs::path& place :
       {fs::path(wanted.path), set.parent_path() / wanted.path, fs::path(wanted.absolute_path)}) {
    const fs::path normal = place.lexically_normal();
    if (!normal.empty() && std::ranges::find(list, normal) == list.end()) list.push_back(normal);
  }
  return list;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(mesh_file_of(file), ignored);
}

/// The wanted mesh by load(); nothing if there is none, or it cannot be had.
template <class Load>
std::optional<Mesh> guess(const MeshIdentity& wanted, const Load& load) {
  try {
    Mesh mesh = load();
    if (fits(wanted, mesh)) return std::move(mesh).renamed(wanted.name);
  } catch (const Error&) {
  }
  return std::nullopt;
}

}  // namespace

MeshIdentity identify(const Mesh& mesh, const std::string& name_or_file) {
  MeshIdentity identity = MeshIdentity::of(mesh);
  if (names_file(name_or_file)) {
    identity.path = name_or_file;
    identity.absolute_path = fs::absolute(name_or_file).lexically_normal().string();
  }
  return identity;
}

Mesh find_mesh(const MeshIdentity& wanted, const fs::path& set, const std::string& instead) {
  if (!instead.empty() || wanted.path.empty()) {
    const std::string& where = instead.empty() ? wanted.name : instead;
    Mesh mesh = [&] {
      try {
        return load_model(where);
      } catch (const BadArgument& e) {
        throw BadArgument(
            fmt::format("{}: mesh {}: {}; --a or --b says where it is", set.string(), wanted.name, e.what()));
      }
    }();
    if (!fits(wanted, mesh)) throw BadFile(set.string(), other_hash(wanted, where, mesh));
    return std::move(mesh).renamed(wanted.name);
  }
  std::vector<std::string> problems, missing;
  for (const fs::path& place : stated_places(wanted, set)) {
    if (!is_there(place)) {
      missing.push_back(place.string());
      continue;
    }
    try {
      Mesh mesh = load_mesh(place);
      if (fits(wanted, mesh)) return std::move(mesh).renamed(wanted.name);
      problems.push_back(other_hash(wanted, place.string(), mesh));
    } catch (const Error& e) {
      problems.push_back(fmt::format("mesh {}: {}", wanted.name, e.what()));
    }
  }
  // Another mesh at these places is no news about the wanted one.
  const fs::path beside = set.parent_path() / fs::path(wanted.path).filename();
  if (is_there(beside)) {
    if (auto mesh = guess(wanted, [&] { return load_mesh(beside); })) return std::move(*mesh);
  }
  if (auto mesh = guess(wanted, [&] { return load_model(wanted.name); })) return std::move(*mesh);
  if (problems.empty()) {
    problems.push_back(
        fmt::format("mesh {}: no file {}; --a or --b says where it is", wanted.name, fmt::join(missing, " or ")));
  }
  throw BadFile(set.string(), problems.front());
}

}  // namespace sixdof
