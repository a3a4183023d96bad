#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row_group.h>

/// From which amplitude on building the tree of a mesh that deforms anew is faster than refitting it.
namespace sixdof::results {

/// Update and query of a frame together, as processor times.
struct PayoffPoint {
  double amplitude = 0.0;   ///< Largest displacement of a vertex, in percent of the mesh's diagonal.
  double refit_ns = 0.0;    ///< Of the way that keeps the tree.
  double rebuild_ns = 0.0;  ///< Of the fastest way of the same library that builds it anew.
};

/// A way of a library to update without building anew, in a family of scenes, for a question.
struct Payoff {
  std::size_t file = 0;             ///< Index into Results::files.
  std::string family, question;     ///< Of the scene.
  std::string refit;                ///< Algorithm: "fcl-refit", "exact".
  std::vector<PayoffPoint> points;  ///< By amplitude; at least one.

  /// The least measured amplitude from which on building anew is faster, at all larger ones as well; empty if it is
  /// slower at the largest.
  std::optional<double> rebuild_wins_from() const;
};

/// Of the `deform/...` rows without faults. What belongs together has a name with the same word before the first '-'; a
/// way builds anew if "rebuild" follows it. @param groups of some files
std::vector<Payoff> refit_payoffs(std::span<const RowGroup> groups);

}  // namespace sixdof::results
