#include <sixdof/scenario/pin_traction.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sixdof {
namespace {

/// Load of a vertical line of the wall at depth d.
double line_load(double d, double length, bool along_wall) { return d * (along_wall ? length - 2.0 * d : length - d); }

}  // namespace

PlaneWrench square_pin_traction(double side, double length, double angle, const Eigen::Vector2d& shift,
                                bool along_wall) {
  const double half = 0.5 * side;
  PlaneWrench sum;
  for (int quarter = 0; quarter < 4; ++quarter) {
    // Rotation by quarters by exact exchange of sine and cosine.
    const std::array<double, 4> cosines{std::cos(angle), -std::sin(angle), -std::cos(angle), std::sin(angle)};
    const Eigen::Vector2d normal(cosines[static_cast<std::size_t>(quarter)],
                                 cosines[static_cast<std::size_t>((quarter + 3) % 4)]);
    const Eigen::Vector2d along(-normal.y(), normal.x());
    const auto arm = [&](double t) { return Eigen::Vector2d(half * normal + t * along); };
    const auto element = [&](double t) {
      const Eigen::Vector2d p = shift + arm(t);
      const Eigen::Vector2d excess = (p.cwiseAbs().array() - half).max(0.0);
      const double d = excess.norm();
      if (d == 0.0) return PlaneWrench{};
      const Eigen::Vector2d wall = -(excess.array() * p.array().sign()).matrix() / d;
      const Eigen::Vector2d direction = along_wall ? wall : Eigen::Vector2d(-normal);
      return PlaneWrench::of(arm(t), line_load(d, length, along_wall) * direction);
    };
    // The depth has kinks where this side crosses the lines of the hole's walls.
    std::vector<double> cuts{-half, half};
    for (int axis = 0; axis < 2; ++axis) {
      for (const double line : {-half, half}) {
        if (along[axis] == 0.0) continue;
        const double t = (line - shift[axis] - half * normal[axis]) / along[axis];
        if (std::abs(t) < half) cuts.push_back(t);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      sum += integrate_wrench(element, cuts[i], cuts[i + 1]);
    }
  }
  return sum;
}

PlaneWrench round_pin_traction(double r, double length, const Eigen::Vector2d& shift, bool along_wall) {
  PlaneWrench sum;
  const double distance = shift.norm();
  if (distance == 0.0) return sum;
  const double middle = std::atan2(shift.y(), shift.x());
  const auto element = [&](double angle) {
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d p = shift + r * normal;
    const double d = p.norm() - r;
    const Eigen::Vector2d direction = along_wall ? Eigen::Vector2d(-p / p.norm()) : Eigen::Vector2d(-normal);
    return PlaneWrench::of(r * normal, r * line_load(d, length, along_wall) * direction);
  };
  // The part of the wall outside the hole: |shift + r normal| > r.
  const double reach = std::acos(std::clamp(-0.5 * distance / r, -1.0, 1.0));
  sum += integrate_wrench(element, middle - reach, middle + reach);
  return sum;
}

}  // namespace sixdof
