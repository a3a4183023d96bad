#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row_group.h>

/// How many times faster one algorithm is than the fastest of some others, and how far that spreads over files.

namespace sixdof::results {

/// One kind of row, over the files that have it of the algorithm and of another one, without a fault.
struct Rivalry {
  std::string query, bodies, place;  ///< Bodies are empty in a scene; the place of a `generate` row is its target.
  std::vector<double> own_ns;        ///< By file: rival_time() of the algorithm,
  std::vector<double> rival_ns;      ///< and of the fastest other.
  std::vector<std::string> rivals;   ///< By file: its name.

  std::vector<double> ratios() const;
};

/// What is compared: of a query its mean_time(), of a `generate` row the time of a configuration, of a scene the
/// processor time of a frame, the first apart. RivalTime::p99: the wall clock time that 99 % of the queries, or of the
/// frames of a mesh that deforms, stay below; none of other rows.
enum class RivalTime : std::uint8_t {
  mean,
  p99
};
std::optional<double> rival_time(const RowGroup& group, RivalTime time = RivalTime::mean);

/// @param against names of other algorithms, in which * stands for any part
/// @returns in the order of the groups; rows with a fault, of special orders and cold caches are left out
std::vector<Rivalry> rivalries(std::span<const RowGroup> groups, const std::string& algorithm,
                               std::span<const std::string> against, RivalTime time = RivalTime::mean);

/// Whether a name fits one of the patterns.
bool fits(const std::string& name, std::span<const std::string> patterns);

}  // namespace sixdof::results
