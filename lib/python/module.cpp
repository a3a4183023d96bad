#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

void raise(const char* name, const std::exception& e) {
  const py::object type = py::module_::import("sixdof._errors").attr(name);
  PyErr_SetString(type.ptr(), e.what());
}

/// The library's errors become those of sixdof._errors.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const BadFile& e) {
    raise("BadFile", e);
  } catch (const BadMesh& e) {
    raise("BadMesh", e);
  } catch (const BadArgument& e) {
    raise("BadArgument", e);
  } catch (const Interrupted& e) {
    PyErr_SetString(PyExc_KeyboardInterrupt, e.what());
  } catch (const Error& e) {
    raise("Error", e);
  }
}

void set_data_folder(const std::string& folder) { const LinkedDataFolder linked{std::filesystem::path(folder)}; }

}  // namespace
}  // namespace sixdof::python

PYBIND11_MODULE(_core, module) {
  namespace python = sixdof::python;
  module.doc() = "What sixdof's Python files are made of: the C++ library.";
  module.attr("version") = SIXDOF_VERSION;
  module.attr("takes_numpy_2") = PYBIND11_VERSION_HEX >= 0x020C0000;  // 2.12 knows its layout of types
  pybind11::register_exception_translator(python::translate);
  module.def("set_data_folder", python::set_data_folder, pybind11::arg("folder"));
  module.def("data_folder", [] { return sixdof::data_folder().string(); });
  python::bind_meshes(module);
  python::bind_queries(module);
  python::bind_sets(module);
  python::bind_scenes(module);
  python::bind_scenarios(module);
  python::bind_results(module);
}
