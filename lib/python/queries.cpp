#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/all_algorithms.h"
#include "lib/python/arrays.h"
#include "lib/python/bindings.h"
#include "lib/python/prepared_pair.h"

namespace sixdof::python {
namespace {

py::dict dict_of(const Parameter& parameter) {
  py::dict dict;
  dict["name"] = parameter.name;
  dict["meaning"] = parameter.meaning;
  dict["unit"] = parameter.unit;
  dict["default"] = parameter.default_value;
  dict["choices"] = parameter.choices;
  if (parameter.choices.empty()) {
    dict["low"] = parameter.low;
    dict["high"] = parameter.high;
    dict["integer"] = parameter.integer;
  }
  return dict;
}

py::dict dict_of(const Traits& traits) {
  py::dict dict;
  dict["name"] = traits.name;
  dict["version"] = traits.version;
  dict["summary"] = traits.summary;
  py::list answers;
  if (traits.answers.collide) answers.append("collide");
  if (traits.answers.distance) answers.append("distance");
  if (traits.answers.respond) answers.append("respond");
  if (traits.answers.cast) answers.append("cast");
  dict["answers"] = py::tuple(answers);
  dict["law"] = std::string(to_string(traits.law));
  dict["approximates"] = traits.approximates;
  dict["body"] = std::string(to_string(traits.body));
  dict["runtime"] = traits.runtime;
  py::list parameters;
  for (const Parameter& parameter : traits.parameters) parameters.append(dict_of(parameter));
  dict["parameters"] = py::tuple(parameters);
  return dict;
}

py::list list_algorithms() {
  py::list list;
  for (const auto& algorithm : all_algorithms().all()) list.append(dict_of(algorithm->traits()));
  return list;
}

/// @param server a program of this project in whose process the algorithm runs; empty: it runs in this one
std::shared_ptr<PreparedPair> prepare(const std::string& name, const std::shared_ptr<Mesh>& a,
                                      const std::shared_ptr<Mesh>& b, const Parameters& parameters,
                                      const std::string& server, double query_timeout) {
  const Algorithm& listed = all_algorithms().find(name);
  const Settings settings = settings_of(listed, parameters);
  const py::gil_scoped_release release;
  std::shared_ptr<const Algorithm> algorithm(&listed, [](const Algorithm*) {});  // the registry's
  if (!server.empty() && !is_isolated(listed)) {
    const std::string command = fmt::format("{} --serve-algorithm {}", shell_quoted(server), name);
    algorithm = RemoteAlgorithm::described(listed.traits(), command, {.query_s = query_timeout});
  }
  return std::make_shared<PreparedPair>(algorithm, settings, a, b);
}

/// Whether Python has a signal to handle, such as Ctrl-C.
bool has_signal() {
  const py::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() != 0;
}

/// Asks all poses or motions without the GIL. @throws the exception that a handler of a signal raised
template <class Answer, class Input, class Ask, class Store>
Endings ask_all(PreparedPair& pair, const std::vector<Input>& inputs, unsigned threads, const Ask& ask,
                const Store& store) {
  Endings endings;
  bool is_stopped = false;
  {
    const py::gil_scoped_release release;
    endings = pair.ask_all<Answer>(
        inputs.size(), threads, [&](Query& query, std::size_t place) { return ask(query, inputs[place]); }, store,
        [&] { return is_stopped = has_signal(); });
  }
  if (is_stopped) throw py::error_already_set();
  return endings;
}

void add(py::dict& dict, const Endings& endings) {
  dict["status"] = array_of<std::uint8_t>(endings.status);
  dict["words"] = endings.words;
}

py::dict collide(PreparedPair& pair, const Doubles& matrices, unsigned threads) {
  const std::vector<Pose> poses = poses_of(matrices);
  py::array_t<bool> colliding(static_cast<py::ssize_t>(poses.size()));
  bool* const out = colliding.mutable_data();
  std::fill_n(out, poses.size(), false);
  const Endings endings = ask_all<bool>(
      pair, poses, threads, [](Query& query, const Pose& pose) { return query.collide(pose); },
      [out](std::size_t place, bool answer) { out[place] = answer; });
  py::dict dict;
  dict["colliding"] = colliding;
  add(dict, endings);
  return dict;
}

std::int64_t index_of(std::uint32_t triangle) {
  return triangle == Separation::k_no_triangle ? -1 : std::int64_t{triangle};
}

/// Writes three numbers to row `place`.
void write_row(double* rows, std::size_t place, const Eigen::Vector3d& vector) {
  Eigen::Map<Eigen::Vector3d>(rows + 3 * place) = vector;
}

py::dict distance(PreparedPair& pair, const Doubles& matrices, unsigned threads) {
  const std::vector<Pose> poses = poses_of(matrices);
  const auto n = static_cast<py::ssize_t>(poses.size());
  Doubles distances = nan_array({n}), points_a = nan_array({n, 3}), points_b = nan_array({n, 3});
  py::array_t<std::int64_t> triangles({n, py::ssize_t{2}});
  double* const gap = distances.mutable_data();
  double* const a = points_a.mutable_data();
  double* const b = points_b.mutable_data();
  std::int64_t* const triangle = triangles.mutable_data();
  std::fill_n(triangle, 2 * poses.size(), std::int64_t{-1});
  const Endings endings = ask_all<Separation>(
      pair, poses, threads, [](Query& query, const Pose& pose) { return query.distance(pose); },
      [=](std::size_t place, const Separation& answer) {
        gap[place] = answer.distance;
        if (!answer.has_witnesses) return;
        write_row(a, place, answer.witness_a);
        write_row(b, place, answer.witness_b);
        triangle[2 * place] = index_of(answer.triangle_a);
        triangle[2 * place + 1] = index_of(answer.triangle_b);
      });
  py::dict dict;
  dict["distance"] = distances;
  dict["points_a"] = points_a;
  dict["points_b"] = points_b;
  dict["triangles"] = triangles;
  add(dict, endings);
  return dict;
}

py::dict respond(PreparedPair& pair, const Doubles& matrices, unsigned threads) {
  const std::vector<Pose> poses = poses_of(matrices);
  const auto n = static_cast<py::ssize_t>(poses.size());
  Doubles penalties = nan_array({n}), volumes = nan_array({n});
  Doubles forces = nan_array({n, 3}), torques = nan_array({n, 3}), references = nan_array({n, 3});
  double* const penalty = penalties.mutable_data();
  double* const volume = volumes.mutable_data();
  double* const force = forces.mutable_data();
  double* const torque = torques.mutable_data();
  double* const reference = references.mutable_data();
  const Endings endings = ask_all<Response>(
      pair, poses, threads, [](Query& query, const Pose& pose) { return query.respond(pose); },
      [=](std::size_t place, const Response& answer) {
        penalty[place] = answer.penalty;
        volume[place] = answer.volume;
        write_row(force, place, answer.force);
        write_row(torque, place, answer.torque);
        write_row(reference, place, answer.reference);
      });
  py::dict dict;
  dict["penalty"] = penalties;
  dict["volume"] = volumes;
  dict["force"] = forces;
  dict["torque"] = torques;
  dict["reference"] = references;
  add(dict, endings);
  return dict;
}

py::dict cast(PreparedPair& pair, const Doubles& matrices, const Doubles& translations, const Doubles& rotations,
              const Doubles& references, unsigned threads) {
  const std::vector<Motion> motions = motions_of(matrices, translations, rotations, references);
  const auto n = static_cast<py::ssize_t>(motions.size());
  py::array_t<bool> hits(n);
  Doubles times = nan_array({n}), points_a = nan_array({n, 3}), points_b = nan_array({n, 3}),
          normals = nan_array({n, 3});
  bool* const hit = hits.mutable_data();
  std::fill_n(hit, motions.size(), false);
  double* const t = times.mutable_data();
  double* const a = points_a.mutable_data();
  double* const b = points_b.mutable_data();
  double* const normal = normals.mutable_data();
  const Endings endings = ask_all<Impact>(
      pair, motions, threads, [](Query& query, const Motion& motion) { return query.cast(motion); },
      [=](std::size_t place, const Impact& answer) {
        hit[place] = answer.hit;
        if (!answer.hit) return;
        t[place] = answer.t;
        if (!answer.normal.isZero(0.0)) write_row(normal, place, answer.normal);
        if (!answer.has_witnesses) return;
        write_row(a, place, answer.witness_a);
        write_row(b, place, answer.witness_b);
      });
  py::dict dict;
  dict["hit"] = hits;
  dict["t"] = times;
  dict["points_a"] = points_a;
  dict["points_b"] = points_b;
  dict["normal"] = normals;
  add(dict, endings);
  return dict;
}

py::dict footprint(const PreparedPair& pair) {
  const Footprint footprint = pair.footprint();
  py::dict dict;
  dict["bytes"] = footprint.bytes;
  for (const auto& [name, count] : footprint.counts) dict[py::str(name)] = count;
  return dict;
}

}  // namespace

const Registry& all_algorithms() {
  static const std::unique_ptr<const Registry> registry = [] {
    auto made = std::make_unique<Registry>();
    register_all_algorithms(*made, {}, "sixdof (Python)");
    return made;
  }();
  return *registry;
}

Settings settings_of(const Algorithm& algorithm, const Parameters& parameters) {
  Settings settings = algorithm.settings();
  for (const auto& [name, text] : parameters) {
    try {
      settings.set(name, text);
    } catch (const BadArgument& e) {
      throw BadArgument(fmt::format("{}: {}", algorithm.traits().name, e.what()));
    }
  }
  return settings;
}

void bind_queries(py::module_& module) {
  py::class_<PreparedPair, std::shared_ptr<PreparedPair>>(module, "PreparedPair")
      .def_property_readonly("settings", [](const PreparedPair& pair) { return pair.settings().to_string(); })
      .def_property_readonly("prepared", &PreparedPair::prepared)
      .def("footprint", footprint)
      .def("collide", collide, py::arg("poses"), py::arg("threads"))
      .def("distance", distance, py::arg("poses"), py::arg("threads"))
      .def("respond", respond, py::arg("poses"), py::arg("threads"))
      .def("cast", cast, py::arg("poses"), py::arg("translations"), py::arg("rotations"), py::arg("references"),
           py::arg("threads"));
  module.def("algorithms", list_algorithms);
  module.def("prepare", prepare, py::arg("name"), py::arg("a"), py::arg("b"), py::arg("parameters"), py::arg("server"),
             py::arg("query_timeout"));
  py::list words;
  for (int status = 0; status <= static_cast<int>(Status::out_of_memory); ++status) {
    words.append(std::string(to_string(static_cast<Status>(status))));
  }
  module.attr("statuses") = py::tuple(words);
}

}  // namespace sixdof::python
