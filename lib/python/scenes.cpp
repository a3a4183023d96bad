#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/base/error.h>
#include <sixdof/scene/families.h>
#include <sixdof/scene/scene.h>
#include <sixdof/scene/scene_file.h>
#include <sixdof/scene/score.h>
#include <sixdof/scene/truth.h>
#include "bench/common/scene_algorithms.h"
#include "lib/python/arrays.h"
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

using scene::Scene;

const scene::SceneAlgorithms& scene_algorithms() {
  static const auto& algorithms = *new scene::SceneAlgorithms(all_scene_algorithms());  // outlives all threads
  return algorithms;
}

py::list list_scene_algorithms() {
  py::list list;
  for (const auto& algorithm : scene_algorithms()) {
    const scene::SceneTraits& traits = algorithm->traits();
    py::dict dict;
    dict["name"] = traits.name;
    dict["version"] = traits.version;
    dict["summary"] = traits.summary;
    py::list questions;
    for (const scene::Question question : traits.answers) questions.append(std::string(to_string(question)));
    dict["questions"] = py::tuple(questions);
    list.append(dict);
  }
  return list;
}

/// @param numbers by the names of SceneNumbers
std::shared_ptr<Scene> make(const std::string& family, const std::map<std::string, double>& numbers) {
  scene::SceneNumbers wanted;
  const std::map<std::string, double*> fields{{"density", &wanted.density}, {"size_ratio", &wanted.size_ratio},
                                              {"moving", &wanted.moving},   {"step", &wanted.step},
                                              {"margin", &wanted.margin},   {"amplitude", &wanted.amplitude}};
  for (const auto& [name, value] : numbers) {
    const bool is_count = name == "bodies" || name == "frames" || name == "triangles" || name == "seed";
    if (is_count && !(value >= 0.0 && value < 1e15))
      throw BadArgument(fmt::format("{}: {} is out of range", name, value));
    if (name == "bodies") {
      wanted.bodies = static_cast<std::size_t>(value);
    } else if (name == "frames") {
      wanted.frames = static_cast<std::size_t>(value);
    } else if (name == "triangles") {
      wanted.triangles = static_cast<std::size_t>(value);
    } else if (name == "seed") {
      wanted.seed = static_cast<std::uint64_t>(value);
    } else if (const auto field = fields.find(name); field != fields.end()) {
      *field->second = value;
    } else {
      throw BadArgument(fmt::format(
          "{}: no parameter of scenes; they are bodies, frames, density, size_ratio, moving, step, margin, amplitude, "
          "triangles, seed",
          name));
    }
  }
  const py::gil_scoped_release release;
  return std::make_shared<Scene>(scene::make_scene(family, wanted));
}

py::list meshes(const Scene& scene) {
  py::list list;
  for (const auto& mesh : scene.meshes) list.append(std::const_pointer_cast<Mesh>(mesh));  // Python cannot change it
  return list;
}

py::dict bodies(const Scene& scene) {
  std::vector<std::uint32_t> ids, meshes;
  py::array_t<bool> fixed(static_cast<py::ssize_t>(scene.bodies.size()));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    ids.push_back(scene.bodies[i].id);
    meshes.push_back(scene.bodies[i].mesh);
    fixed.mutable_at(static_cast<py::ssize_t>(i)) = scene.bodies[i].fixed;
    poses.push_back(scene.bodies[i].pose.pose());
  }
  py::dict dict;
  dict["id"] = array_of<std::uint32_t>(ids);
  dict["mesh"] = array_of<std::uint32_t>(meshes);
  dict["fixed"] = fixed;
  dict["poses"] = matrices_of(poses);
  return dict;
}

/// Which bodies move in a frame, by index, and where to.
py::tuple frame(const Scene& scene, std::size_t index) {
  if (index >= scene.frames.size()) throw BadArgument(fmt::format("frame: {} of {}", index, scene.frames.size()));
  std::vector<std::uint32_t> moved;
  std::vector<Pose> poses;
  for (const scene::Moved& motion : scene::moves_of(scene.frames[index])) {
    moved.push_back(motion.body);
    poses.push_back(motion.X_WB);
  }
  return py::make_tuple(array_of<std::uint32_t>(moved), matrices_of(poses));
}

/// The meshes that deform in a frame, by index, with their vertices.
py::dict shapes(const Scene& scene, std::size_t index) {
  if (index >= scene.frames.size()) throw BadArgument(fmt::format("frame: {} of {}", index, scene.frames.size()));
  py::dict dict;
  for (const scene::Deformed& deformed : scene::shapes_of(scene, index)) {
    py::array_t<double> vertices({static_cast<py::ssize_t>(deformed.vertices.size()), py::ssize_t{3}});
    double* place = vertices.mutable_data();
    for (const Eigen::Vector3d& p : deformed.vertices) place = std::copy_n(p.data(), 3, place);
    dict[py::int_(deformed.mesh)] = vertices;
  }
  return dict;
}

