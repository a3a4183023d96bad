#include <filesystem>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/results/results.h>
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

/// One row with what it measures, its numbers by the names of the table of metrics, and the index of its file.
py::dict dict_of(const results::Row& row) {
  const results::RowFields& fields = row.fields;
  py::dict dict;
  dict["name"] = row.name;
  dict["query"] = fields.query;
  dict["algorithm"] = fields.algorithm;
  dict["settings"] = fields.settings;
  dict["pair"] = fields.pair;
  dict["bucket"] = fields.bucket ? fields.bucket->name() : "";
  dict["bucket_kind"] = fields.bucket ? to_string(fields.bucket->kind) : "";
  dict["percent"] = fields.bucket ? py::cast(fields.bucket->percent) : py::none();
  dict["scenario"] = fields.scenario;
  dict["order"] = fields.order;
  dict["cache"] = fields.cache;
  dict["isolated"] = fields.isolated;
  dict["approximates"] = fields.approximates;
  dict["class"] = results::class_of(fields);
  dict["configurations"] = fields.configurations ? py::cast(*fields.configurations) : py::none();
  for (const auto& [name, value] : row.values) dict[py::str(name)] = value;
  dict["label"] = row.label;
  dict["error"] = row.error;
  dict["file"] = row.file;
  return dict;
}

py::tuple read(const std::vector<std::string>& files) {
  results::Results all;
  {
    const py::gil_scoped_release release;
    for (const std::string& file : files) {
      if (!std::filesystem::is_directory(file)) {
        results::read_results(file, all);
        continue;
      }
      const results::Results folder = results::read_folder(file);
      for (const results::Source& source : folder.files) results::read_results(source.path, all);
    }
  }
  py::list rows, sources;
  for (const results::Row& row : all.rows) rows.append(dict_of(row));
  for (const results::Source& source : all.files) {
    py::dict context;
    for (const auto& [key, value] : source.context) context[py::str(key)] = value;
    py::dict dict;
    dict["path"] = source.path;
    dict["kind"] = source.kind;
    dict["context"] = context;
    sources.append(dict);
  }
  return py::make_tuple(rows, sources);
}

}  // namespace

void bind_results(py::module_& module) { module.def("read_results", read, py::arg("files")); }

}  // namespace sixdof::python
