#pragma once

#include <nlohmann/json.hpp>

#include <sixdof/oracle/mesh_check.h>

namespace sixdof::cli {

/// What a check found, with counts and the first places.
nlohmann::ordered_json check_as_json(const MeshCheck& check);

/// The same as rows of `sixdof info`.
void print_check(const MeshCheck& check);

}  // namespace sixdof::cli
