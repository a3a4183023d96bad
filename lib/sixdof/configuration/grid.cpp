#include <sixdof/configuration/grid.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// 180 / step may differ from a whole number by the rounding of a decimal step (e.g. 180/7 typed as 25.714285714286).
constexpr double k_step_tolerance = 1e-9;

struct CosSin {
  double cos, sin;
};

/// Cosine and sine rounded from extended precision. The C library's functions of doubles come in several versions,
/// selected by the processor's features, whose last bits differ.
CosSin cos_sin(long double radians) {
  return {static_cast<double>(std::cos(radians)), static_cast<double>(std::sin(radians))};
}

/// Of the angle 2 pi k / n. Reduced in whole numbers to [0, 45] degrees, so that multiples of 30 and 45 degrees are
/// rounded correctly and symmetric angles have symmetric bits.
CosSin cos_sin_of(std::int64_t k, std::int64_t n) {
  k = (k % n + n) % n;
  const std::int64_t quadrant = 4 * k / n;
  const std::int64_t r = 4 * k - quadrant * n;  // The rest is r / n of a right angle.
  const bool beyond_45 = 2 * r > n;
  const std::int64_t reduced = beyond_45 ? n - r : r;
  CosSin p{1.0, 0.0};
  if (2 * reduced == n) {
    p = {std::sqrt(0.5), std::sqrt(0.5)};
  } else if (3 * reduced == n) {
    p = {std::sqrt(0.75), 0.5};
  } else if (reduced != 0) {
    p = cos_sin(std::numbers::pi_v<long double> * static_cast<long double>(reduced) / static_cast<long double>(2 * n));
  }
  if (beyond_45) std::swap(p.cos, p.sin);
  for (std::int64_t i = 0; i < quadrant; ++i) p = {-p.sin, p.cos};
  return p;
}

/// q and -q are one rotation: makes the first component that is not zero positive, and every zero +0.
Eigen::Vector4d canonical(const Eigen::Vector4d& q) {
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (q[i] == 0.0) continue;
    return (q[i] < 0.0 ? Eigen::Vector4d(-q) : q) + Eigen::Vector4d::Zero();
  }
  return q;
}

/// In [0, 1).
long double fractional_part(long double x) { return x - std::floor(x); }

/// Longitudes and latitudes every 180 / n degrees: 2 n longitudes x (n - 1) interior latitudes + 2 poles, with z as the
/// polar axis. Order: the pole +z, then parallel after parallel, each from longitude 0, then the pole -z.
std::vector<Eigen::Vector3d> latitude_directions(std::size_t n) {
  const auto circle = static_cast<std::int64_t>(2 * n);  // Steps in 360 degrees.
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(2 * n * (n - 1) + 2);
  directions.emplace_back(0.0, 0.0, 1.0);
  for (std::int64_t k = 1; 2 * k < circle; ++k) {
    const CosSin theta = cos_sin_of(k, circle);
    for (std::int64_t i = 0; i < circle; ++i) {
      const CosSin phi = cos_sin_of(i, circle);
      directions.emplace_back(theta.sin * phi.cos, theta.sin * phi.sin, theta.cos);
    }
  }
  directions.emplace_back(0.0, 0.0, -1.0);
  return directions;
}

/// R = Rz(alpha) Ry(beta) Rz(gamma), every 180 / n degrees: 2 n x (n + 1) x 2 n, with alpha the slowest and gamma the
/// fastest index. At beta = 0 and 180 degrees alpha and gamma rotate about the same axis, so rotations repeat there;
/// equal rotations have equal bits. This is the paper's sampling, poles included. It is not uniform on SO(3).
std::vector<Eigen::Vector4d> zyz_rotations(std::size_t n) {
  const auto half_circle = static_cast<std::int64_t>(n);  // Steps in 180 degrees.
  const std::int64_t circle = 2 * half_circle;
  std::vector<Eigen::Vector4d> rotations;
  rotations.reserve(4 * n * n * (n + 1));
  // Quaternions have the cosines and sines of half the angles.
  for (std::int64_t alpha = 0; alpha < circle; ++alpha) {
    for (std::int64_t beta = 0; beta <= half_circle; ++beta) {
      const CosSin b = cos_sin_of(beta, 2 * circle);
      for (std::int64_t gamma = 0; gamma < circle; ++gamma) {
        const CosSin sum = cos_sin_of(alpha + gamma, 2 * circle);
        const CosSin difference = cos_sin_of(alpha - gamma, 2 * circle);
        rotations.push_back(
            canonical({b.cos * sum.cos, -b.sin * difference.sin, b.sin * difference.cos, b.cos * sum.sin}));
      }
    }
  }
  return rotations;
}

