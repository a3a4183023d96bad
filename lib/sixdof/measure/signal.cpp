#include <sixdof/measure/signal.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

std::vector<double> magnitudes(Vectors vectors) {
  std::vector<double> result(vectors.size());
  std::transform(vectors.begin(), vectors.end(), result.begin(), [](const Eigen::Vector3d& v) { return v.norm(); });
  return result;
}

double peak(Vectors vectors) {
  double largest = 0.0;
  for (const Eigen::Vector3d& v : vectors) largest = std::max(largest, v.norm());
  return largest;
}

std::vector<bool> nonzero(Vectors vectors) {
  const double threshold = k_zero_fraction * peak(vectors);
  std::vector<bool> result(vectors.size());
  for (std::size_t k = 0; k < vectors.size(); ++k) result[k] = vectors[k].norm() > threshold;
  return result;
}

void check_same_length(Vectors ideal, Vectors measured) {
  if (ideal.size() != measured.size()) {
    throw BadArgument(
        fmt::format("{} ideal steps cannot be compared with {} measured ones", ideal.size(), measured.size()));
  }
}

}  // namespace sixdof
