#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/magnitude.h>

/// Measures of a force or torque series along a path. A path is a sequence of steps; progress runs over it from 0 to 1.

namespace sixdof {

/// RMS of `unwanted`, which should be zero, over RMS of `wanted`, times `scale`. The scale makes a pure number of it:
/// 1 / L for an unwanted torque, L for an unwanted force (L: the scenario's reference length).
/// Empty where `wanted` is zero throughout.
std::optional<double> leakage(Vectors unwanted, Vectors wanted, double scale);

/// Shift of the measured series against the ideal one in steps, positive if the measured one is late. The shift
/// maximises the sum of i_{k-lag} . m_k over the common part, divided by both norms there; a parabola through the three
/// values around the maximum gives the fraction of a step. Shifts from -reach to +reach are tried.
/// Empty if the maximum lies at either end of that range (the series are not shifted copies), if a shift by `reach`
/// changes the ideal by less than k_lag_contrast of itself, or if a series is zero.
std::optional<double> lag(Vectors ideal, Vectors measured, std::size_t reach);

/// 1 - correlation of the ideal with itself shifted by `reach`: below this a lag cannot be told from rounding.
inline constexpr double k_lag_contrast = 1e-6;

/// Largest jump of a vector function `f` of progress, in the unit of f. The `candidates` largest differences between
/// neighbouring steps are refined: each interval is halved `halvings` times, keeping the half with the larger
/// difference. The difference across a slope shrinks by 2^halvings, that across a discontinuity remains; the largest
/// remaining difference is returned. 0 for fewer than two steps. Calls f candidates * halvings times.
/// @param progress of each step, increasing; @param values f at each step
double largest_jump(std::span<const double> progress, Vectors values, const std::function<Eigen::Vector3d(double)>& f,
                    std::size_t candidates, std::size_t halvings);

/// Work of the wrench along a closed path over (peak force * path length): 0 for a conservative response.
///
/// sum over steps k (cyclically) of (F_k + F_k+1)/2 . (C_k+1 - C_k) + (T_k + T_k+1)/2 . theta_k, where C is the
/// reference point and theta_k the rotation vector from pose k to pose k+1. The denominator includes the rotation: peak
/// torque * sum of the angles. Empty if the wrench is zero throughout or B does not move.
/// @param forces,torques in A's frame; @param reference_b point the torques are about, in B's frame
std::optional<double> loop_work(Vectors forces, Vectors torques, std::span<const Pose> poses,
                                const Eigen::Vector3d& reference_b);

}  // namespace sixdof
