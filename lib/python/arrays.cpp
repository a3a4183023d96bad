#include "lib/python/arrays.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <Eigen/LU>

#include <sixdof/base/error.h>

namespace sixdof::python {
namespace {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

Pose pose_of(const Eigen::Map<const Matrix4>& matrix, std::size_t place) {
  const Pose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw BadArgument(fmt::format("poses[{}]: the last row is not 0, 0, 0, 1", place));
  }
  if (!matrix.allFinite()) return pose;
  if (!(pose.R.transpose() * pose.R).isIdentity(k_rotation_tolerance) || pose.R.determinant() < 0.0) {
    throw BadArgument(fmt::format("poses[{}]: the upper left 3 x 3 entries are not a rotation", place));
  }
  return pose;
}

}  // namespace

std::vector<Pose> poses_of(const Doubles& matrices) {
  if (matrices.ndim() != 3 || matrices.shape(1) != 4 || matrices.shape(2) != 4) {
    throw BadArgument("poses: the shape is not (n, 4, 4)");
  }
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(matrices.shape(0)));
  for (py::ssize_t i = 0; i < matrices.shape(0); ++i) {
    poses.push_back(pose_of(Eigen::Map<const Matrix4>(matrices.data(i, 0, 0)), static_cast<std::size_t>(i)));
  }
  return poses;
}

std::vector<Motion> motions_of(const Doubles& matrices, const Doubles& translations, const Doubles& rotations,
                               const Doubles& references) {
  for (const Doubles* const vectors : {&translations, &rotations, &references}) {
    if (vectors->ndim() != 2 || vectors->shape(0) != matrices.shape(0) || vectors->shape(1) != 3) {
      throw BadArgument("translations, rotations, references: the shape is not (n, 3)");
    }
  }
  std::vector<Motion> motions;
  for (const Pose& start : poses_of(matrices)) {
    const auto i = static_cast<py::ssize_t>(motions.size());
    const auto vector = [i](const Doubles& vectors) { return Eigen::Vector3d(vectors.data(i, 0)); };
    motions.push_back({start, vector(translations), vector(rotations), vector(references)});
  }
  return motions;
}

Doubles matrices_of(std::span<const Pose> poses) {
  Doubles matrices({static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* place = matrices.mutable_data();
  for (const Pose& pose : poses) {
    Eigen::Map<Matrix4> matrix(place);
    matrix << pose.R, pose.t, Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
    place += 16;
  }
  return matrices;
}

Doubles rows_of(std::span<const Eigen::Vector3d> vectors) {
  Doubles rows({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  double* place = rows.mutable_data();
  for (const Eigen::Vector3d& vector : vectors) place = std::copy_n(vector.data(), 3, place);
  return rows;
}

Doubles array_of(const Eigen::Vector3d& vector) { return Doubles(3, vector.data()); }

Doubles nan_array(std::vector<py::ssize_t> shape) {
  Doubles array(std::move(shape));
  std::fill_n(array.mutable_data(), array.size(), std::numeric_limits<double>::quiet_NaN());
  return array;
}

}  // namespace sixdof::python
