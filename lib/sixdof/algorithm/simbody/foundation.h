#pragma once

#include <array>
#include <memory>
#include <vector>

namespace sixdof {

/// Two bodies with Simbody's elastic foundation on both surfaces, without Eigen: its headers and Simbody's do not go
/// together. Stiffness 1, no dissipation, no friction.
class Foundation {
 public:
  struct Surface {
    std::vector<double> vertices;  ///< x, y, z of each.
    std::vector<int> corners;      ///< Three of each triangle.
  };

  /// What Simbody's forces on B amount to, in A's frame.
  struct Forces {
    bool contact = false;               ///< Whether Simbody reports a contact.
    double energy = 0.0;                ///< Of all springs: a quarter of the sum of area * displacement^2 (length^4).
    std::array<double, 3> force = {};   ///< On B (length^3).
    std::array<double, 3> torque = {};  ///< On B about the origin of B's frame (length^4).
  };

  /// @throws std::exception if Simbody refuses a mesh: it takes closed manifold ones
  Foundation(const Surface& a, const Surface& b);
  ~Foundation();

  /// @param R row by row, and t: the pose of B in A's frame
  /// @throws std::exception if Simbody does
  Forces forces(const std::array<double, 9>& R, const std::array<double, 3>& t);

  bool contact(const std::array<double, 9>& R, const std::array<double, 3>& t);

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace sixdof
