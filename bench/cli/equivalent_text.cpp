#include "bench/cli/equivalent_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/results/paper.h>
#include "bench/study/equivalent_scenario.h"

namespace sixdof::cli {
namespace {

using results::PaperLine;
using results::Reading;
using study::EquivalentResult;
using study::Goal;
using study::Reach;
using study::SearchStep;

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
               given_text(result.options), time ? "better" : "faster");
  } else if (answer.reach != Reach::on_line) {
    const bool time = result.options.goal == Goal::time;
    const char* const what = answer.reach == Reach::below ? (time ? "faster" : "better") : (time ? "slower" : "worse");
    std::string range;
    for (const study::ResolutionAxis& axis : result.axes) {
      range += fmt::format(" {}={:.4g}..{:.4g}", axis.parameter, axis.low, axis.high);
    }
    fmt::print("{} cannot be met: all resolutions in{} are {}\n", given_text(result.options), range, what);
  }
  for (const auto& [name, value] : answer.measured.counters) {
    if (name == "misses" && value > 0.0) fmt::print("{} steps of the window have no force and are not in eta\n", value);
  }
  if (!result.search.converged) {
    fmt::print("no prediction was within {:.0f} % in time and eta\n", 100.0 * result.options.tolerance);
  }
}

/// Two digits, as the paper prints.
std::string short_number(double value) {
  return std::abs(value) < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

std::string milliseconds(double ns) { return short_number(1e-6 * ns); }

std::string reading_text(const std::optional<Reading>& reading) {
  if (!reading) return "-";
  return short_number(reading->value) + (reading->worse ? " (worse)" : "");
}

Sheet empty_paper_sheet(double tau_ns) {
  return {.title = fmt::format("At a mean query time of {}: values of the paper, and what was measured in their place",
                               study::time_text(tau_ns)),
          .columns = {{.title = "measure", .left = true},
                      {.title = "scenario", .left = true},
                      {.title = "algorithm", .left = true},
                      {.title = "printed"},
                      {.title = "resolutions found", .left = true},
                      {.title = "mean, ms"},
                      {.title = "remark", .left = true},
                      {.title = "as printed, whole path"},
                      {.title = "right ideal, whole path"},
                      {.title = "right ideal, window"},
                      {.title = "by default: window"},
                      {.title = "mean, ms"}}};
}

}  // namespace

void print_equivalent(const EquivalentResult& result, const std::string& weights) {
  const SearchStep& answer = result.search.answer();
  fmt::print("scenario {}, algorithm {}, law {}, {}\n{}\n", result.scenario, result.algorithm, result.law,
             given_text(result.options), eta_text(result, weights));
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

Sheet prediction_sheet(std::span<const EquivalentResult> results) {
  Sheet sheet{.title = "mean |eta predicted - measured|, times 100; in brackets as a share of the measured eta",
              .columns = {{.title = "algorithm", .left = true},
                          {.title = "searches"},
                          {.title = "first prediction"},
                          {.title = "answer"},
                          {.title = "paper"}}};
  std::vector<std::string> names;
  for (const EquivalentResult& result : results) {
    if (std::ranges::find(names, result.algorithm) == names.end()) names.push_back(result.algorithm);
  }
  for (const std::string& name : names) {
    std::vector<EquivalentResult> own;
    std::ranges::copy_if(results, std::back_inserter(own),
                         [&](const EquivalentResult& result) { return result.algorithm == name; });
    const auto text = [&](bool first) {
      const study::PredictionError error = prediction_error(own, first);
      return fmt::format("{:.3g} % ({:.3g} %)", 100.0 * error.difference, 100.0 * error.relative);
    };
    const auto paper = results::paper_value("", name, results::k_eta_difference);
    sheet.lines.push_back({name, std::to_string(own.size()), text(true), text(false),
                           paper ? fmt::format("{:.2g} %", 100.0 * *paper) : "-"});
  }
  return sheet;
}

std::vector<Sheet> paper_sheets(std::span<const PaperLine> lines) {
  std::vector<Sheet> sheets;
  double tau = 0.0;  // of the last sheet
  for (const PaperLine& line : lines) {
    if (sheets.empty() || line.tau_ns != tau) {
      tau = line.tau_ns;
      sheets.push_back(empty_paper_sheet(tau));
    }
    sheets.back().lines.push_back({line.measure, line.scenario, line.algorithm, fmt::format("{:g}", line.printed),
                                   line.resolution, milliseconds(line.mean_ns), line.remark,
                                   reading_text(line.as_printed), reading_text(line.whole_path),
                                   reading_text(line.window), reading_text(line.window_at_defaults),
                                   line.mean_ns_at_defaults ? milliseconds(*line.mean_ns_at_defaults) : "-"});
  }
  return sheets;
}

nlohmann::ordered_json paper_json(std::span<const PaperLine> lines) {
  auto list = nlohmann::ordered_json::array();
  for (const PaperLine& line : lines) {
    nlohmann::ordered_json json = {{"measure", line.measure},     {"scenario", line.scenario},
                                   {"algorithm", line.algorithm}, {"tau_ns", line.tau_ns},
                                   {"printed", line.printed},     {"resolution", line.resolution},
                                   {"measured_ns", line.mean_ns}, {"remark", line.remark}};
    const std::pair<const char*, const std::optional<Reading>*> readings[] = {
        {"as_printed", &line.as_printed},
        {"whole_path", &line.whole_path},
        {"window", &line.window},
        {"window_at_defaults", &line.window_at_defaults}};
    for (const auto& [name, reading] : readings) {
      if (*reading) json[name] = {{"value", (*reading)->value}, {"worse", (*reading)->worse}};
    }
    if (line.mean_ns_at_defaults) json["measured_ns_at_defaults"] = *line.mean_ns_at_defaults;
    list.push_back(std::move(json));
  }
  return list;
}

std::vector<std::string> not_searched_lines(std::span<const study::NotSearched> list) {
  std::vector<std::string> lines;
  for (const study::NotSearched& left : list) {
    lines.push_back(fmt::format("not searched: {} {} at {}: {}", left.scenario, left.algorithm,
                                given_text(left.options), left.why));
  }
  return lines;
}

nlohmann::ordered_json not_searched_json(std::span<const study::NotSearched> list) {
  auto json = nlohmann::ordered_json::array();
  for (const study::NotSearched& left : list) {
    nlohmann::ordered_json entry = {{"scenario", left.scenario}, {"algorithm", left.algorithm}};
    entry[left.options.goal == Goal::time ? "tau_ns" : "eta_wanted"] = left.options.target;
    if (left.needs_s) entry["needs_s"] = *left.needs_s;
    entry["why"] = left.why;
    json.push_back(std::move(entry));
  }
  return json;
}

}  // namespace sixdof::cli
