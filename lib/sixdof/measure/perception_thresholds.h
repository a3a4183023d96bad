#pragma once

#include <array>
#include <string_view>

/// What a person can just feel, as published, and what a model of the device must assume. All figures of the perceptual
/// scores are here.

namespace sixdof::perception {

/// Just noticeable change of a force's magnitude, as a fraction of it. Published: 0.07 to 0.10 over a wide range of
/// forces. Pang, Tan, Durlach, "Manual discrimination of force using active finger motion", Perception & Psychophysics
/// 49 (1991).
inline constexpr double k_force_fraction = 0.10;

/// Just noticeable change of a force's direction in degrees. Published: 18 to 32, by what the eye sees meanwhile.
/// Barbagli, Salisbury, Ho, Spence, Tan, "Haptic discrimination of force direction and the influence of visual
/// information", ACM Transactions on Applied Perception 3 (2006).
inline constexpr double k_direction_degrees = 30.0;

/// Vibration of the palm under a large contactor: the threshold of displacement is flat up to the first frequency,
/// falls by 12 dB an octave to the second, where it is least, and rises beyond. Verrillo, "Effect of contactor area on
/// the vibrotactile threshold", Journal of the Acoustical Society of America 35 (1963); slopes as summed up by
/// Gescheider and Verrillo in "Sensory Functions of the Skin of Humans" (1979).
inline constexpr double k_flat_until_hz = 40.0;
inline constexpr double k_most_sensitive_hz = 250.0;
inline constexpr double k_slope_db_per_octave = 12.0;
/// Peak displacement at k_most_sensitive_hz, in m. Published thresholds of healthy adults lie around it, within 10 dB.
inline constexpr double k_least_displacement = 0.1e-6;

/// Vibration outside of this band is not scored: below it is motion, which magnitude and direction score.
inline constexpr double k_vibration_from_hz = 40.0, k_vibration_to_hz = 300.0;

/// Assumptions about the device, which the scores of vibration are proportional to: the peak of a response is sent as
/// this force, in N, and handle with fingers answers to vibration as this mass, in kg.
inline constexpr double k_full_force = 5.0, k_felt_mass = 0.1;

/// A line for a reader: what is scored, what scores 1, from where.
struct Threshold {
  std::string_view score, unit, source;
};
inline constexpr std::array k_thresholds{
    Threshold{"magnitude", "10 % of the force", "Pang, Tan, Durlach 1991: 7 to 10 %"},
    Threshold{"direction", "30 degrees", "Barbagli, Salisbury, Ho, Spence, Tan 2006: 18 to 32 degrees"},
    Threshold{"vibration", "just felt, 40 to 300 Hz", "Verrillo 1963; peak force sent as 5 N to 0.1 kg (assumed)"},
    Threshold{"jump", "10 % of the peak within a step", "Pang, Tan, Durlach 1991, applied to one step"},
};

}  // namespace sixdof::perception
