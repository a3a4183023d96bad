#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/report/page.h>

namespace sixdof::report {

enum class FigureFormat {
  svg,
  pdf,
  tikz
};

/// How a figure looks in a file.
struct FigureStyle {
  std::string width = {};  ///< "84mm", "3.3in" or "320px"; empty: that of the page. Texts keep their size.
  std::string font = {};   ///< A font family; empty: that of the page.
  bool has_title = true;
};

/// Writes each figure that has data to FOLDER/NAME.svg or .pdf, at the report's choices; of TikZ, each figure of lines
/// or points to NAME.tex, a document for LaTeX with PGFPlots, and the data of its curves to NAME-NUMBER.dat. Runs node
/// with the page's own scripts and, for PDF, rsvg-convert, which embeds the fonts. Files appear whole or not at all.
/// @returns the names of the files
/// @throws BadArgument if a program is not in PATH, with the package that has it, or if no figure offers one of the
/// choices, for a width that is none; BadFile if the folder cannot be written or a program fails, with its last words
std::vector<std::string> write_figures(const Report& report, const PageFiles& files,
                                       const std::filesystem::path& folder, FigureFormat format,
                                       const FigureStyle& style = {});

}  // namespace sixdof::report
