#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/row_group.h>

/// What `sixdof table --over-objects` and `--growth` print, as Markdown, of the rows of one file.

namespace sixdof::cli {

/// @throws BadArgument if the file has no such rows
std::string over_objects_text(const std::vector<results::RowGroup>& groups);
std::string growth_text(const std::vector<results::RowGroup>& groups);

/// The members "collection" and "growth" of a result file. @throws BadArgument if the file has no such rows
nlohmann::json over_objects_json(const std::vector<results::RowGroup>& groups);
nlohmann::json growth_json(const std::vector<results::RowGroup>& groups);

}  // namespace sixdof::cli
