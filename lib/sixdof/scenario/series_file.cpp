#include <sixdof/scenario/series_file.h>

#include <cmath>
#include <cstdint>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/measure/spectrum.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-series";
constexpr std::uint64_t k_format_version = 1;
constexpr std::size_t k_chunk_rows = 1024;
constexpr std::size_t k_spectrum_hop = 8;

void write_rows(hdf5::File& file, const std::string& name, const std::vector<double>& values, std::size_t columns) {
  file.write_matrix(name, values.data(), values.size() / columns, columns, k_chunk_rows);
}

void write_vectors(hdf5::File& file, const std::string& name, Vectors vectors) {
  file.write_matrix(name, vectors.front().data(), vectors.size(), 3, k_chunk_rows);
}

/// Signal and residual of the forces or of the torques.
void write_spectra(hdf5::File& file, const std::string& kind, Vectors ideal, Vectors measured) {
  const std::vector<double> signal = magnitudes(measured);
  std::vector<double> residual = signal;
  if (const auto fit = fit_gain(ideal, measured)) {
    for (std::size_t k = 0; k < residual.size(); ++k) residual[k] -= fit->gain * ideal[k].norm();
  }
  const auto write = [&](const std::string& what, const std::vector<double>& values) {
    const Spectrogram diagram = short_time_spectrum(values, k_haptic_rate_hz, k_spectrum_window, k_spectrum_hop);
    write_rows(file, "/spectrum/" + kind + "_" + what, diagram.intensity, diagram.frequencies.size());
    return diagram;
  };
  write("signal", signal);
  const Spectrogram axes = write("residual", residual);
  if (kind != "force") return;  // both kinds have the same axes
  write_rows(file, "/spectrum/times", axes.times, 1);
  write_rows(file, "/spectrum/frequencies", axes.frequencies, 1);
}

}  // namespace

void write_series(const std::filesystem::path& path, const Scenario& scenario, const Recording& recording, IdealLaw law,
                  const SeriesSource& source, const Measures& measures) {
  const Ideals ideals(scenario, recording, law);
  std::vector<double> poses;
  for (const Pose& pose : recording.poses) {
    const Eigen::Vector4d q = pose.quaternion();
    poses.insert(poses.end(), {q[0], q[1], q[2], q[3], pose.t.x(), pose.t.y(), pose.t.z()});
  }
  std::vector<std::int32_t> status;
  for (const Status s : recording.status) status.push_back(static_cast<std::int32_t>(s));

  AtomicFile output(path);
  const hdf5::Session session;
  hdf5::File file = hdf5::File::create(output.temporary_path(), path);
  file.write_attribute("/", "format", std::string(k_format));
  file.write_attribute("/", "format_version", k_format_version);
  file.write_attribute("/", "scenario", scenario.name());
  file.write_attribute("/", "law", std::string(to_string(law)));
  file.write_attribute("/", "algorithm", source.algorithm);
  file.write_attribute("/", "version", source.version);
  file.write_attribute("/", "settings", source.settings);
  file.write_attribute("/", "shape", source.shape);
  file.write_attribute("/", "rate_hz", k_haptic_rate_hz);
  for (const auto& [name, value] : measures) file.write_attribute("/", name.c_str(), value);
  write_rows(file, "/progress", recording.progress, 1);
  write_rows(file, "/pose", poses, 7);
  write_vectors(file, "/force", recording.forces);
  write_vectors(file, "/torque", recording.torques);
  write_rows(file, "/penalty", recording.penalties, 1);
  write_rows(file, "/time_ns", recording.times_ns, 1);
  write_vectors(file, "/ideal_force", ideals.forces);
  write_vectors(file, "/ideal_torque", ideals.torques);
  write_rows(file, "/ideal_penalty", ideals.penalties, 1);
  file.write_values("/status", std::span<const std::int32_t>(status));
  if (recording.size() >= k_spectrum_window) {
    file.make_group("/spectrum");
    write_spectra(file, "force", ideals.forces, recording.forces);
    write_spectra(file, "torque", ideals.torques, recording.torques);
  }
  file.close();
  output.commit();
}

}  // namespace sixdof
