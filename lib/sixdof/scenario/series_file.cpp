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

void write_column(hdf5::File& file, const std::string& name, const std::vector<double>& values) {
  file.write_matrix(name, values.data(), values.size(), 1, k_chunk_rows);
}

void write_vectors(hdf5::File& file, const std::string& name, const std::vector<Eigen::Vector3d>& values) {
  std::vector<double> rows;
  for (const Eigen::Vector3d& v : values) rows.insert(rows.end(), v.data(), v.data() + 3);
  file.write_matrix(name, rows.data(), values.size(), 3, k_chunk_rows);
}

void write_poses(hdf5::File& file, const std::vector<Pose>& poses) {
  std::vector<double> rows;
  for (const Pose& pose : poses) {
    const Eigen::Vector4d q = pose.quaternion();
    rows.insert(rows.end(), q.data(), q.data() + 4);
    rows.insert(rows.end(), pose.t.data(), pose.t.data() + 3);
  }
  file.write_matrix("/pose", rows.data(), poses.size(), 7, k_chunk_rows);
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
    file.write_matrix("/spectrum/" + kind + "_" + what, diagram.intensity.data(), diagram.times.size(),
                      diagram.frequencies.size(), k_chunk_rows);
    return diagram;
  };
  write("signal", signal);
  const Spectrogram axes = write("residual", residual);
  if (kind != "force") return;  // both kinds have the same axes
  write_column(file, "/spectrum/times", axes.times);
  write_column(file, "/spectrum/frequencies", axes.frequencies);
}

}  // namespace

void write_series(const std::filesystem::path& path, const Scenario& scenario, const Recording& recording, IdealLaw law,
                  const SeriesSource& source, const Measures& measures) {
  std::vector<Eigen::Vector3d> forces;
  std::vector<Eigen::Vector3d> torques;
  std::vector<double> penalties;
  for (const IdealWrench& ideal : ideals_of(scenario, recording, law)) {
    forces.push_back(ideal.force);
    torques.push_back(ideal.torque);
    penalties.push_back(ideal.penalty);
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
  write_column(file, "/progress", recording.progress);
  write_poses(file, recording.poses);
  write_vectors(file, "/force", recording.forces);
  write_vectors(file, "/torque", recording.torques);
  write_column(file, "/penalty", recording.penalties);
  write_column(file, "/time_ns", recording.times_ns);
  write_vectors(file, "/ideal_force", forces);
  write_vectors(file, "/ideal_torque", torques);
  write_column(file, "/ideal_penalty", penalties);
  file.write_values("/status", std::span<const std::int32_t>(status));
  if (recording.size() >= k_spectrum_window) {
    file.make_group("/spectrum");
    write_spectra(file, "force", forces, recording.forces);
    write_spectra(file, "torque", torques, recording.torques);
  }
  file.close();
  output.commit();
}

}  // namespace sixdof
