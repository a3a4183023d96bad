#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/query/algorithm.h>

/// What makes an answer to a configuration wrong: the one definition for rows, studies and `sixdof agree`.

namespace sixdof::bench {

/// What a set says of a configuration.
struct KnownAnswer {
  BucketKey key;
  double target = 0.0;     ///< Distance (length) or overlap volume (length^3).
  double tolerance = 0.0;  ///< Of `target`, same unit.
  double diagonal = 0.0;   ///< Of A's box (length).
  /// How far the bodies that the algorithm answers for may lie from the true ones (length): Footprint's "resolution" of
  /// one that approximates.
  double resolution = 0.0;

  static KnownAnswer of(const BucketSample& bucket) {
    return {bucket.key, bucket.target, bucket.tolerance, bucket.diagonal};
  }
};

/// A distance is wrong if it differs by more than the set's own tolerance plus this fraction of A's diagonal. Two exact
/// algorithms in double precision differ by some 1e-13 for coordinates of the size of the diagonal; approximations
/// differ by far more than this.
constexpr double k_distance_slack = 1e-9;

/// Larger errors, e.g. of an answer of 1e308, count as this one, whose square and sums of it do not overflow.
constexpr double k_largest_error = 1e150;

/// An answer beside the known one.
struct Judgement {
  bool judged = false;  ///< There is a known answer to compare with.
  bool wrong = false;   ///< The other yes/no, or a distance beyond the tolerance.
  bool missed = false;  ///< A response without a force although the bodies overlap.
  /// A response with a force or a torque although the bodies are apart, and how large the force is.
  std::optional<double> phantom_force = {};
  /// Answer minus known answer: distances in A's diagonals, volumes in the known volume.
  std::optional<double> error = {};
};

/// Yes/no is not judged in bucket 0, where both answers to touching bodies are right.
Judgement judge(const KnownAnswer& known, bool answer);

/// Configurations of an overlap bucket have distance 0.
Judgement judge(const KnownAnswer& known, const Separation& answer);

/// Responses are judged in overlap buckets, where each has a force. The volume, where there is one, is compared with
/// the bucket's. It is never wrong, since many algorithms approximate it. Bodies that are apart have no force: one is
/// wrong where their distance is greater than the algorithm's resolution. Touching bodies (0 %) may have a force or
/// none.
Judgement judge(const KnownAnswer& known, const Response& answer);

/// Absolute values of errors.
class Errors {
 public:
  void add(double error) {
    error = std::min(std::abs(error), k_largest_error);
    ++count_;
    largest_ = std::max(largest_, error);
    sum_ += error;
    squares_ += error * error;
  }
  double largest() const { return largest_; }
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  double rms() const { return count_ == 0 ? 0.0 : std::sqrt(squares_ / static_cast<double>(count_)); }

 private:
  std::size_t count_ = 0;
  double largest_ = 0.0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// How many answers were judged, and how they were.
struct JudgedAnswers {
  std::size_t judged = 0, wrong = 0, missed = 0, phantoms = 0;
  Errors errors, phantom_forces;

  void add(const Judgement& judgement) {
    judged += judgement.judged;
    wrong += judgement.wrong;
    missed += judgement.missed;
    if (judgement.error) errors.add(*judgement.error);
    if (!judgement.phantom_force) return;
    ++phantoms;
    phantom_forces.add(*judgement.phantom_force);
  }
};

}  // namespace sixdof::bench
