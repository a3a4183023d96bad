#include <sixdof/measure/spectrum.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>
#include <unsupported/Eigen/FFT>

#include <sixdof/base/error.h>
#include <sixdof/measure/direction.h>

namespace sixdof {
namespace {

/// Of an ideal's energy that a Hann window must leave; of a constant it leaves 0.375.
constexpr double k_least_share = 1e-6;

/// Real-to-complex Fourier transform of a fixed length, with its own buffers.
class FourierTransform {
 public:
  explicit FourierTransform(std::size_t length) : in_(length), out_(length / 2 + 1) {
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }

  std::span<double> input() { return in_; }

  /// Adds the one-sided energy spectrum of input() to `sum` (length / 2 + 1 entries).
  void add_energy(std::span<double> sum) {
    if (in_.size() == 1) {
      out_[0] = in_[0];  // Eigen has no plan for it
    } else {
      transform_.fwd(out_.data(), in_.data(), static_cast<Eigen::Index>(in_.size()));
    }
    const double n = static_cast<double>(in_.size());
    for (std::size_t j = 0; j < sum.size(); ++j) {
      const bool mirrored = j != 0 && 2 * j != in_.size();  // also has the bin of the negative frequency
      sum[j] += (mirrored ? 2.0 : 1.0) * std::norm(out_[j]) / n;
    }
  }

 private:
  std::vector<double> in_;
  std::vector<std::complex<double>> out_;
  Eigen::FFT<double> transform_;
};

void check_cutoff(double rate_hz, double cutoff_hz) {
  if (cutoff_hz >= 0.0 && cutoff_hz < 0.5 * rate_hz) return;
  throw BadArgument(fmt::format("cut-off {} Hz is not between 0 and half of the rate {} Hz", cutoff_hz, rate_hz));
}

/// Hz, of an entry of the energy spectrum of `length` steps.
double frequency_of(std::size_t entry, std::size_t length, double rate_hz) {
  return static_cast<double>(entry) * rate_hz / static_cast<double>(length);
}

}  // namespace

std::vector<double> hann(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t k = 0; k < length; ++k) {
    window[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
  }
  return window;
}

std::vector<double> energy_spectrum(std::span<const double> signal) {
  if (signal.empty()) return {};
  FourierTransform transform(signal.size());
  std::copy(signal.begin(), signal.end(), transform.input().begin());
  std::vector<double> energy(signal.size() / 2 + 1, 0.0);
  transform.add_energy(energy);
  return energy;
}

std::optional<double> nu(Vectors ideal, Vectors measured) { return nu(magnitudes(ideal), magnitudes(measured)); }

std::optional<double> nu(std::span<const double> ideal, std::span<const double> measured) {
  check_same_length(ideal, measured);
  const auto energy = [](std::span<const double> values) {
    const double scale = peak(values);
    if (scale == 0.0) return 0.0;
    std::vector<double> normalised(values.begin(), values.end());
    for (double& value : normalised) value /= scale;
    double sum = 0.0;
    for (const double e : energy_spectrum(normalised)) sum += e;
    return sum;
  };
  const double ideal_energy = energy(ideal);
  if (ideal_energy == 0.0) return std::nullopt;
  return energy(measured) / ideal_energy;
}

std::optional<double> nu_direction(Vectors ideal, Vectors measured, double rate_hz, double cutoff_hz) {
  check_same_length(ideal, measured);
  check_cutoff(rate_hz, cutoff_hz);
  if (peak(ideal) == 0.0) return std::nullopt;
  const std::vector<double> window = hann(ideal.size());
  FourierTransform transform(ideal.size());
  const auto energy_below = [&](Vectors vectors) {
    const double zero = k_zero_fraction * peak(vectors);
    std::vector<double> energy(vectors.size() / 2 + 1, 0.0);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < vectors.size(); ++k) {
        const double norm = vectors[k].norm();
        transform.input()[k] = norm > zero ? window[k] * vectors[k][axis] / norm : 0.0;
      }
      transform.add_energy(energy);
    }
    double below = 0.0;
    for (std::size_t j = 0; j < energy.size(); ++j) {
      if (frequency_of(j, vectors.size(), rate_hz) <= cutoff_hz) below += energy[j];
    }
    return below;
  };
  const double ideal_zero = k_zero_fraction * peak(ideal);
  double acting = 0.0, seen = 0.0;  // steps, and how much of them the window leaves
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    if (ideal[k].norm() <= ideal_zero) continue;
    acting += 1.0;
    seen += window[k] * window[k];
  }
  if (seen <= k_least_share * acting) return std::nullopt;
  const double ideal_energy = energy_below(ideal);
  if (ideal_energy == 0.0) return std::nullopt;
  return energy_below(measured) / ideal_energy;
}

std::optional<double> residual_noise(Vectors ideal, Vectors measured, double rate_hz, double cutoff_hz) {
  check_same_length(ideal, measured);
  check_cutoff(rate_hz, cutoff_hz);
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    products += ideal[k].dot(measured[k]);
    squares += ideal[k].squaredNorm();
  }
  if (squares == 0.0 || peak(measured) == 0.0) return std::nullopt;
  const double gain = std::max(0.0, products / squares);

  const std::vector<double> window = hann(ideal.size());
  FourierTransform transform(ideal.size());
  std::vector<double> residual_energy(ideal.size() / 2 + 1, 0.0);
  double reference_energy = 0.0, without_window = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::span<double> x = transform.input();
    for (std::size_t k = 0; k < ideal.size(); ++k) {
      x[k] = window[k] * (measured[k][axis] - gain * ideal[k][axis]);
      const double reference = gain > 0.0 ? gain * ideal[k][axis] : measured[k][axis];
      reference_energy += window[k] * window[k] * reference * reference;
      without_window += reference * reference;
    }
    transform.add_energy(residual_energy);
  }
  if (reference_energy <= k_least_share * without_window) return std::nullopt;
  double above = 0.0;
  for (std::size_t j = 0; j < residual_energy.size(); ++j) {
    if (frequency_of(j, ideal.size(), rate_hz) > cutoff_hz) above += residual_energy[j];
  }
  return above / reference_energy;
}

Spectrogram short_time_spectrum(std::span<const double> signal, double rate_hz, std::size_t window, std::size_t hop) {
  if (window == 0 || hop == 0 || signal.size() < window) {
    throw BadArgument(fmt::format("a window of {} steps every {} steps does not fit a signal of {} steps", window, hop,
                                  signal.size()));
  }
  FourierTransform transform(window);
  const std::vector<double> weight = hann(window);
  const std::size_t bins = window / 2 + 1;
  Spectrogram result;
  for (std::size_t j = 0; j < bins; ++j) {
    result.frequencies.push_back(static_cast<double>(j) * rate_hz / static_cast<double>(window));
  }
  for (std::size_t start = 0; start + window <= signal.size(); start += hop) {
    result.times.push_back((static_cast<double>(start) + 0.5 * static_cast<double>(window)) / rate_hz);
    for (std::size_t k = 0; k < window; ++k) transform.input()[k] = weight[k] * signal[start + k];
    result.intensity.resize(result.intensity.size() + bins, 0.0);
    transform.add_energy(std::span(result.intensity).last(bins));
  }
  return result;
}

}  // namespace sixdof
