#pragma once

namespace sixdof {

/// Area common to two discs of radii r1, r2 >= 0 whose centres are `distance` >= 0 apart:
/// r1^2 (u - sin u cos u) + r2^2 (v - sin v cos v) with the half angles u, v of the two circular segments; 0 if the
/// discs are apart, the smaller disc's area if it is inside the other.
/// https://mathworld.wolfram.com/Circle-CircleIntersection.html
double lens_area(double r1, double r2, double distance);

/// Length of the common chord of the two circles, which is -d lens_area / d distance. 0 where they do not intersect.
double lens_chord(double r1, double r2, double distance);

/// A disc of radius r about the origin, cut to the part with x > cut.
struct DiscPart {
  double area = 0.0;
  double moment_x = 0.0;  ///< Integral of x over the part.
};
DiscPart disc_part(double r, double cut);

}  // namespace sixdof
