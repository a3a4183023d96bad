#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <sixdof/scene/scene_algorithm.h>
#include <sixdof/scene/truth.h>

namespace sixdof::scene {

/// A pair that an algorithm missed or reported wrongly, with what is needed to ask for it alone.
struct WrongPair {
  std::size_t frame = 0;  ///< Index into Scene::frames.
  BodyPair pair;          ///< Which two.
  double truth = 0.0;     ///< Distance (length).
  bool missed = false;    ///< Else it is reported, but not true.
};

/// Answers against the truth. Answers may differ where bodies graze: where a translation by k_grazing times their size
/// in some direction changes the true answer. Such pairs are counted apart, except for algorithms of this project,
/// whose answers have the bits of the truth.
struct Score {
  /// ODE's trees hold floats: a few roundings of 6e-8 of the coordinates, which may be a hundred times the bodies'
  /// size.
  static constexpr double k_grazing = 1e-5;

  std::size_t frames = 0;      ///< That were answered.
  std::size_t true_pairs = 0;  ///< Of all frames.
  std::size_t missed = 0;      ///< True pairs that are not reported. One is a failure.
  std::size_t wrong = 0;       ///< Pairs that are reported and not true.
  std::size_t grazing = 0;     ///< Of either, where bodies graze; not in `missed` and `wrong`.
  /// True pairs of a body inside another that an algorithm for surfaces only does not report; not in `missed`.
  std::size_t nested = 0;
  double largest_error = 0.0;      ///< Of the distances of true pairs that are reported (length).
  bool same_bits = false;          ///< All answers have the bits of the truth.
  std::string hash;                ///< Of all answers, as SceneAnswers::hash.
  std::optional<WrongPair> first;  ///< The first that is missed, else the first that is wrong.

  /// Whether a pair is missed or wrong.
  bool failed() const { return missed > 0 || wrong > 0; }
};

/// Compares answers with the truth.
/// @param answers of every frame, in order
/// @param exactly no pair counts as grazing
/// @param surfaces_only SceneTraits::surfaces_only of who answers
Score score(const Scene& scene, Question question, const SceneAnswers& truth, const SceneAnswers& answers, bool exactly,
            bool surfaces_only = false);

/// What a replay took.
struct Timing {
  double prepare_s = 0.0;  ///< Wall time of preparing.
  double first_us = 0.0;   ///< Wall time of the first frame, in which all pairs are new.
  // Of the further frames, or of the first if there is no other: deform(), update() and answer().
  double mean_us = 0.0;       ///< Mean wall time.
  double p99_us = 0.0;        ///< 99th percentile of the wall times, by the nearest-rank rule.
  double max_us = 0.0;        ///< Longest wall time.
  double processor_us = 0.0;  ///< Mean processor time of all threads, of deform(), update() and answer() together.
  double update_us = 0.0;     ///< Of it: deform() and update().
  double answer_us = 0.0;     ///< Of it: answer().
};

/// A replay, judged.
struct Play {
  SceneAnswers answers;            ///< What the algorithm said.
  Score score;                     ///< How right that was.
  Timing timing;                   ///< How long it took.
  SceneWork work;                  ///< Of all frames.
  std::size_t bytes = 0;           ///< SceneQuery::bytes()
  std::uint64_t pairs_in_all = 0;  ///< Pairs that matter, times frames.

  /// Pairs asked of the narrow phase that are not true, per true pair.
  double false_per_true() const;
};

/// Replays a scene to an algorithm and judges its answers afterwards. @throws Error if an answer is not sorted or has a
/// distance that is not finite; what prepare() throws; Interrupted if `cancelled` says so before a frame
Play play(const Scene& scene, const SceneAlgorithm& algorithm, Question question, const SceneAnswers& truth,
          const std::function<bool()>& cancelled = {});

}  // namespace sixdof::scene
