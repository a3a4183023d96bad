#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

/// Least-squares fits of a quantity over two resolutions: planes and quadratics, linear or in logarithms.

namespace sixdof::study {

/// One measured value at the resolutions x and y.
struct FitSample {
  double x = 0.0;
  double y = 0.0;
  double value = 0.0;
};

/// The functions that can be fitted.
enum class FitForm {
  plane,          ///< v = c0 + c1 x + c2 y.
  log_plane,      ///< log v = c0 + c1 log x + c2 log y: a product of powers.
  quadratic,      ///< v = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2.
  log_quadratic,  ///< The same of log v in log x and log y.
};

/// "linear", "log-log", "quadratic", "log-log quadratic".
std::string_view to_string(FitForm form);

/// A fitted function of two resolutions.
class SurfaceFit {
 public:
  /// @throws BadArgument for fewer samples than coefficients (3 for planes, 6 for quadratics) or samples that do not
  /// determine them, e.g. all on one line; and, with a logarithm, for a sample that is not positive
  SurfaceFit(FitForm form, std::span<const FitSample> samples);

  double at(double x, double y) const;

  FitForm form() const { return form_; }

  /// RMS over the samples of (value predicted without that sample - value) / |value|; infinity where a sample is needed
  /// to determine the fit, or is zero.
  double leave_one_out() const { return leave_one_out_; }

 private:
  FitForm form_;
  std::array<double, 6> coefficients_{};
  double leave_one_out_ = 0.0;
};

/// The plane of the form, linear or logarithmic, with the smaller error of leave-one-out; the linear one where a value
/// is not positive. @throws BadArgument as SurfaceFit does
SurfaceFit fit_plane(std::span<const FitSample> samples);

/// A plane or a quadratic, in logarithms where all values are positive and else linear: the one with the smaller error
/// of leave-one-out. @throws BadArgument as SurfaceFit does
SurfaceFit fit_surface(std::span<const FitSample> samples);

/// A fit whose residuals at the samples are interpolated by simple kriging with a Gaussian kernel over the logarithms
/// of both resolutions: close to the samples' values at the samples, the fit itself far from them. Residuals are ratios
/// where fit and samples are all positive, else differences. For refinement near measured points, where a plane bends.
class CorrectedFit {
 public:
  /// @param samples with positive resolutions; those of the fit or more
  CorrectedFit(const SurfaceFit& fit, std::span<const FitSample> samples);

  double at(double x, double y) const;

 private:
  struct Centre {
    double log_x, log_y, coefficient;
  };
  SurfaceFit fit_;
  std::vector<Centre> centres_;
  bool ratios_ = true;
};

}  // namespace sixdof::study
