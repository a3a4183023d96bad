#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <sixdof/report/comparison.h>
#include <sixdof/report/data_table.h>
#include <sixdof/report/scene.h>
#include <sixdof/report/series.h>
#include <sixdof/report/summary.h>
#include <sixdof/results/results.h>

namespace sixdof::report {

using namespace results;

/// How busy the machine was before a run: other programs make its times longer and less equal.
struct RunLoad {
  std::string name;                     ///< As in the tables.
  double load = 0.0, processors = 0.0;  ///< Load average of the last minute; both 0 where the file has none.

  bool is_busy() const { return load > k_busy_share * processors; }
  static constexpr double k_busy_share = 0.5;  ///< Of the processors.
};

/// Everything that a report shows.
struct Report {
  Summary summary;
  std::vector<Comparison> comparisons;
  std::vector<DataTable> tables;  ///< Those of tables.h, then those of the comparisons.
  Scenes scenes;
  std::vector<std::string> algorithms;  ///< In the order of the files; figures colour them in this order.
  std::vector<RunLoad> runs;            ///< In the order of the files.
  std::string made_from;                ///< One line: files, commit, date.
  /// What figures show at first, by the column from which a reader chooses; the default of a figure where it offers no
  /// such value.
  std::map<std::string, std::string> choices = {};
};

/// @param results outlives the call only
Report make_report(const Results& results, const std::vector<Series>& series);

/// The times of many files in the order of their dates, and what changed from the last but one to the last. The page
/// has nothing else of them, so that it stays small. @param results of results::read_folder()
Report make_history(const Results& results);

/// The files of which a page consists: `page/` and `figures/` of this folder, and libraries that the build takes from
/// npm.
struct PageFiles {
  std::filesystem::path folder;
  std::string html, style;
  std::vector<std::string> libraries, scripts;
  std::string pages;                 ///< JSON: the pages with their figures and tables.
  std::vector<std::string> figures;  ///< Vega-Lite, one each.
};

/// @param folder `report` in data_folder()
/// @throws BadFile that names what is missing and, for a library, how it gets there
PageFiles read_page_files(const std::filesystem::path& folder);

/// What figures and tables are made from, as JSON text: read by the page and by page/write_figures.js.
std::string page_data(const Report& report, const PageFiles& files);

/// One HTML file that opens from disk without a network. Texts of results are data in it, never markup: the JSON has no
/// '<', and scripts put texts into the page as text nodes.
std::string page_html(const Report& report, const PageFiles& files);

}  // namespace sixdof::report
