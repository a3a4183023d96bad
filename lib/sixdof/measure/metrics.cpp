#include <sixdof/measure/metrics.h>

#include <algorithm>
#include <array>
#include <string>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr std::string_view k_paper = "Weller et al. 2010";

constexpr std::array k_metrics{
    Metric{"sigma_F", "1", Better::lower, "RMS difference of force magnitudes, each normalised by its maximum",
           "Weller et al. 2010 (1), read as RMS"},
    Metric{"sigma_T", "1", Better::lower, "the same for torques", "Weller et al. 2010 (1), read as RMS"},
    Metric{"sigma_paper_F", "1", Better::lower, "sigma_F as printed, (1/N) sqrt(sum): depends on the sampling",
           "Weller et al. 2010 (1), literally"},
    Metric{"sigma_paper_T", "1", Better::lower, "the same for torques", "Weller et al. 2010 (1), literally"},
    Metric{"gain_F", "measured/ideal", Better::neither, "least-squares factor from ideal to measured magnitudes",
           "lib/measure/magnitude.h"},
    Metric{"gain_T", "measured/ideal", Better::neither, "the same for torques", "lib/measure/magnitude.h"},
    Metric{"sigma_gain_F", "1", Better::lower, "RMS difference after the gain, over gain times the ideal's maximum",
           "lib/measure/magnitude.h"},
    Metric{"sigma_gain_T", "1", Better::lower, "the same for torques", "lib/measure/magnitude.h"},
    Metric{"gamma_F_deg", "degree", Better::lower, "mean angle between ideal and measured force",
           "Weller et al. 2010 (2)"},
    Metric{"gamma_T_deg", "degree", Better::lower, "the same for torques", "Weller et al. 2010 (2)"},
    Metric{"gamma_max_F_deg", "degree", Better::lower, "largest such angle of forces", "lib/measure/direction.h"},
    Metric{"gamma_max_T_deg", "degree", Better::lower, "largest such angle of torques", "lib/measure/direction.h"},
    Metric{"misses", "stamps", Better::lower, "ideal acts, measured is zero: tunnelling", "lib/measure/direction.h"},
    Metric{"false_contacts", "stamps", Better::lower, "measured acts, ideal is zero", "lib/measure/direction.h"},
    Metric{"skipped", "stamps", Better::neither, "both are zero", "lib/measure/direction.h"},
    Metric{"failed", "stamps", Better::lower, "no answer; left out of sigma and gamma, zero in the spectra",
           "lib/scenario/evaluation.h"},
    Metric{"nu_F", "1", Better::nearer_one, "energy of the normalised force magnitude over the ideal's",
           "Weller et al. 2010 (3)"},
    Metric{"nu_T", "1", Better::nearer_one, "the same for torques", "Weller et al. 2010 (3)"},
    Metric{"noise_F", "1", Better::lower, "energy of the force's residual above the cut-off over the ideal's energy",
           "lib/measure/spectrum.h"},
    Metric{"noise_T", "1", Better::lower, "the same for torques", "lib/measure/spectrum.h"},
    Metric{"leakage", "1", Better::lower, "unwanted part over wanted part, scaled by the reference length",
           "lib/measure/path.h"},
    Metric{"lag", "stamps", Better::lower, "shift of the measured wrench against the ideal, positive if late",
           "lib/measure/path.h"},
    Metric{"jump_F", "1", Better::lower, "largest jump of the force left after refinement, over its peak",
           "lib/measure/path.h"},
    Metric{"jump_T", "1", Better::lower, "the same for torques", "lib/measure/path.h"},
    Metric{"loop_work", "1", Better::lower, "work on the closed path over peak force times length",
           "lib/measure/path.h"},
    Metric{"mean_ns", "ns", Better::lower, "mean time of a query", k_paper},
    Metric{"processor_ns", "ns", Better::lower, "mean processor time of a query, whatever else the machine does",
           "lib/scenario/recorder.h"},
    Metric{"p50_ns", "ns", Better::lower, "median time of a query", "lib/measure/latency.h"},
    Metric{"p99_ns", "ns", Better::lower, "99 % of the queries take no longer", "lib/measure/latency.h"},
    Metric{"p999_ns", "ns", Better::lower, "99.9 % of the queries take no longer", "lib/measure/latency.h"},
    Metric{"max_ns", "ns", Better::lower, "longest query", k_paper},
    Metric{"over_1ms", "1", Better::lower, "share of the queries over 1 ms, the haptic deadline",
           "lib/measure/latency.h"},
};

}  // namespace

std::string_view to_string(Better better) {
  switch (better) {
    case Better::lower:
      return "lower";
    case Better::higher:
      return "higher";
    case Better::nearer_one:
      return "nearer 1";
    case Better::neither:
      return "neither";
  }
  return "neither";
}

std::span<const Metric> metrics() { return k_metrics; }

const Metric& metric(std::string_view name) {
  constexpr std::string_view k_whole_path = "_all";
  constexpr std::string_view k_other_law = "_by_";
  std::string_view stem = name.substr(0, name.find(k_other_law));
  if (stem.ends_with(k_whole_path)) stem.remove_suffix(k_whole_path.size());
  const auto* found = std::find_if(k_metrics.begin(), k_metrics.end(), [&](const Metric& m) { return m.name == stem; });
  if (found == k_metrics.end()) throw BadArgument("no measure is called \"" + std::string(name) + "\"");
  return *found;
}

}  // namespace sixdof
