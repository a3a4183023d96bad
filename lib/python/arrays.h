#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <pybind11/numpy.h>
#include <Eigen/Core>

#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/pose.h>

/// Between NumPy's arrays and the library's types.
namespace sixdof::python {

namespace py = pybind11;

/// An array of doubles in C order; what is passed is converted to it.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Largest deviation of R^T R from the identity that counts as rounding, of matrices that went through single precision
/// (6e-8 per entry) and a few products.
inline constexpr double k_rotation_tolerance = 1e-5;

/// The poses of an array of shape (n, 4, 4), with points as columns: [R t; 0 1]. A pose with an entry that is not
/// finite is passed on, for the algorithm to say so.
/// @throws BadArgument "poses[i]: ..." for another last row, and for a matrix that is no rotation
std::vector<Pose> poses_of(const Doubles& matrices);

/// The motions of starts, an array of shape (n, 4, 4) as poses_of() takes it, and three arrays of shape (n, 3): of
/// translations and rotation vectors in A's frame, and of reference points in B's. What is not finite is passed on.
/// @throws BadArgument as poses_of() does, and for other shapes
std::vector<Motion> motions_of(const Doubles& matrices, const Doubles& translations, const Doubles& rotations,
                               const Doubles& references);

/// An array of shape (n, 4, 4).
Doubles matrices_of(std::span<const Pose> poses);

/// An array of shape (n, 3).
Doubles rows_of(std::span<const Eigen::Vector3d> vectors);

/// An array of shape (n,).
template <class T>
py::array_t<T> array_of(std::span<const T> values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// The three numbers of a vector, as an array of shape (3,).
Doubles array_of(const Eigen::Vector3d& vector);

/// An array of NaN.
Doubles nan_array(std::vector<py::ssize_t> shape);

}  // namespace sixdof::python
