#include <sixdof/report/series.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>

namespace sixdof::report {
namespace {

constexpr const char* k_format = "sixdof-series";

Series::Vectors vectors_of(const hdf5::File& file, const std::string& name) {
  const std::vector<double> values = file.read_matrix(name);
  Series::Vectors vectors;
  for (std::size_t k = 0; k + 2 < values.size(); k += 3) vectors.push_back({values[k], values[k + 1], values[k + 2]});
  return vectors;
}

void read_spectra(const hdf5::File& file, const std::string& path, Series& series) {
  series.times = file.read_matrix("/spectrum/times");
  series.frequencies = file.read_matrix("/spectrum/frequencies");
  for (const char* const name :
       {"force_signal", "force_residual", "torque_signal", "torque_residual", "force_x_signal", "force_y_signal",
        "force_z_signal", "torque_x_signal", "torque_y_signal", "torque_z_signal"}) {
    const bool is_component = name[std::string_view(name).find('_') + 2] == '_';
    if (is_component && !file.exists(std::string("/spectrum/") + name)) continue;  // a file of an earlier version
    std::vector<double> intensity = file.read_matrix(std::string("/spectrum/") + name);
    if (intensity.size() != series.times.size() * series.frequencies.size()) {
      throw BadFile(path, std::string("/spectrum/") + name, "not a row per time and a column per frequency");
    }
    series.spectra.emplace_back(name, std::move(intensity));
  }
}

}  // namespace

Series read_series(const std::filesystem::path& path) {
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(path);
  if (!file.has_attribute("/", "format") || file.read_string("/", "format") != k_format) {
    throw BadFile(path.string(), "not a series of sixdof quality (-o)");
  }
  Series series{.path = path.string(),
                .scenario = file.read_string("/", "scenario"),
                .law = file.read_string("/", "law"),
                .algorithm = file.read_string("/", "algorithm"),
                .version = file.read_string("/", "version"),
                .settings = file.read_string("/", "settings"),
                .shape = file.read_string("/", "shape"),
                .command = file.has_attribute("/", "command") ? file.read_string("/", "command") : std::string(),
                .rate_hz = file.read_attribute<double>("/", "rate_hz"),
                .force = vectors_of(file, "/force"),
                .torque = vectors_of(file, "/torque"),
                .ideal_force = vectors_of(file, "/ideal_force"),
                .ideal_torque = vectors_of(file, "/ideal_torque"),
                .penalty = file.read_matrix("/penalty"),
                .ideal_penalty = file.read_matrix("/ideal_penalty"),
                .time_ns = file.read_matrix("/time_ns"),
                .reference_length = file.has_attribute("/", "reference_length")
                                        ? file.read_attribute<double>("/", "reference_length")
                                        : 0.0,
                .poses = {},
                .status = {},
                .times = {},
                .frequencies = {},
                .spectra = {}};
  for (const std::int32_t status : file.read_values<std::int32_t>("/status")) series.status.push_back(status);
  const std::vector<double> poses = file.read_matrix("/pose");
  for (std::size_t k = 0; k + 6 < poses.size(); k += 7) {
    std::copy_n(poses.begin() + static_cast<std::ptrdiff_t>(k), 7, series.poses.emplace_back().begin());
  }
  if (series.poses.size() != series.force.size()) throw BadFile(path.string(), "/pose", "not a row per step");
  if (!(series.rate_hz > 0.0)) throw BadFile(path.string(), "rate_hz", "not above zero");
  for (const Series::Vectors* const vectors : {&series.torque, &series.ideal_force, &series.ideal_torque}) {
    if (vectors->size() != series.force.size() || series.status.size() != series.force.size()) {
      throw BadFile(path.string(), "arrays of different length");
    }
  }
  for (const std::vector<double>* const values : {&series.penalty, &series.ideal_penalty, &series.time_ns}) {
    if (values->size() != series.force.size()) throw BadFile(path.string(), "arrays of different length");
  }
  if (file.exists("/spectrum")) read_spectra(file, path.string(), series);
  return series;
}

}  // namespace sixdof::report
