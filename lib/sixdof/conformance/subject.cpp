#include <sixdof/conformance/subject.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <ostream>
#include <utility>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/query/ask.h>

namespace sixdof::conformance {
namespace {

/// Whether a command that takes the mesh's name gets this mesh.
bool is_model(const Mesh& mesh) {
  try {
    return !names_file(mesh.name()) && load_model(mesh.name()).hash() == mesh.hash();
  } catch (const Error&) {
    return false;  // No model of the catalogue.
  }
}

/// The word for the mesh on a command line: its name, or a file that is written.
std::string word_of(const Mesh& mesh) {
  static std::map<std::string, std::string> words;  // by content; making a model may take long
  std::string& word = words[mesh.hash()];
  if (!word.empty()) return word;
  if (is_model(mesh)) return word = mesh.name();
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / ("sixdof-conformance-" + mesh.hash() + ".ply");
  if (!std::filesystem::exists(file)) save_mesh(mesh, file);
  return word = file.string();
}

template <class T>
void ask_into(Query& query, Outcome<T> (Query::*question)(const Pose&), const Pose& X_AB, Outcome<T>& answer,
              std::string& words) {
  const auto failed = [&words](const std::string& why) { words = why; };
  answer = ask_guarded([&] { return (query.*question)(X_AB); }, failed);
  if (words.empty()) examine(query, answer, failed);
}

/// Bits of two doubles; NaN equals NaN.
bool same_bits(double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0 || x == y; }

}  // namespace

Subject::Subject(std::unique_ptr<Algorithm> made, Declaration declaration)
    : algorithm(std::move(made)), declared(std::move(declaration)), settings(algorithm->settings()) {
  settings.set_all(declared.settings);
}

std::unique_ptr<Query> Subject::prepare(const Mesh& a, const Mesh& b) const {
  return algorithm->prepare(a, b, settings);
}

Answers Subject::ask(Query& query, Kind kind, const Pose& X_AB) const {
  Answers result;
  if (kind == Kind::collide) ask_into(query, &Query::collide, X_AB, result.collide, result.words);
  if (kind == Kind::distance) ask_into(query, &Query::distance, X_AB, result.distance, result.words);
  if (kind == Kind::respond) ask_into(query, &Query::respond, X_AB, result.respond, result.words);
  return result;
}

Answers Subject::ask(Query& query, const Pose& X_AB) const {
  Answers all;
  for (const Kind kind : k_kinds) {
    if (!answers(kind)) continue;
    const Answers one = ask(query, kind, X_AB);
    if (kind == Kind::collide) all.collide = one.collide;
    if (kind == Kind::distance) all.distance = one.distance;
    if (kind == Kind::respond) all.respond = one.respond;
    if (!one.words.empty()) all.words = one.words;
  }
  return all;
}

std::ostream& operator<<(std::ostream& out, const At& at) {
  out << "\nat: " << at.a.name() << " (A), " << at.b.name() << " (B)\n  sixdof query --a " << word_of(at.a) << " --b "
      << word_of(at.b) << " --pose '" << at.pose.text() << "' --algorithm " << at.subject.traits().name;
  for (const std::string& setting : at.subject.declared.settings) out << " -p " << setting;
  return out;
}

double wrench_difference(const Response& x, const Response& y, double length) {
  const double force = x.force.norm();
  const double forces = (x.force - y.force).norm(), torques = (x.torque - y.torque).norm() / length;
  const double difference = std::max(forces, torques);
  return difference == 0.0 ? 0.0 : difference / force;
}

double angle_between(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  constexpr double k_degrees = 180.0 / 3.14159265358979323846;
  return std::atan2(x.cross(y).norm(), x.dot(y)) * k_degrees;
}

bool expect_answered(const Subject& subject, const Answers& answers, const At& at) {
  for (const Kind kind : k_kinds) {
    if (!subject.answers(kind)) continue;
    const Status status = answers.status(kind);
    EXPECT_EQ(to_string(status), to_string(Status::ok)) << answers.words << at;
    if (status != Status::ok) return false;
  }
  return true;
}

void expect_repeated(const Subject& subject, const Answers& first, const Answers& again, const At& at) {
  const double allowed = subject.declared.repeat_error;
  if (!expect_answered(subject, first, at) || !expect_answered(subject, again, at)) return;
  if (subject.answers(Kind::collide)) {
    EXPECT_EQ(first.collide.value, again.collide.value) << at;
  }
  if (subject.answers(Kind::distance)) {
    EXPECT_NEAR(first.distance.value.distance, again.distance.value.distance, allowed * at.a.diagonal()) << at;
  }
  if (subject.answers(Kind::respond)) {
    const Response &x = first.respond.value, &y = again.respond.value;
    EXPECT_LE(wrench_difference(x, y, at.a.diagonal()), allowed)
        << "force " << x.force.transpose() << " and " << y.force.transpose() << at;
    EXPECT_LE(std::abs(x.penalty - y.penalty), allowed * std::abs(x.penalty)) << at;
    EXPECT_TRUE(allowed > 0.0 || same_bits(x.volume, y.volume)) << "volume " << x.volume << " and " << y.volume << at;
  }
}

}  // namespace sixdof::conformance
