#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/base/data_folder.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/configuration/set_meshes.h>
#include "lib/python/arrays.h"
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

py::list catalogue(const std::string& manifest) {
  const std::filesystem::path file =
      manifest.empty() ? data_folder() / "fixtures" / "manifest.json" : std::filesystem::path(manifest);
  const SetCatalogue read = SetCatalogue::read(file);
  py::list list;
  for (const CatalogueEntry& entry : read.sets()) {
    py::dict dict;
    dict["pair"] = entry.pair;
    dict["a"] = entry.a;
    dict["b"] = entry.b;
    dict["file"] = entry.file.string();
    py::list buckets;
    for (const BucketKey& key : entry.buckets) buckets.append(key.name());
    dict["buckets"] = py::tuple(buckets);
    list.append(dict);
  }
  return list;
}

py::dict dict_of(const BucketSummary& bucket) {
  py::dict dict;
  dict["name"] = bucket.key.name();
  dict["kind"] = to_string(bucket.key.kind);
  dict["percent"] = bucket.key.percent;
  dict["nominal"] = bucket.nominal;
  dict["target"] = bucket.target;
  dict["tolerance"] = bucket.tolerance;
  dict["largest_residual"] = bucket.largest_residual;
  dict["reachable"] = bucket.reachable;
  dict["oracle"] = bucket.oracle;
  return dict;
}

py::list buckets(const ConfigurationSet& set) {
  py::list list;
  for (const BucketSummary& bucket : set.buckets()) list.append(dict_of(bucket));
  return list;
}

std::shared_ptr<Mesh> mesh_of(const ConfigurationSet& set, bool is_b, const std::string& instead) {
  const py::gil_scoped_release release;
  const SetDescription& description = set.description();
  return std::make_shared<Mesh>(find_mesh(is_b ? description.b : description.a, set.path(), instead));
}

py::dict sample(const ConfigurationSet& set, const std::string& bucket, const Mesh& a, const Mesh& b, std::size_t count,
                std::uint64_t seed) {
  BucketSample drawn;
  {
    const py::gil_scoped_release release;
    set.check_meshes(a, b);
    drawn = sample_bucket(set, BucketKey::parse(bucket), a, b, count, seed);
  }
  py::dict dict;
  dict["poses"] = matrices_of(drawn.poses);
  dict["cells"] = array_of<std::uint64_t>(drawn.cells);
  dict["target"] = drawn.target;
  dict["tolerance"] = drawn.tolerance;
  return dict;
}

/// [rotation][direction]
Doubles translations(const ConfigurationSet& set, const std::string& bucket) {
  const BucketKey key = BucketKey::parse(bucket);
  std::vector<double> values;
  {
    const py::gil_scoped_release release;
    values = set.read(key);
  }
  const Grid& grid = set.grid(key.kind);
  return Doubles({static_cast<py::ssize_t>(grid.rotations.size()), static_cast<py::ssize_t>(grid.directions.size())},
                 values.data());
}

Doubles rotations(const ConfigurationSet& set, const std::string& bucket) {
  const Grid& grid = set.grid(BucketKey::parse(bucket).kind);
  Doubles rows({static_cast<py::ssize_t>(grid.rotations.size()), py::ssize_t{4}});
  double* place = rows.mutable_data();
  for (const Eigen::Vector4d& rotation : grid.rotations) place = std::copy_n(rotation.data(), 4, place);
  return rows;
}

Doubles directions(const ConfigurationSet& set, const std::string& bucket) {
  return rows_of(set.grid(BucketKey::parse(bucket).kind).directions);
}

}  // namespace

void bind_sets(py::module_& module) {
  py::class_<ConfigurationSet, std::shared_ptr<ConfigurationSet>>(module, "ConfigurationSet")
      .def_property_readonly("hash", &ConfigurationSet::hash)
      .def_property_readonly("a_name", [](const ConfigurationSet& set) { return set.description().a.name; })
      .def_property_readonly("b_name", [](const ConfigurationSet& set) { return set.description().b.name; })
      .def_property_readonly(
          "same_mesh", [](const ConfigurationSet& set) { return set.description().a.hash == set.description().b.hash; })
      .def("buckets", buckets)
      .def("mesh", mesh_of, py::arg("is_b"), py::arg("instead"))
      .def("sample", sample, py::arg("bucket"), py::arg("a"), py::arg("b"), py::arg("count"), py::arg("seed"))
      .def("translations", translations, py::arg("bucket"))
      .def("rotations", rotations, py::arg("bucket"))
      .def("directions", directions, py::arg("bucket"));
  module.def("catalogue", catalogue, py::arg("manifest"));
  module.def(
      "open_set", [](const std::string& file) { return std::make_shared<ConfigurationSet>(file); }, py::arg("file"));
}

}  // namespace sixdof::python
