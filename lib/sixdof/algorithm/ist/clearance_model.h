#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/free_space.h>

namespace sixdof::ist {

/// Models of the clearance near several points, one in each slot, side by side for SIMD: the distance to the nearest of
/// the obstacles that the point met last. The same bits on every instruction set, and whatever other slots hold.
class ClearanceModels {
 public:
  static constexpr std::size_t k_slots = 8;
  static constexpr std::size_t k_obstacles = 8;

  /// Empties a slot.
  void reset(std::size_t slot);

  /// Takes the place of the slot's oldest one.
  void add(std::size_t slot, const Obstacle& obstacle);

  /// Before maximise(): where the slot's search starts, and how far it may go.
  void set_start(std::size_t slot, const Eigen::Vector3d& start, double trust);

  /// Finds in each slot the point within `trust` of `start` with the largest modelled clearance: moves away from the
  /// nearest obstacle in shrinking steps. Slots without an obstacle find anything.
  void maximise();

  /// What maximise() found: the point, and its modelled clearance.
  Eigen::Vector3d place(std::size_t slot) const { return vector(lanes_.place, slot); }
  double clearance(std::size_t slot) const { return lanes_.clearance[slot]; }

  using Values = std::array<double, k_slots>;

  /// Arrays over the slots.
  struct alignas(64) Lanes {
    struct {
      std::array<Values, 3> point, normal;
      Values radius;  ///< 0: plane; -infinity: none.
    } obstacles[k_obstacles];
    std::array<Values, 3> start, place;
    Values trust, clearance;
  };

 private:
  static Eigen::Vector3d vector(const std::array<Values, 3>& of, std::size_t slot) {
    return {of[0][slot], of[1][slot], of[2][slot]};
  }

  Lanes lanes_{};
  std::array<std::size_t, k_slots> count_{};  ///< Obstacles that were added.
};

}  // namespace sixdof::ist
