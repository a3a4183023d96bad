#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/report/page.h>

namespace sixdof::report {

enum class FigureFormat {
  svg,
  pdf
};

/// Writes each figure that has data to FOLDER/NAME.svg or .pdf, at the report's choices. Runs node with the page's own
/// scripts and, for PDF, rsvg-convert. Files appear whole or not at all.
/// @returns the names of the files
/// @throws BadArgument if a program is not in PATH, with the package that has it, or if no figure offers one of the
/// choices; BadFile if the folder cannot be written or a program fails, with its last words
std::vector<std::string> write_figures(const Report& report, const PageFiles& files,
                                       const std::filesystem::path& folder, FigureFormat format);

}  // namespace sixdof::report
