#include "bench/cli/equivalent_text.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include <sixdof/results/paper.h>
#include "bench/study/equivalent_scenario.h"

namespace sixdof::cli {
namespace {

using study::EquivalentResult;
using study::Goal;
using study::Reach;
using study::SearchStep;

std::string given_text(const EquivalentResult& result) {
  return result.options.goal == Goal::time ? "tau = " + study::time_text(result.options.target)
                                           : fmt::format("eta = {:.4g}", result.options.target);
}

/// "sigma_F + gamma_F" with the weights.
std::string eta_text(const EquivalentResult& result, const std::string& weights) {
  const std::string_view wrench = study::rated_wrench(result.scenario);
  return fmt::format("eta = w_sigma sigma_{0} + w_gamma gamma_{0} (radians), {1}", wrench, weights);
}

void print_step(const std::string& name, const SearchStep& step) {
  constexpr double k_ns_per_us = 1e3;
  fmt::print("{:<10} {:>14.4g} {:>14.4g} {:>12.4g} {:>12.4g} {:>10.4g} {:>10.4g}\n", name, step.measured.at[0],
             step.measured.at[1], step.time_predicted_ns / k_ns_per_us, step.measured.time_ns / k_ns_per_us,
             step.eta_predicted, step.measured.eta);
}

void print_grid(const EquivalentResult& result) {
  constexpr double k_ns_per_us = 1e3;
  fmt::print("{:<10} {:>14} {:>14} {:>12} {:>12} {:>10} {:>10}\n", "", result.axes[0].parameter,
             result.axes[1].parameter, "pred., us", "time, us", "pred. eta", "eta");
  for (const study::Measurement& point : result.search.grid) {
    fmt::print("{:<10} {:>14.4g} {:>14.4g} {:>12} {:>12.4g} {:>10} {:>10.4g}\n", "grid", point.at[0], point.at[1], "",
               point.time_ns / k_ns_per_us, "", point.eta);
  }
}

/// What to know of the answer besides its numbers.
void print_remarks(const EquivalentResult& result) {
  const SearchStep& answer = result.search.answer();
  if (answer.reach == Reach::inside) {
    const bool time = result.options.goal == Goal::time;
    fmt::print("{} than requested: no resolution at {} is predicted to be {}\n", time ? "faster" : "better",
               given_text(result), time ? "better" : "faster");
  } else if (answer.reach != Reach::on_line) {
    const bool time = result.options.goal == Goal::time;
    const char* const what = answer.reach == Reach::below ? (time ? "faster" : "better") : (time ? "slower" : "worse");
    std::string range;
    for (const study::ResolutionAxis& axis : result.axes) {
      range += fmt::format(" {}={:.4g}..{:.4g}", axis.parameter, axis.low, axis.high);
    }
    fmt::print("{} cannot be met: all resolutions in{} are {}\n", given_text(result), range, what);
  }
  for (const auto& [name, value] : answer.measured.counters) {
    if (name == "misses" && value > 0.0) fmt::print("{} steps of the window have no force and are not in eta\n", value);
  }
  if (!result.search.converged) {
    fmt::print("no prediction was within {:.0f} % in time and eta\n", 100.0 * result.options.tolerance);
  }
}

}  // namespace

void print_equivalent(const EquivalentResult& result, const std::string& weights) {
  const SearchStep& answer = result.search.answer();
  fmt::print("scenario {}, algorithm {}, law {}, {}\n{}\n", result.scenario, result.algorithm, result.law,
             given_text(result), eta_text(result, weights));
  print_grid(result);
  for (std::size_t k = 0; k < result.search.steps.size(); ++k) {
    print_step(k == 0 ? "first" : fmt::format("refined {}", k), result.search.steps[k]);
  }
  const SearchStep& first = result.search.first();
  fmt::print("fits       time {} (off by {:.2g} % where a point is left out), eta {} ({:.2g} %)\n",
             to_string(first.time_form), 100.0 * first.time_leave_one_out, to_string(first.eta_form),
             100.0 * first.eta_leave_one_out);
  fmt::print("answer     {}={} {}={}: {}, eta {:.4g}\n", result.axes[0].parameter, answer.measured.at[0],
             result.axes[1].parameter, answer.measured.at[1], study::time_text(answer.measured.time_ns),
             answer.measured.eta);
  print_remarks(result);
  fmt::print("\n");
}

void print_prediction_errors(std::span<const EquivalentResult> results) {
  std::vector<std::string> names;
  for (const EquivalentResult& result : results) {
    if (std::ranges::find(names, result.algorithm) == names.end()) names.push_back(result.algorithm);
  }
  fmt::print("mean |eta predicted - measured|, times 100; in brackets as a share of the measured eta\n");
  fmt::print("{:<14} {:>8} {:>22} {:>22} {:>10}\n", "algorithm", "searches", "first prediction", "answer", "paper");
  for (const std::string& name : names) {
    std::vector<EquivalentResult> own;
    std::ranges::copy_if(results, std::back_inserter(own),
                         [&](const EquivalentResult& result) { return result.algorithm == name; });
    const auto text = [&](bool first) {
      const study::PredictionError error = prediction_error(own, first);
      return fmt::format("{:.3g} % ({:.3g} %)", 100.0 * error.difference, 100.0 * error.relative);
    };
    const auto paper = results::paper_value("", name, results::k_eta_difference);
    fmt::print("{:<14} {:>8} {:>22} {:>22} {:>10}\n", name, own.size(), text(true), text(false),
               paper ? fmt::format("{:.2g} %", 100.0 * *paper) : "-");
  }
}

}  // namespace sixdof::cli