/// `count` low-discrepancy rotations, uniform on SO(3) for every count: super-Fibonacci spirals (Alexa,
/// "Super-Fibonacci Spirals: Fast, Low-Discrepancy Sampling of SO(3)", CVPR 2022), phi = sqrt(2), psi^4 = psi + 4.
std::vector<Eigen::Vector4d> super_fibonacci_rotations(std::size_t count) {
  constexpr auto two_pi = 2.0L * std::numbers::pi_v<long double>;
  constexpr auto phi = std::numbers::sqrt2_v<long double>;
  constexpr long double psi = 1.533751168755204288118041L;
  std::vector<Eigen::Vector4d> rotations;
  rotations.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const long double s = static_cast<long double>(i) + 0.5L;
    const long double t = s / static_cast<long double>(count);
    const auto r = static_cast<double>(std::sqrt(t));
    const auto rest = static_cast<double>(std::sqrt(1.0L - t));
    const CosSin alpha = cos_sin(two_pi * fractional_part(s / phi));
    const CosSin beta = cos_sin(two_pi * fractional_part(s / psi));
    rotations.push_back(canonical({r * alpha.sin, r * alpha.cos, rest * beta.sin, rest * beta.cos}));
  }
  return rotations;
}

/// `count` directions on a spherical Fibonacci lattice (equal-area in z, golden angle in longitude), from +z to -z.
std::vector<Eigen::Vector3d> fibonacci_directions(std::size_t count) {
  constexpr auto two_pi = 2.0L * std::numbers::pi_v<long double>;
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = static_cast<long double>(i);
    const long double z = 1.0L - (2.0L * index + 1.0L) / static_cast<long double>(count);
    const auto parallel = static_cast<double>(std::sqrt((1.0L - z) * (1.0L + z)));
    const CosSin longitude = cos_sin(two_pi * fractional_part(index / std::numbers::phi_v<long double>));
    directions.emplace_back(parallel * longitude.cos, parallel * longitude.sin, static_cast<double>(z));
  }
  return directions;
}

template <class T>
std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(std::string_view spec, const std::string& why) {
  throw BadArgument(fmt::format(
      "grid '{}': {}; a grid is paper, paper-volume, STEP, STEP/STEP (degrees, dividing 180), so3:N or so3:N:M", spec,
      why));
}

/// The number of steps in 180 degrees.
std::size_t parse_step(std::string_view spec, std::string_view text) {
  const auto step = parse_number<double>(text);
  if (!step || !std::isfinite(*step)) refuse(spec, fmt::format("'{}' is not a number", text));
  if (!(*step > 0.0 && *step <= 180.0)) refuse(spec, fmt::format("step {} is not in (0, 180]", text));
  const double steps = 180.0 / *step;
  const double whole = std::round(steps);
  if (std::abs(steps - whole) > k_step_tolerance * whole) {
    refuse(spec, fmt::format("180 degrees are not a whole number of steps of {}", text));
  }
  if (whole > static_cast<double>(k_max_grid_size)) refuse(spec, fmt::format("step {} is too fine", text));
  return static_cast<std::size_t>(whole);
}

std::size_t parse_count(std::string_view spec, std::string_view text) {
  const auto count = parse_number<std::size_t>(text);
  if (!count || *count == 0) refuse(spec, fmt::format("'{}' is not a count", text));
  return *count;
}

void check_size(std::string_view spec, double directions, double rotations) {
  const auto limit = static_cast<double>(k_max_grid_size);
  if (directions > limit || rotations > limit) {
    refuse(spec, fmt::format("{:.0f} directions and {:.0f} rotations are more than {}", directions, rotations,
                             k_max_grid_size));
  }
}

