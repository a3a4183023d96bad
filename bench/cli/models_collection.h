#pragma once

#include <string>

namespace sixdof::cli {

/// Prints the objects of a collection, and every mesh that was left out with the reason.
/// @throws BadArgument unless there is a collection of that name
void list_collection(const std::string& name, bool json);

}  // namespace sixdof::cli
