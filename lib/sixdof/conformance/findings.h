#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sixdof/conformance/subject.h>

namespace sixdof::conformance {

/// A query that a failure is about.
struct AskedQuery {
  std::string meshes;   ///< meshes_of()
  std::string command;  ///< command_of()
};

/// Something that does not hold.
struct Failure {
  std::string what;
  std::vector<AskedQuery> queries;  ///< Those whose answers show it; empty if no single query does.
};

/// In words, with a line "at: MESHES" and a line with the command for each query.
std::string to_string(const Failure& failure);

/// What one check finds: nothing, failures, or that it has nothing to judge.
class Findings {
 public:
  void fail(std::string what) { failures_.push_back({std::move(what), {}}); }
  void fail(std::string what, const At& at);
  void fail(std::string what, const At& first, const At& second);

  /// Fails unless |value - expected| <= allowed. @param what of which the numbers are: "the distance"
  void expect_near(const char* what, double value, double expected, double allowed, const At& at);
  void expect_near(const char* what, double value, double expected, double allowed, const At& first, const At& second);

  /// Fails unless a query of this kind has an answer. @return whether it has
  bool expect_ok(const Answers& answers, Kind kind, const At& at);

  /// Of a check that the declaration makes no claim for. @param member of Declaration
  void has_no_claim(const char* member);
  /// Of a check for which the algorithm gives nothing. @param why in words
  void has_no_answers(const char* why) { unanswered_ = why; }

  const std::vector<Failure>& failures() const { return failures_; }
  const std::string& unclaimed() const { return unclaimed_; }    ///< Why nothing is claimed; empty if something is.
  const std::string& unanswered() const { return unanswered_; }  ///< Why nothing was judged, likewise.

 private:
  std::vector<Failure> failures_;
  std::string unclaimed_, unanswered_;
};

/// Whether every kind that the algorithm answers has an answer; fails with the words if not.
bool expect_answered(const Subject& subject, const Answers& answers, const At& at, Findings& findings);

/// Two answers of one pose must agree within Declaration::repeat_error.
void expect_repeated(const Subject& subject, const Answers& first, const Answers& again, const At& at,
                     Findings& findings);

/// Largest relative difference of two wrenches about one point: of forces by |x.force|, of torques by |x.force| length.
/// 0 if both are zero; infinite if only x is.
double wrench_difference(const Response& x, const Response& y, double length);

/// Angle in degrees, exact for small ones.
double angle_between(const Eigen::Vector3d& x, const Eigen::Vector3d& y);

/// "yes" or "no".
const char* yes_or_no(bool answer);

/// "(1, 0, 0.25)", six digits.
std::string text_of(const Eigen::Vector3d& v);

}  // namespace sixdof::conformance