Grid make_zyz_grid(std::string_view spec, std::size_t n_directions, std::size_t n_rotations) {
  const auto d = static_cast<double>(n_directions);
  const auto r = static_cast<double>(n_rotations);
  check_size(spec, 2.0 * d * (d - 1.0) + 2.0, 4.0 * r * r * (r + 1.0));
  return {.spec = std::string(spec),
          .sampler = "zyz-euler",
          .direction_step_degrees = 180.0 / d,
          .rotation_step_degrees = 180.0 / r,
          .directions = latitude_directions(n_directions),
          .rotations = zyz_rotations(n_rotations)};
}

/// The count of directions whose cells have the same edge as those of the rotations. SO(3) has the volume 8 pi^2 if
/// lengths are rotation angles; the sphere of directions has the area 4 pi.
std::size_t matching_direction_count(std::size_t rotations) {
  constexpr double pi = std::numbers::pi;
  const double edge = std::cbrt(8.0 * pi * pi / static_cast<double>(rotations));
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(4.0 * pi / (edge * edge))));
}

Grid make_uniform_grid(std::string_view spec, std::string_view counts) {
  const std::size_t colon = counts.find(':');
  const std::size_t rotations = parse_count(spec, counts.substr(0, colon));
  check_size(spec, 1.0, static_cast<double>(rotations));
  const std::size_t directions = colon == std::string_view::npos ? matching_direction_count(rotations)
                                                                 : parse_count(spec, counts.substr(colon + 1));
  check_size(spec, static_cast<double>(directions), static_cast<double>(rotations));
  return {.spec = fmt::format("so3:{}:{}", rotations, directions),
          .sampler = "super-fibonacci",
          .directions = fibonacci_directions(directions),
          .rotations = super_fibonacci_rotations(rotations)};
}

}  // namespace

Grid make_grid(std::string_view spec) {
  // 12 steps of 15 degrees and 6 of 30 make 180.
  if (spec == "paper") return make_zyz_grid(spec, 12, 12);
  if (spec == "paper-volume") return make_zyz_grid(spec, 12, 6);
  constexpr std::string_view uniform = "so3:";
  if (spec.starts_with(uniform)) return make_uniform_grid(spec, spec.substr(uniform.size()));
  const std::size_t slash = spec.find('/');
  const std::size_t directions = parse_step(spec, spec.substr(0, slash));
  const std::size_t rotations = slash == std::string_view::npos ? directions : parse_step(spec, spec.substr(slash + 1));
  Grid grid = make_zyz_grid(spec, directions, rotations);
  grid.spec = fmt::format("{}", grid.direction_step_degrees);
  if (directions != rotations) grid.spec += fmt::format("/{}", grid.rotation_step_degrees);
  return grid;
}

DistinctRotations::DistinctRotations(std::span<const Eigen::Vector4d> rotations) {
  std::unordered_map<std::string_view, std::uint32_t> index_of;  // by the bytes of the four components
  index_of.reserve(rotations.size());
  representative.reserve(rotations.size());
  for (std::uint32_t r = 0; r < rotations.size(); ++r) {
    const std::string_view bits(reinterpret_cast<const char*>(rotations[r].data()), sizeof(Eigen::Vector4d));
    const auto [entry, is_new] = index_of.try_emplace(bits, r);
    if (is_new) first.push_back(r);
    representative.push_back(entry->second);
  }
}

void DistinctRotations::copy_to_repeats(std::span<double> values, std::size_t row_size) const {
  for (std::size_t r = 0; r < representative.size(); ++r) {
    const std::size_t from = representative[r];
    if (from != r) std::copy_n(&values[from * row_size], row_size, &values[r * row_size]);
  }
}

ConfigurationRay::ConfigurationRay(const Mesh& a, const Mesh& b, const Eigen::Vector4d& rotation,
                                   const Eigen::Vector3d& along)
    : R(Pose::from_quaternion(rotation[0], rotation[1], rotation[2], rotation[3], Eigen::Vector3d::Zero()).R),
      center_a(a.center()),
      rotated_center_b(R * b.center()),
      direction(along) {}

}  // namespace sixdof