py::dict dict_of(const scene::SceneAnswer& answer) {
  py::array_t<std::uint32_t> pairs({static_cast<py::ssize_t>(answer.pairs.size()), py::ssize_t{2}});
  std::uint32_t* place = pairs.mutable_data();
  std::vector<double> distances;
  for (const scene::NearPair& near : answer.pairs) {
    *place++ = near.pair.a;
    *place++ = near.pair.b;
    distances.push_back(near.distance);
  }
  std::vector<std::uint32_t> ids;
  std::vector<Eigen::Vector3d> forces, torques;
  for (const scene::BodyWrench& wrench : answer.wrenches) {
    ids.push_back(wrench.body);
    forces.push_back(wrench.force);
    torques.push_back(wrench.torque);
  }
  py::dict dict;
  dict["pairs"] = pairs;
  dict["distance"] = array_of<double>(distances);
  dict["body"] = array_of<std::uint32_t>(ids);
  dict["force"] = rows_of(forces);
  dict["torque"] = rows_of(torques);
  return dict;
}

/// The answers of every frame, and how they compare with the truth.
py::tuple play(const Scene& scene, const std::string& algorithm, const std::string& question_word) {
  const scene::Question question = scene::parse_question(question_word);
  const scene::SceneAlgorithm& asked = scene::find_algorithm(scene_algorithms(), algorithm);
  const auto has_signal = [] {
    const py::gil_scoped_acquire acquire;
    return PyErr_CheckSignals() != 0;
  };
  scene::Play play;
  bool is_stopped = false;
  const auto cancelled = [&] { return is_stopped = is_stopped || has_signal(); };
  try {
    const py::gil_scoped_release release;
    const scene::SceneAnswers truth = scene::truth_of(scene, question, cancelled);
    play = scene::play(scene, asked, question, truth, cancelled);
  } catch (const Interrupted&) {
    if (is_stopped) throw py::error_already_set();
    throw;
  }
  py::list frames;
  for (const scene::SceneAnswer& answer : play.answers.frames) frames.append(dict_of(answer));
  py::dict score;
  score["true_pairs"] = play.score.true_pairs;
  score["missed"] = play.score.missed;
  score["wrong"] = play.score.wrong;
  score["grazing"] = play.score.grazing;
  score["nested"] = play.score.nested;
  score["largest_error"] = play.score.largest_error;
  score["prepare_s"] = play.timing.prepare_s;
  score["mean_us"] = play.timing.mean_us;
  score["max_us"] = play.timing.max_us;
  return py::make_tuple(frames, score);
}

/// @param poses (frame, body, 4, 4) in the world; @param fixed one for each body
std::shared_ptr<Scene> build(const std::vector<std::shared_ptr<Mesh>>& meshes,
                             const std::vector<std::uint32_t>& mesh_of, const std::vector<bool>& fixed,
                             const Doubles& poses, double margin, const std::string& name) {
  auto scene = std::make_shared<Scene>();
  scene->name = name;
  scene->margin = margin;
  scene->meshes.assign(meshes.begin(), meshes.end());
  const std::size_t count = mesh_of.size();
  const std::size_t frames = count == 0 ? 0 : static_cast<std::size_t>(poses.shape(0)) / count;
  const std::vector<Pose> all = poses_of(poses);
  const auto recorded = [&](std::size_t f, std::size_t i) {
    const Pose& pose = all[f * count + i];
    return scene::RecordedPose::of(pose.R, pose.t);
  };
  for (std::size_t i = 0; i < count; ++i) {
    scene->bodies.push_back({static_cast<std::uint32_t>(i), mesh_of[i], fixed[i], recorded(0, i)});
  }
  scene->frames.resize(frames);
  for (std::size_t f = 1; f < frames; ++f) {
    for (std::size_t i = 0; i < count; ++i) {
      const scene::RecordedPose now = recorded(f, i);
      if (now.numbers == recorded(f - 1, i).numbers) continue;
      scene->frames[f].push_back({static_cast<std::uint32_t>(i), now});
    }
  }
  scene->check();
  return scene;
}

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<Scene, std::shared_ptr<Scene>>(module, "Scene")
      .def_readonly("name", &Scene::name)
      .def_readonly("recipe", &Scene::recipe)
      .def_readonly("margin", &Scene::margin)
      .def_property_readonly("hash", &Scene::hash)
      .def_property_readonly("frames", [](const Scene& scene) { return scene.frames.size(); })
      .def("meshes", meshes)
      .def("bodies", bodies)
      .def("frame", frame, py::arg("index"))
      .def("shapes", shapes, py::arg("index"))
      .def("play", play, py::arg("algorithm"), py::arg("question"))
      .def(
          "save", [](const Scene& scene, const std::string& file) { scene::save_scene(scene, file); }, py::arg("file"));
  module.def(
      "load_scene", [](const std::string& file) { return std::make_shared<Scene>(scene::load_scene(file)); },
      py::arg("file"));
  module.def("make_scene", make, py::arg("family"), py::arg("numbers"));
  module.def("build_scene", build, py::arg("meshes"), py::arg("mesh_of"), py::arg("fixed"), py::arg("poses"),
             py::arg("margin"), py::arg("name"));
  module.def("scene_algorithms", list_scene_algorithms);
  module.def("scene_families", [] {
    py::dict dict;
    for (const auto families : {scene::scene_families(), scene::deforming_families()}) {
      for (const scene::SceneFamily& family : families) {
        dict[py::str(std::string(family.name))] = std::string(family.stresses);
      }
    }
    return dict;
  });
}

}  // namespace sixdof::python
