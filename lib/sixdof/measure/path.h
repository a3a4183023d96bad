#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/signal.h>

namespace sixdof {

/// What appears where nothing should: RMS of `unwanted` over RMS of `wanted`, made a pure number by `scale`, which is
/// 1 / L for a torque that should be none and L for a force that should be none (L: the scenario's reference length).
/// Empty where `wanted` is zero throughout.
std::optional<double> leakage(Vectors unwanted, Vectors wanted, double scale);

/// Shift of the measured series against the ideal one in stamps, positive if it comes late, found where the sum of
/// i_{k-lag} . m_k over the common part, divided by both norms there, is largest; between stamps by a parabola through
/// three values. Searched within +-`reach` stamps. Empty if the
/// best shift is not strictly within that reach (the series are not shifted copies), if the ideal's variation is too small to tell (a shift by
/// `reach` changes the ideal by less than k_lag_contrast of itself) or a series is zero.
std::optional<double> lag(Vectors ideal, Vectors measured, std::size_t reach);

/// 1 - correlation that a shift by `reach` must cause in the ideal itself for a lag to be told apart from rounding.
inline constexpr double k_lag_contrast = 1e-6;

/// Largest jump of a vector function of progress, told apart from a slope by refinement.
struct Jump {
  double coarse = 0.0;   ///< Largest |f(s_k+1) - f(s_k)| between neighbouring stamps.
  double refined = 0.0;  ///< What is left of it after the interval was halved `halvings` times.
  double where = 0.0;    ///< Progress at the refined interval's middle.
};

/// Takes the `candidates` largest differences of neighbouring stamps and halves each interval `halvings` times, always
/// going on with the half that keeps the larger difference. A slope's difference shrinks by 2^halvings, a
/// discontinuity's stays. Unit: that of f. Calls f candidates * halvings times.
Jump largest_jump(std::span<const double> progress, Vectors values, const std::function<Eigen::Vector3d(double)>& f,
                  std::size_t candidates, std::size_t halvings);

/// Work of the wrench along a closed path over (peak force * path length): 0 for a conservative response.
///
/// sum over stamps k (cyclically) of (F_k + F_k+1)/2 . (C_k+1 - C_k) + (T_k + T_k+1)/2 . theta_k, where C is the
/// reference point and theta_k the rotation vector from pose k to pose k+1; peak and length include the turning part,
/// with the torque's peak times the angle. Empty if nothing acts or nothing moves.
/// @param reference_b point the torques are about, in B's frame; forces and torques in A's frame.
std::optional<double> loop_work(Vectors forces, Vectors torques, std::span<const Pose> poses,
                                const Eigen::Vector3d& reference_b);

}  // namespace sixdof
