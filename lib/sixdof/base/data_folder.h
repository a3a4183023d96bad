#pragma once

#include <filesystem>

namespace sixdof {

/// The folder with the files that come with the programs: `fixtures/manifest.json` and the sets that it lists, `bench/`
/// with lists of rows, `models/` with what fetches models. It is, whichever comes first:
///
/// - that of environment variable SIXDOF_DATA, if the variable is set and not empty;
/// - that of the last LinkedDataFolder, if it exists;
/// - the first `share/sixdof` in a folder above the running program: of an installation, wherever it was moved, or of
///   a folder of builds;
/// - `share/sixdof` in the current directory.
///
/// @return canonical if it exists
std::filesystem::path data_folder();

/// The first FOLDER/wanted that exists, for `folder` and the folders above it; empty if there is none.
std::filesystem::path find_above(std::filesystem::path folder, const std::filesystem::path& wanted);

/// Tells a program that lies elsewhere where the data of the package are that it was linked with. Each program that
/// links sixdof::bench_main or sixdof::cli_main has one (cmake/linked_data_folder.cpp).
struct LinkedDataFolder {
  /// The folder that data_folder() then returns if it exists.
  explicit LinkedDataFolder(std::filesystem::path folder);
};

}  // namespace sixdof
