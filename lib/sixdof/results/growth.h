#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/row.h>

/// How times and memory grow with the number of triangles, of the rows of `bench/scripts/growth` (measured_pairs.h).

namespace sixdof::results {

struct RowGroup;

/// By shape: triangles, value.
using PointsOfShapes = std::map<std::string, std::vector<std::pair<double, double>>>;

/// value = c_shape triangles^exponent, with one exponent for all shapes and a factor for each.
struct PowerLaw {
  double exponent = 0.0;
  double half_width = 0.0;  ///< Of the exponent's 95 % interval, by Student's t.
  std::size_t fitted = 0;   ///< Points.
};

/// By least squares of the logarithms. Shapes count that have values above zero at two numbers of triangles or more;
/// empty where no degree of freedom is left for the interval.
std::optional<PowerLaw> power_law(const PointsOfShapes& points);

/// The values of a shape at one number of triangles; empty if it has none.
std::optional<double> value_at(const std::vector<std::pair<double, double>>& points, double triangles);

/// One quantity of one algorithm over the number of triangles.
struct GrowthSeries {
  std::size_t file = 0;
  std::string algorithm;  ///< k_set_maker for the time that making the set took.
  std::string quantity;   ///< "distance, us", "prepare, ms", "memory, bytes", "set, s": of processor time.
  PointsOfShapes points;
  std::optional<PowerLaw> law;
};
void to_json(nlohmann::json& json, const GrowthSeries& series);
void from_json(const nlohmann::json& json, GrowthSeries& series);

inline constexpr const char* k_set_maker = "sixdof generate";

/// By algorithm and quantity, from the rows with a shape and without a fault.
std::vector<GrowthSeries> growth_of(std::span<const RowGroup> groups);

/// Adds what the member "growth" of a result file has, if it has one. @throws Error with what is wrong
void take_growth(const nlohmann::ordered_json& document, std::size_t file, std::vector<GrowthSeries>& growth);

}  // namespace sixdof::results
