// The loop that the Python package is compared with: asks an algorithm for all poses of a file.
//
// usage: reference_loop ALGORITHM A B KIND POSES ANSWERS
// POSES: float64, 16 of each pose. ANSWERS, written: float64; of a pose of distance the distance and both points, of
// respond the penalty, force, torque and reference. Prints the least mean time of a query of three passes, in ns.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/query/registry.h>
#include "bench/common/all_algorithms.h"

namespace {

using Clock = std::chrono::steady_clock;
using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

std::vector<sixdof::Pose> read_poses(const char* file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<sixdof::Pose> poses;
  Matrix4 matrix;
  while (in.read(reinterpret_cast<char*>(matrix.data()), sizeof(double) * 16)) {
    poses.push_back({matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()});
  }
  return poses;
}

void append(std::vector<double>& out, const Eigen::Vector3d& vector) {
  out.insert(out.end(), vector.begin(), vector.end());
}

void append(std::vector<double>& out, const sixdof::Separation& answer) {
  out.push_back(answer.distance);
  append(out, answer.witness_a);
  append(out, answer.witness_b);
}

void append(std::vector<double>& out, const sixdof::Response& answer) {
  out.push_back(answer.penalty);
  append(out, answer.force);
  append(out, answer.torque);
  append(out, answer.reference);
}

/// ns of a query in one pass. The answers are kept, as an array would have them.
template <class Answer, class Ask>
double pass(const std::vector<sixdof::Pose>& poses, std::vector<Answer>& answers, const Ask& ask) {
  const auto start = Clock::now();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const sixdof::Outcome<Answer> outcome = ask(poses[i]);
    if (outcome.ok()) answers[i] = outcome.value;
  }
  const std::chrono::duration<double, std::nano> took = Clock::now() - start;
  return took.count() / static_cast<double>(poses.size());
}

template <class Answer, class Ask>
void run(const std::vector<sixdof::Pose>& poses, const char* file, const Ask& ask) {
  std::vector<Answer> answers(poses.size());
  double least = pass(poses, answers, ask);
  std::vector<double> out;
  for (const Answer& answer : answers) append(out, answer);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size() * sizeof(double)));
  for (int k = 0; k < 2; ++k) least = std::min(least, pass(poses, answers, ask));
  std::printf("%.3f\n", least);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  sixdof::Registry registry;
  sixdof::register_all_algorithms(registry, {.rivals = false});
  const sixdof::Algorithm& algorithm = registry.find(argv[1]);
  const sixdof::Mesh a = sixdof::load_model(argv[2]), b = sixdof::load_model(argv[3]);
  const auto query = algorithm.prepare(a, b, algorithm.settings());
  const std::vector<sixdof::Pose> poses = read_poses(argv[5]);
  if (std::string_view(argv[4]) == "distance") {
    run<sixdof::Separation>(poses, argv[6], [&](const sixdof::Pose& pose) { return query->distance(pose); });
  } else {
    run<sixdof::Response>(poses, argv[6], [&](const sixdof::Pose& pose) { return query->respond(pose); });
  }
  return 0;
}
