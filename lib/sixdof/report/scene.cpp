#include <sixdof/report/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/geometry/load.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/scenario/scenario.h>

namespace sixdof::report {
namespace {

/// Hard cases that a page shows; each brings two meshes.
constexpr std::size_t k_most_cases = 24;
/// Meshes beyond which no file of the user's is added: a page stays below ten megabytes.
constexpr std::size_t k_most_meshes = 30;

std::array<float, 3> as_floats(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// `cells` along the longest side of the box.
DrawnMesh clustered(const Mesh& mesh, double cells) {
  DrawnMesh result{.name = mesh.name(), .vertices = {}, .triangles = {}, .triangles_before = mesh.triangles().size()};
  const double size = mesh.box().sizes().maxCoeff() / cells;
  std::map<std::tuple<int, int, int>, std::uint32_t> cell_index;
  std::vector<std::uint32_t> cell_of;
  std::vector<Eigen::Vector3d> sums;
  std::vector<double> counts;
  for (const Eigen::Vector3d& p : mesh.vertices()) {
    const Eigen::Vector3d q = (p - mesh.box().min()) / size;
    const auto key = std::tuple(static_cast<int>(q.x()), static_cast<int>(q.y()), static_cast<int>(q.z()));
    const auto [place, is_new] = cell_index.try_emplace(key, static_cast<std::uint32_t>(sums.size()));
    if (is_new) {
      sums.emplace_back(Eigen::Vector3d::Zero());
      counts.push_back(0.0);
    }
    sums[place->second] += p;
    counts[place->second] += 1.0;
    cell_of.push_back(place->second);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) result.vertices.push_back(as_floats(sums[k] / counts[k]));
  std::set<std::array<std::uint32_t, 3>> seen;
  for (const auto& triangle : mesh.triangles()) {
    std::array<std::uint32_t, 3> t{cell_of[triangle[0]], cell_of[triangle[1]], cell_of[triangle[2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    if (seen.insert(t).second) result.triangles.push_back(t);
  }
  return result;
}

std::size_t add_mesh(const Mesh& mesh, Scenes& scenes) {
  scenes.meshes.push_back(drawn(mesh));
  return scenes.meshes.size() - 1;
}

void add_objects(const Results& results, Scenes& scenes) {
  std::set<std::string> seen;
  for (const Source& file : results.files) {
    for (const auto& [key, hash] : file.context) {
      if (!key.starts_with("mesh:") || !seen.insert(key).second) continue;
      const std::string name = key.substr(std::string("mesh:").size());
      try {
        if (names_file(name)) continue;
        const std::size_t mesh = add_mesh(load_model(name), scenes);
        scenes.scenes.push_back({.name = name,
                                 .kind = "object",
                                 .command = own_command(fmt::format("sixdof info {}", shell_quoted(name))),
                                 .a = mesh,
                                 .b = mesh,
                                 .moments = {}});
      } catch (const Error&) {  // A mesh of the user's, or a model that is not fetched here.
      }
    }
  }
}

/// "rho=50,facets=96" as assignments.
std::vector<std::string> assignments(const std::string& settings) {
  std::vector<std::string> list;
  std::istringstream text(settings);
  for (std::string item; std::getline(text, item, ',');) list.push_back(item);
  return list;
}

Scene path_scene(const Series& series) {
  Scene scene{.name = fmt::format("{}: {}", series.scenario, series.algorithm),
              .algorithm = series.algorithm,
              .kind = "path",
              .command = series.command,
              .rate_hz = series.rate_hz,
              .moments = {}};
  scene.stride = (series.poses.size() + k_most_moments - 1) / k_most_moments;
  for (std::size_t k = 0; k < series.poses.size(); k += scene.stride) {
    scene.moments.push_back({.pose = series.poses[k],
                             .force = series.force[k],
                             .ideal_force = series.ideal_force[k],
                             .torque = series.torque[k],
                             .ideal_torque = series.ideal_torque[k]});
  }
  return scene;
}

void add_paths(const std::vector<Series>& all, Scenes& scenes) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> meshes;  // by scenario and shape
  for (const Series& series : all) {
    if (series.poses.empty()) continue;
    try {
      Settings shape = scenario_settings(series.scenario);
      shape.set_all(assignments(series.shape));
      const auto scenario = make_scenario(series.scenario, shape);
      const auto [place, is_new] = meshes.try_emplace(series.scenario + series.shape);
      if (is_new) place->second = {add_mesh(scenario->a(), scenes), add_mesh(scenario->b(), scenes)};
      Scene scene = path_scene(series);
      scene.a = place->second.first;
      scene.b = place->second.second;
      const Eigen::Vector3d& reference = scenario->description().reference_b;
      scene.reference = {reference.x(), reference.y(), reference.z()};
      scenes.scenes.push_back(std::move(scene));
    } catch (const BadArgument&) {  // Recorded by another version, whose scenario had other parameters.
    }
  }
}

/// The word behind an option of a command line, without its quotes; empty where it is not there.
std::string option(const std::string& command, const std::string& name) {
  const std::string before = " " + name + " ";
  std::size_t at = command.find(before);
  if (at == std::string::npos) return {};
  at += before.size();
  const bool is_quoted = at < command.size() && (command[at] == '"' || command[at] == '\'');
  const std::size_t begin = is_quoted ? at + 1 : at;
  return command.substr(begin, command.find(is_quoted ? command[at] : ' ', begin) - begin);
}

void add_cases(const Results& results, Scenes& scenes) {
  std::size_t count = 0;
  for (const HardCase& cell : results.hard_cases) {
    const auto pose =
        is_red(cell) && count < k_most_cases ? typed_pose(option(cell.reproduction, "--pose")) : std::nullopt;
    if (!pose) continue;
    try {
      const Mesh a = load_mesh(option(cell.reproduction, "--a")), b = load_mesh(option(cell.reproduction, "--b"));
      Scene scene{.name = fmt::format("{}: {}", cell.family, cell.algorithm),
                  .algorithm = cell.algorithm,
                  .kind = "case",
                  .command = cell.reproduction,
                  .moments = {Moment{.pose = *pose}}};
      scene.a = add_mesh(a, scenes);
      scene.b = add_mesh(b, scenes);
      scenes.scenes.push_back(std::move(scene));
      ++count;
    } catch (const Error&) {  // The folder of cases is not here.
    }
  }
}

/// Meshes of the page by the names that outliers have for them. A file is taken if the results have its hash.
class NamedMeshes {
 public:
  NamedMeshes(const Results& results, Scenes& scenes) : results_(results), scenes_(scenes) {
    for (const Scene& scene : scenes.scenes) {
      if (scene.kind == "object") index_.emplace(scene.name, scene.a);
    }
  }

  std::optional<std::size_t> find(const std::string& name, std::size_t file) {
    const auto [place, is_new] = index_.try_emplace(name);
    if (!is_new || !names_file(name) || scenes_.meshes.size() >= k_most_meshes) return place->second;
    try {
      const Mesh mesh = load_mesh(name);
      const auto is_of_results = [&](const auto& entry) {
        return entry.first.starts_with("mesh:") && entry.second == mesh.hash();
      };
      if (!std::ranges::any_of(results_.files[file].context, is_of_results)) return std::nullopt;
      place->second = add_mesh(mesh, scenes_);
    } catch (const Error&) {  // The file is gone.
    }
    return place->second;
  }

 private:
  const Results& results_;
  Scenes& scenes_;
  std::map<std::string, std::optional<std::size_t>> index_;
};

Scene pose_scene(const Row& row, const std::string& counter, const ComparedResponse* response) {
  Scene scene{.name = fmt::format("{} of {}: {} {}, {}", row.fields.query, row.fields.algorithm, row.fields.pair,
                                  place_of(row.fields), words_of_outlier(counter)),
              .algorithm = row.fields.algorithm,
              .kind = "pose",
              .command = row.outliers.command_of(counter),
              .moments = {}};
  Moment moment{.pose = typed_pose(row.outliers.poses.at(counter)).value_or(Moment().pose)};
  if (response != nullptr) {
    moment.force = response->force;
    moment.ideal_force = response->exact_force;
    moment.torque = response->torque;
    moment.ideal_torque = response->exact_torque;
    const auto& [w, x, y, z, tx, ty, tz] = moment.pose;
    const Eigen::Vector3d in_b = Eigen::Quaterniond(w, x, y, z).normalized().conjugate() *
                                 (Eigen::Vector3d(response->reference.data()) - Eigen::Vector3d(tx, ty, tz));
    scene.reference = {in_b.x(), in_b.y(), in_b.z()};
  }
  scene.moments.push_back(moment);
  return scene;
}

/// One for each command: several counters of a row may have one configuration. That with a response or contacts is
/// kept.
void add_outliers(const Results& results, Scenes& scenes) {
  NamedMeshes meshes(results, scenes);
  std::map<std::string, std::size_t> index;
  for (const Row& row : results.rows) {
    for (const auto& [counter, pose] : row.outliers.poses) {
      const std::string command = row.outliers.command_of(counter);
      const auto found = row.outliers.responses.find(counter);
      const bool is_pictured = row.outliers.contacts.contains(counter);
      const ComparedResponse* const response = found == row.outliers.responses.end() ? nullptr : &found->second;
      const auto a = meshes.find(row.outliers.a, row.file), b = meshes.find(row.outliers.b, row.file);
      if (command.empty() || !a || !b) continue;
      const auto [place, is_new] = index.try_emplace(command, scenes.scenes.size());
      if (!is_new && response == nullptr && !is_pictured) continue;
      Scene scene = pose_scene(row, counter, response);
      if (const auto picture = row.outliers.contacts.find(counter); picture != row.outliers.contacts.end()) {
        scene.contacts = picture->second.contacts;
        scene.curve = picture->second.curve;
      }
      scene.a = *a;
      scene.b = *b;
      if (is_new) {
        scenes.scenes.push_back(std::move(scene));
      } else {
        scenes.scenes[place->second] = std::move(scene);
      }
    }
  }
}

}  // namespace

DrawnMesh drawn(const Mesh& mesh, std::size_t most) {
  if (mesh.triangles().size() <= most) {
    DrawnMesh result{.name = mesh.name(), .vertices = {}, .triangles = {}, .triangles_before = mesh.triangles().size()};
    for (const Eigen::Vector3d& p : mesh.vertices()) result.vertices.push_back(as_floats(p));
    for (const auto& t : mesh.triangles()) result.triangles.push_back({t[0], t[1], t[2]});
    return result;
  }
  // A surface has about as many triangles as cells squared, times a factor that depends on its shape.
  double cells = 16.0;
  DrawnMesh result = clustered(mesh, cells);
  constexpr int k_rounds = 8;
  for (int round = 0; round < k_rounds; ++round) {
    const double share =
        static_cast<double>(most) / static_cast<double>(std::max<std::size_t>(1, result.triangles.size()));
    if (share >= 1.0 && share < 1.4) break;
    cells = std::clamp(cells * 0.92 * std::sqrt(share), 2.0, 2048.0);
    result = clustered(mesh, cells);
  }
  return result;
}

Scenes make_scenes(const Results& results, const std::vector<Series>& series) {
  Scenes scenes;
  add_paths(series, scenes);
  add_cases(results, scenes);
  add_objects(results, scenes);
  add_outliers(results, scenes);
  return scenes;
}

}  // namespace sixdof::report
