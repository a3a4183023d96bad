#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/base/error.h>
#include <sixdof/report/series.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/path_settings.h>
#include <sixdof/scenario/scenario.h>
#include "lib/python/arrays.h"
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

py::dict measures_of(const Measures& measures) {
  py::dict dict;
  for (const auto& [name, value] : measures) dict[py::str(name)] = value;
  return dict;
}

py::array_t<std::uint8_t> statuses_of(const Recording& recording) {
  std::vector<std::uint8_t> statuses;
  for (const Status status : recording.status) statuses.push_back(static_cast<std::uint8_t>(status));
  return array_of<std::uint8_t>(statuses);
}

/// Asks an algorithm along a scenario's path, as `sixdof quality` does.
py::dict record_signals(const std::string& scenario_name, const Parameters& shape, const std::string& algorithm_name,
                        const Parameters& parameters, std::size_t steps, const std::string& law_word,
                        const std::string& file) {
  Settings shape_settings = scenario_settings(scenario_name);
  for (const auto& [name, text] : shape) shape_settings.set(name, text);
  const Algorithm& algorithm = all_algorithms().find(algorithm_name);
  const Traits& traits = algorithm.traits();
  if (!traits.answers.respond) throw BadArgument(fmt::format("algorithm: {} gives no response", traits.name));
  settings_of(algorithm, parameters);  // throws with the algorithm's name
  std::vector<std::string> assignments;
  for (const auto& [name, text] : parameters) assignments.push_back(fmt::format("{}={}", name, text));
  const Settings settings = settings_along(scenario_name, algorithm, assignments);
  const IdealLaw law = parse_ideal_law(law_word, traits);
  Recording recording;
  Measures measures;
  std::unique_ptr<Ideals> ideals;
  {
    const py::gil_scoped_release release;
    const auto scenario = make_scenario(scenario_name, shape_settings);
    const auto query = algorithm.prepare(scenario->a(), scenario->b(), settings);
    recording = record(*scenario, *query, steps);
    measures = evaluate(*scenario, recording, law);
    for (const auto& measure : evaluate_jumps(*scenario, *query, recording, law)) measures.push_back(measure);
    ideals = std::make_unique<Ideals>(*scenario, recording, law);
    if (!file.empty()) {
      const SeriesSource source{traits.name, traits.version, settings.to_string(), shape_settings.to_string()};
      write_series(file, *scenario, recording, law, source, measures);
    }
  }
  py::dict dict;
  dict["scenario"] = scenario_name;
  dict["law"] = std::string(to_string(law));
  dict["algorithm"] = traits.name;
  dict["version"] = traits.version;
  dict["settings"] = settings.to_string();
  dict["rate_hz"] = k_haptic_rate_hz;
  dict["poses"] = matrices_of(recording.poses);
  dict["status"] = statuses_of(recording);
  dict["force"] = rows_of(recording.forces);
  dict["torque"] = rows_of(recording.torques);
  dict["ideal_force"] = rows_of(ideals->forces);
  dict["ideal_torque"] = rows_of(ideals->torques);
  dict["measures"] = measures_of(measures);
  dict["first_failure"] = recording.first_failure;
  return dict;
}

Doubles rows_of_arrays(const report::Series::Vectors& vectors) {
  Doubles rows({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  double* place = rows.mutable_data();
  for (const auto& vector : vectors) place = std::copy_n(vector.data(), 3, place);
  return rows;
}

/// The same of a file of `sixdof quality -o`.
py::dict read_signals(const std::string& file) {
  report::Series series;
  {
    const py::gil_scoped_release release;
    series = report::read_series(file);
  }
  std::vector<Pose> poses;
  for (const auto& p : series.poses) {
    poses.push_back(Pose::from_quaternion(p[0], p[1], p[2], p[3], {p[4], p[5], p[6]}));
  }
  std::vector<std::uint8_t> statuses;
  for (const double status : series.status) statuses.push_back(static_cast<std::uint8_t>(status));
  py::dict dict;
  dict["scenario"] = series.scenario;
  dict["law"] = series.law;
  dict["algorithm"] = series.algorithm;
  dict["version"] = series.version;
  dict["settings"] = series.settings;
  dict["rate_hz"] = series.rate_hz;
  dict["poses"] = matrices_of(poses);
  dict["status"] = array_of<std::uint8_t>(statuses);
  dict["force"] = rows_of_arrays(series.force);
  dict["torque"] = rows_of_arrays(series.torque);
  dict["ideal_force"] = rows_of_arrays(series.ideal_force);
  dict["ideal_torque"] = rows_of_arrays(series.ideal_torque);
  return dict;
}

}  // namespace

void bind_scenarios(py::module_& module) {
  module.def("scenarios", scenario_names);
  module.def("record_signals", record_signals, py::arg("scenario"), py::arg("shape"), py::arg("algorithm"),
             py::arg("parameters"), py::arg("steps"), py::arg("law"), py::arg("file"));
  module.def("read_signals", read_signals, py::arg("file"));
}

}  // namespace sixdof::python
