#include <sixdof/conformance/findings.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace sixdof::conformance {
namespace {

AskedQuery asked_query(const At& at) { return {meshes_of(at), command_of(at)}; }

std::string difference_text(const char* what, double value, double expected, double allowed) {
  return fmt::format("{} is {} instead of {}; a difference of {:.3g} is allowed", what, value, expected, allowed);
}

bool is_near(double value, double expected, double allowed) { return std::abs(value - expected) <= allowed; }

/// Bits of two doubles; NaN equals NaN.
bool same_bits(double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0 || x == y; }

}  // namespace

std::string to_string(const Failure& failure) {
  std::string text = failure.what;
  for (const AskedQuery& query : failure.queries) text += fmt::format("\nat: {}\n  {}", query.meshes, query.command);
  return text;
}

void Findings::fail(std::string what, const At& at) { failures_.push_back({std::move(what), {asked_query(at)}}); }

void Findings::fail(std::string what, const At& first, const At& second) {
  failures_.push_back({std::move(what), {asked_query(first), asked_query(second)}});
}

void Findings::expect_near(const char* what, double value, double expected, double allowed, const At& at) {
  if (!is_near(value, expected, allowed)) fail(difference_text(what, value, expected, allowed), at);
}

void Findings::expect_near(const char* what, double value, double expected, double allowed, const At& first,
                           const At& second) {
  if (!is_near(value, expected, allowed)) fail(difference_text(what, value, expected, allowed), first, second);
}

bool Findings::expect_ok(const Answers& answers, Kind kind, const At& at) {
  const Status status = answers.status(kind);
  if (status == Status::ok) return true;
  fail(fmt::format("no answer to {}, status {}: {}", to_string(kind), to_string(status), answers.words), at);
  return false;
}

void Findings::has_no_claim(const char* member) { unclaimed_ = fmt::format("{} is not claimed", member); }

bool expect_answered(const Subject& subject, const Answers& answers, const At& at, Findings& findings) {
  for (const Kind kind : k_kinds) {
    if (subject.answers(kind) && !findings.expect_ok(answers, kind, at)) return false;
  }
  return true;
}

void expect_repeated(const Subject& subject, const Answers& first, const Answers& again, const At& at,
                     Findings& findings) {
  const double allowed = subject.declared.repeat_error;
  if (!expect_answered(subject, first, at, findings) || !expect_answered(subject, again, at, findings)) return;
  if (first.collide.value != again.collide.value) {
    findings.fail(fmt::format("{}, then {}", yes_or_no(first.collide.value), yes_or_no(again.collide.value)), at);
  }
  if (subject.answers(Kind::distance)) {
    findings.expect_near("the distance, asked again,", again.distance.value.distance, first.distance.value.distance,
                         allowed * at.a.diagonal(), at);
  }
  if (!subject.answers(Kind::respond)) return;
  const Response &x = first.respond.value, &y = again.respond.value;
  if (!(wrench_difference(x, y, at.a.diagonal()) <= allowed)) {
    findings.fail(fmt::format("force {}, then {}; torque {}, then {}", text_of(x.force), text_of(y.force),
                              text_of(x.torque), text_of(y.torque)),
                  at);
  }
  findings.expect_near("the penalty, asked again,", y.penalty, x.penalty, allowed * std::abs(x.penalty), at);
  if (!(allowed > 0.0 || same_bits(x.volume, y.volume))) {
    findings.fail(fmt::format("volume {}, then {}", x.volume, y.volume), at);
  }
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

const char* yes_or_no(bool answer) { return answer ? "yes" : "no"; }

std::string text_of(const Eigen::Vector3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z()); }

}  // namespace sixdof::conformance
