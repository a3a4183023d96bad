#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include "lib/python/arrays.h"
#include "lib/python/bindings.h"

namespace sixdof::python {
namespace {

using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::shared_ptr<Mesh> load(const std::string& name_or_file) {
  const py::gil_scoped_release release;
  return std::make_shared<Mesh>(load_model(name_or_file));
}

std::vector<Triangle> triangles_of(const Indices& indices) {
  std::vector<Triangle> triangles(static_cast<std::size_t>(indices.shape(0)));
  const auto at = indices.unchecked<2>();
  for (py::ssize_t i = 0; i < indices.shape(0); ++i) {
    for (py::ssize_t k = 0; k < 3; ++k) {
      if (at(i, k) < 0 || at(i, k) > std::numeric_limits<std::uint32_t>::max()) {
        throw BadMesh(fmt::format("triangles[{}]: the vertex index {} is out of range", i, at(i, k)));
      }
      triangles[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(at(i, k));
    }
  }
  return triangles;
}

std::shared_ptr<Mesh> build(const Doubles& vertices, const Indices& triangles, const std::string& name) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3) throw BadMesh("vertices: the shape is not (n, 3)");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) throw BadMesh("triangles: the shape is not (m, 3)");
  std::vector<Eigen::Vector3d> points(static_cast<std::size_t>(vertices.shape(0)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Eigen::Vector3d>(vertices.data(static_cast<py::ssize_t>(i), 0));
  }
  std::vector<Triangle> faces = triangles_of(triangles);
  const py::gil_scoped_release release;
  return std::make_shared<Mesh>(Mesh::build(std::move(points), std::move(faces), name));
}

/// A view of memory that `owner` keeps, (n, 3), that cannot be written.
template <class T>
py::array_t<T> view(const T* data, std::size_t rows, const py::object& owner) {
  py::array_t<T> array({static_cast<py::ssize_t>(rows), py::ssize_t{3}}, data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<Mesh, std::shared_ptr<Mesh>> mesh(
      module, "Mesh", "A triangle mesh in its own frame and length unit; it never changes. Made by load() and mesh().");
  const auto triangles = [](const py::object& self) {
    const auto& m = self.cast<const Mesh&>();
    return view(m.triangles().data()->data(), m.triangles().size(), self);
  };
  const auto vertices = [](const py::object& self) {
    const auto& m = self.cast<const Mesh&>();
    return view(m.vertices().data()->data(), m.vertices().size(), self);
  };
  const auto box = [](const Mesh& m) {
    const std::vector<Eigen::Vector3d> corners{m.box().min(), m.box().max()};
    return rows_of(corners);
  };
  mesh.def_property_readonly("name", &Mesh::name, "Of a file or a model.")
      .def_property_readonly("hash", &Mesh::hash, "Content hash of both arrays: 32 hexadecimal digits.")
      .def_property_readonly("area", &Mesh::area, "Of the surface (length^2).")
      .def_property_readonly("volume", &Mesh::volume, "Signed (length^3); that of a body only where `solid` is true.")
      .def_property_readonly("diagonal", &Mesh::diagonal, "Length of the box's diagonal.")
      .def_property_readonly("solid", &Mesh::solid,
                             "Whether it is closed, consistently oriented and faces outwards: responses need that.")
      .def_property_readonly("why_not_solid", &Mesh::why_not_solid, "Empty if it is.")
      .def_property_readonly(
          "closed", [](const Mesh& m) { return m.topology().closed; }, "Whether there is no border.")
      .def_property_readonly(
          "center", [](const Mesh& m) { return array_of(m.center()); }, "Of the box, shape (3,).")
      .def_property_readonly(
          "centroid", [](const Mesh& m) { return array_of(m.centroid()); },
          "Centre of mass of the enclosed body, shape (3,).")
      .def_property_readonly("box", box, "Lower and upper corner of the axis-aligned bounding box, shape (2, 3).")
      .def_property_readonly("vertices", vertices, "Shape (n, 3), float64; read only, not copied.")
      .def_property_readonly("triangles", triangles,
                             "Shape (m, 3), uint32: indices into `vertices`, counter-clockwise seen from outside; read "
                             "only, not copied.")
      .def_property_readonly("faces", triangles, "The same as `triangles`.")
      .def("__reduce__",
           [](const py::object& self) {
             return py::make_tuple(py::module_::import("sixdof._meshes").attr("named_mesh"),
                                   py::make_tuple(self.attr("vertices"), self.attr("triangles"), self.attr("name")));
           })
      .def("__repr__",
           [](const Mesh& m) { return fmt::format("<Mesh {}: {} triangles>", m.name(), m.triangles().size()); })
      .def(
          "save",
          [](const Mesh& m, const py::object& file) {
            const auto path = py::module_::import("os").attr("fspath")(file).cast<std::string>();
            const py::gil_scoped_release release;
            save_mesh(m, path);
          },
          py::arg("file"), "Writes PLY, OBJ, OFF or STL, whole or not at all. Raises BadFile.");
  module.def("load", load, py::arg("name_or_file"));
  module.def("build_mesh", build, py::arg("vertices"), py::arg("triangles"), py::arg("name"));
}

}  // namespace sixdof::python
