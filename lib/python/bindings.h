#pragma once

#include <map>
#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include <sixdof/geometry/mesh.h>
#include <sixdof/query/registry.h>

/// The parts of the module sixdof._core, each in a source of its own. The package's Python files are what users see:
/// they check and convert arguments, and have the documentation.
namespace sixdof::python {

namespace py = pybind11;

void bind_meshes(py::module_& module);     ///< Mesh, load, save.
void bind_queries(py::module_& module);    ///< The list of algorithms, and pairs prepared for queries.
void bind_sets(py::module_& module);       ///< Catalogue, configuration sets.
void bind_scenes(py::module_& module);     ///< Scenes and answers to their questions.
void bind_scenarios(py::module_& module);  ///< Signals along the paths of scenarios.
void bind_results(py::module_& module);    ///< Rows of result files.

/// Every algorithm of this build and every rival that is set up. Made at the first call.
const Registry& all_algorithms();

/// Parameters as a user gave them: names and texts of values.
using Parameters = std::map<std::string, std::string>;

/// The settings of an algorithm with some parameters set. @throws BadArgument naming the algorithm and the parameter
Settings settings_of(const Algorithm& algorithm, const Parameters& parameters);

}  // namespace sixdof::python
