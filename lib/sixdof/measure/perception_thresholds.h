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

/// Just noticeable change of a force's direction in degrees. Published: 18 to 32, depending on what the subject sees.
/// Barbagli, Salisbury, Ho, Spence, Tan, "Haptic discrimination of force direction and the influence of visual
/// information", ACM Transactions on Applied Perception 3 (2006).
inline constexpr double k_direction_degrees = 30.0;

/// Vibration of the ball of the thumb under a contactor of 2.9 cm^2 or more: the threshold of displacement is flat up
/// to the first frequency, falls by 12 dB an octave to the second, where it is least, and rises beyond. Verrillo,
/// "Effect of contactor area on the vibrotactile threshold", Journal of the Acoustical Society of America 35 (1963);
/// both frequencies and the slope as Gescheider and Verrillo sum them up in "Sensory Functions of the Skin of Humans"
/// (1979). The rise beyond is assumed to mirror the fall; scores end at 300 Hz, so it hardly matters.
inline constexpr double k_flat_until_hz = 40.0;
inline constexpr double k_most_sensitive_hz = 250.0;   ///< The second frequency.
inline constexpr double k_slope_db_per_octave = 12.0;  ///< Between the two.
/// Peak displacement at k_most_sensitive_hz, in m: a round figure for a contactor on the skin, not a value that his
/// paper prints. A grasped handle is felt at less: below 0.01 um by some of the subjects of Brisben, Hsiao and Johnson,
/// "Detection of vibration transmitted through an object grasped in the hand", Journal of Neurophysiology 81 (1999),
/// most at 150 to 200 Hz. Scores of vibration are thus low rather than high.
inline constexpr double k_least_displacement = 0.1e-6;

/// Vibration outside of this band is not scored: below it is motion, which magnitude and direction score.
inline constexpr double k_vibration_from_hz = 40.0;
inline constexpr double k_vibration_to_hz = 300.0;  ///< Upper end of the band.

/// Delay of a touch behind the hand's motion, in ms, from which textures feel changed, and from which it is noticed.
/// Okamoto, Konyo, Saga, Tadokoro, "Detectability and perceptual consequences of delayed feedback in a vibrotactile
/// texture display", IEEE Transactions on Haptics 2 (2009): about 40 and 60 ms.
inline constexpr double k_delay_changes_ms = 40.0;
inline constexpr double k_delay_noticed_ms = 60.0;  ///< From which it is noticed.

/// Assumptions about the device, which the scores of vibration are proportional to: the peak of a response is scaled to
/// this force, in N, and handle and fingers respond to vibration like this mass, in kg.
inline constexpr double k_full_force = 5.0;
inline constexpr double k_felt_mass = 0.1;  ///< The mass.

/// A line for a reader: what is scored, what scores 1, from where.
struct Threshold {
  std::string_view score;   ///< Its name.
  std::string_view unit;    ///< What scores 1.
  std::string_view source;  ///< Who published it.
};
/// One for each score, for pages and documents.
inline constexpr std::array k_thresholds{
    Threshold{"magnitude", "10 % of the force", "Pang, Tan, Durlach 1991: 7 to 10 %"},
    Threshold{"direction", "30 degrees", "Barbagli, Salisbury, Ho, Spence, Tan 2006: 18 to 32 degrees"},
    Threshold{"vibration", "0.1 um at 250 Hz, 12 dB more an octave below, flat under 40 Hz",
              "Verrillo 1963 (level rounded; a grasped handle is felt up to 20 dB better, Brisben et al. 1999); peak "
              "force sent as 5 N to 0.1 kg (assumed)"},
    Threshold{"jump", "10 % of the peak within a step", "Pang, Tan, Durlach 1991, applied to one step"},
    Threshold{"delay (not pooled)", "40 ms: textures feel changed; 60 ms: noticed",
              "Okamoto, Konyo, Saga, Tadokoro 2009; under update rates"},
};

}  // namespace sixdof::perception
