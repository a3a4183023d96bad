#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/measure/direction.h>

/// Poses of two bodies that overlap, with exact responses, and how far other responses are from given ones.

namespace sixdof::test {

/// Exact responses (volume law) at random poses with an overlap volume of at least `min_volume`.
struct ExactResponses {
  std::vector<Pose> poses;
  std::vector<Response> responses;

  ExactResponses(const Mesh& a, const Mesh& b, std::size_t count, double centers_apart, double min_volume) {
    const auto exact = make_exact_algorithm();
    const auto query = exact->prepare(a, b, exact->settings());
    std::mt19937_64 random(count);
    std::normal_distribution<double> normal;
    while (poses.size() < count) {
      Eigen::Quaterniond q;
      Eigen::Vector3d direction;
      for (double& x : q.coeffs()) x = normal(random);
      for (double& x : direction) x = normal(random);
      const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
      const Pose X{R, a.center() + centers_apart * direction.normalized() - R * b.center()};
      const Response response = query->respond(X).value;
      if (response.volume < min_volume) continue;
      poses.push_back(X);
      responses.push_back(response);
    }
  }
};

/// Errors of measured responses against true ones about the same reference points.
struct ResponseErrors {
  double force_degrees = 0.0;   ///< Mean angle between the forces.
  double torque_degrees = 0.0;  ///< Mean angle between the torques.
  double gain = 0.0;            ///< Least-squares factor from true to measured force magnitudes.
  double residual = 0.0;        ///< RMS of measured - gain * true magnitudes, over gain * RMS of the true ones.

  ResponseErrors(const std::vector<Response>& truth, const std::vector<Response>& measured) {
    std::vector<Eigen::Vector3d> true_forces, true_torques, forces, torques;
    double product = 0.0, square = 0.0, squared_errors = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      true_forces.push_back(truth[i].force);
      true_torques.push_back(truth[i].torque);
      forces.push_back(measured[i].force);
      torques.push_back(measured[i].about(truth[i].reference).torque);
      product += truth[i].force.norm() * measured[i].force.norm();
      square += truth[i].force.squaredNorm();
    }
    gain = product / square;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      squared_errors += std::pow(forces[i].norm() - gain * true_forces[i].norm(), 2);
    }
    residual = std::sqrt(squared_errors / square) / gain;
    force_degrees = direction_error(true_forces, forces).gamma_degrees.value();
    torque_degrees = direction_error(true_torques, torques).gamma_degrees.value();
  }
};

}  // namespace sixdof::test
