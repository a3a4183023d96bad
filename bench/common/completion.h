#pragma once

#include <map>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace sixdof {

/// What completes the value of an option.
struct ValueWords {
  std::vector<std::string> words;
  bool files = false;
  bool folders = false;
};

/// By the name that the value has in the help (common/help_format.h): "ALGORITHM", "MESH".
using ValueTable = std::map<std::string, ValueWords>;

/// FILE, FOLDER, and MESH: names of models, recipes with a few counts, and files.
ValueTable common_values();

/// A script for bash that completes commands, options and values of a program, made of the parser's own definition: of
/// the commands below `app`, their options, the choices and names of their values, and of lists the last element.
/// @param program the name that is completed
/// @param more options of the first level that the parser does not know: "--benchmark_filter"
std::string bash_completion(const CLI::App& app, const std::string& program, const ValueTable& values,
                            const std::vector<std::string>& more = {});

}  // namespace sixdof
