#pragma once

#include <string_view>

namespace sixdof {

/// The content of models/models.json: a part of the library, so that an installed program needs no data file.
std::string_view manifest_text();

}  // namespace sixdof
