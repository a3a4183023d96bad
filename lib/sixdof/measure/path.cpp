#include <sixdof/measure/path.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

double sum_of_squares(Vectors vectors) {
  double sum = 0.0;
  for (const Eigen::Vector3d& v : vectors) sum += v.squaredNorm();
  return sum;
}

/// Normalised correlation of the ideal, delayed by `shift` steps, with the measured series, over the common part.
double correlation(Vectors ideal, Vectors measured, std::ptrdiff_t shift) {
  const auto count = static_cast<std::ptrdiff_t>(ideal.size());
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, shift);
  const std::ptrdiff_t to = std::min(count, count + shift);
  double product = 0.0;
  double ideal_squares = 0.0;
  double measured_squares = 0.0;
  for (std::ptrdiff_t k = from; k < to; ++k) {
    const Eigen::Vector3d& i = ideal[static_cast<std::size_t>(k - shift)];
    const Eigen::Vector3d& m = measured[static_cast<std::size_t>(k)];
    product += i.dot(m);
    ideal_squares += i.squaredNorm();
    measured_squares += m.squaredNorm();
  }
  const double norm = std::sqrt(ideal_squares * measured_squares);
  return norm > 0.0 ? product / norm : 0.0;
}

}  // namespace

std::optional<double> leakage(Vectors unwanted, Vectors wanted, double scale) {
  check_same_length(wanted, unwanted);
  const double reference = sum_of_squares(wanted);
  if (reference == 0.0) return std::nullopt;
  return std::sqrt(sum_of_squares(unwanted) / reference) * scale;
}

std::optional<double> lag(Vectors ideal, Vectors measured, std::size_t reach) {
  check_same_length(ideal, measured);
  const auto limit = static_cast<std::ptrdiff_t>(reach);
  if (ideal.size() <= 2 * reach || peak(ideal) == 0.0 || peak(measured) == 0.0) return std::nullopt;
  const double contrast = 1.0 - std::min(correlation(ideal, ideal, limit), correlation(ideal, ideal, -limit));
  if (contrast < k_lag_contrast) return std::nullopt;
  std::vector<double> values;
  for (std::ptrdiff_t shift = -limit; shift <= limit; ++shift) values.push_back(correlation(ideal, measured, shift));
  const auto best = std::max_element(values.begin(), values.end());
  if (best == values.begin() || best == values.end() - 1) return std::nullopt;
  const double curvature = best[-1] - 2.0 * best[0] + best[1];
  const double offset = curvature < 0.0 ? 0.5 * (best[-1] - best[1]) / curvature : 0.0;
  return static_cast<double>(best - values.begin() - limit) + std::clamp(offset, -0.5, 0.5);
}

double largest_jump(std::span<const double> progress, Vectors values, const std::function<Eigen::Vector3d(double)>& f,
                    std::size_t candidates, std::size_t halvings) {
  if (progress.size() != values.size()) throw BadArgument("largest_jump: one value per step is needed");
  if (values.size() < 2) return 0.0;
  const auto difference = [&](std::size_t k) { return (values[k + 1] - values[k]).norm(); };
  std::vector<std::size_t> order(values.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto count = static_cast<std::ptrdiff_t>(std::min(candidates, order.size()));
  std::partial_sort(order.begin(), order.begin() + count, order.end(),
                    [&](std::size_t a, std::size_t b) { return difference(a) > difference(b); });
  order.resize(static_cast<std::size_t>(count));
  double largest = 0.0;
  for (const std::size_t k : order) {
    double from = progress[k];
    double to = progress[k + 1];
    Eigen::Vector3d f_from = values[k];
    Eigen::Vector3d f_to = values[k + 1];
    for (std::size_t i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (from + to);
      const Eigen::Vector3d f_middle = f(middle);
      if ((f_middle - f_from).norm() >= (f_to - f_middle).norm()) {
        to = middle;
        f_to = f_middle;
      } else {
        from = middle;
        f_from = f_middle;
      }
    }
    largest = std::max(largest, (f_to - f_from).norm());
  }
  return largest;
}

std::optional<double> loop_work(Vectors forces, Vectors torques, std::span<const Pose> poses,
                                const Eigen::Vector3d& reference_b) {
  check_same_length(forces, torques);
  if (forces.size() != poses.size()) throw BadArgument("loop_work: one pose per step is needed");
  double work = 0.0;
  double length = 0.0;
  double angle = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::size_t next = (k + 1) % poses.size();
    const Eigen::Vector3d step = poses[next] * reference_b - poses[k] * reference_b;
    const Eigen::AngleAxisd rotation(Eigen::Matrix3d(poses[next].R * poses[k].R.transpose()));
    work += 0.5 * (forces[k] + forces[next]).dot(step);
    work += 0.5 * (torques[k] + torques[next]).dot(rotation.angle() * rotation.axis());
    length += step.norm();
    angle += rotation.angle();
  }
  const double scale = peak(forces) * length + peak(torques) * angle;
  if (scale == 0.0) return std::nullopt;
  return std::abs(work) / scale;
}

}  // namespace sixdof
