#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sixdof/geometry/motion.h>
#include <sixdof/oracle/near_query.h>
#include <sixdof/scene/bodies.h>

/// What happens between two frames: how bodies move from one to the next, and when two of them first touch. Internal:
/// use scene_algorithm.h.
namespace sixdof::scene::detail {

/// Between frames the centre of a body's box moves on a straight line at constant speed, and the body turns about it at
/// constant speed the shorter way. Time t goes from 0 at the frame before to 1 at this one.
class Sweeps {
 public:
  /// Surfaces as close as this part of the sum of both radii touch.
  static constexpr double k_touching = 1e-9;
  /// Distances after which a pair is left undecided: bodies that pass each other more closely than their motion divided
  /// by this for the whole frame.
  static constexpr std::uint32_t k_most_steps = 1000;

  explicit Sweeps(const Scene& scene, const Bodies& bodies);

  /// All bodies stand still.
  void clear();
  /// A body moves. Call it before Bodies::move(). @param to its pose in this frame
  void add(const Bodies& bodies, std::uint32_t rank, const Pose& to);

  /// By rank, those that move.
  const std::vector<std::uint32_t>& moving() const { return moving_; }
  bool moves(std::uint32_t rank) const { return paths_[rank] > 0.0; }
  /// No point of the body travels further in this frame (length).
  double path(std::uint32_t rank) const { return paths_[rank]; }
  /// Two bodies whose distance at the end of the frame exceeds this did not touch in it (length).
  double reach(std::uint32_t a, std::uint32_t b) const {
    return (paths_[a] + paths_[b]) * (1.0 + 1e-9) + 2.0 * touching(a, b) + rounding_;
  }
  /// The largest reach() of any two (length); 0 if nothing moves.
  double largest_reach() const;

  /// How two bodies come together in a frame.
  struct Contact {
    std::optional<double> t;  ///< Of the first contact; none if there is none, or it is undecided.
    bool undecided = false;   ///< After k_most_steps.
  };
  /// The first t at which two bodies touch that are apart at the frame before; none if they were not apart then, one
  /// inside the other included, or do not touch. By conservative advancement (Mirtich 1996): where the distance is d,
  /// they stay apart until they have travelled d together. The same bits in every algorithm.
  Contact first_contact(const Bodies& bodies, NearQuery& query, std::uint32_t a, std::uint32_t b) const;

 private:
  double touching(std::uint32_t a, std::uint32_t b) const { return k_touching * (radii_[a] + radii_[b]); }
  Pose pose_at(const Bodies& bodies, std::uint32_t rank, double t) const;

  std::vector<Eigen::Vector3d> centers_;  ///< Of a body's mesh, in its frame.
  std::vector<sixdof::Motion> motions_;   ///< Of those that move.
  std::vector<double> radii_;             ///< Of a body about that centre.
  std::vector<double> paths_;             ///< 0 of those that do not.
  std::vector<std::uint32_t> moving_;
  double rounding_ = 0.0;  ///< More than the roundings of poses (length).
};

}  // namespace sixdof::scene::detail
