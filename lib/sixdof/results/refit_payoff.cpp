#include <sixdof/results/refit_payoff.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace sixdof::results {
namespace {

std::string library_of(const std::string& algorithm) { return algorithm.substr(0, algorithm.find('-')); }

bool builds_anew(const std::string& algorithm) {
  return algorithm.substr(library_of(algorithm).size()).starts_with("-rebuild");
}

}  // namespace

std::optional<double> Payoff::rebuild_wins_from() const {
  std::optional<double> from;
  for (const PayoffPoint& point : points) {
    if (!(point.rebuild_ns < point.refit_ns)) {
      from.reset();
    } else if (!from) {
      from = point.amplitude;
    }
  }
  return from;
}

std::vector<Payoff> refit_payoffs(std::span<const RowGroup> groups) {
  using Place = std::tuple<std::size_t, std::string, std::string>;    // file, family, question
  std::map<std::tuple<Place, std::string, double>, double> rebuilds;  // of a library at an amplitude: the fastest
  const auto place_of = [](const RowGroup& group) {
    return Place{group.row().file, group.fields().scenario, group.fields().question};
  };
  const auto is_timed = [](const RowGroup& group) {
    return group.fields().query == "deform" && group.faults.empty() && group.value("processor_ns") &&
           group.value("amplitude");
  };
  for (const RowGroup& group : groups) {
    const std::string& algorithm = group.fields().algorithm;
    if (!is_timed(group) || !builds_anew(algorithm)) continue;
    const double ns = *group.value("processor_ns");
    const auto [at, is_new] =
        rebuilds.try_emplace({place_of(group), library_of(algorithm), *group.value("amplitude")}, ns);
    if (!is_new) at->second = std::min(at->second, ns);
  }
  std::vector<Payoff> payoffs;
  for (const RowGroup& group : groups) {
    const std::string& algorithm = group.fields().algorithm;
    if (!is_timed(group) || builds_anew(algorithm)) continue;
    const Place place = place_of(group);
    const double amplitude = *group.value("amplitude");
    const auto rebuild = rebuilds.find({place, library_of(algorithm), amplitude});
    if (rebuild == rebuilds.end()) continue;
    const auto& [file, family, question] = place;
    auto payoff = std::ranges::find_if(payoffs, [&](const Payoff& each) {
      return each.refit == algorithm && Place{each.file, each.family, each.question} == place;
    });
    if (payoff == payoffs.end()) payoff = payoffs.insert(payoffs.end(), {file, family, question, algorithm, {}});
    payoff->points.push_back({amplitude, *group.value("processor_ns"), rebuild->second});
  }
  for (Payoff& payoff : payoffs) std::ranges::sort(payoff.points, {}, &PayoffPoint::amplitude);
  return payoffs;
}

}  // namespace sixdof::results
