#pragma once

#include <string_view>

namespace sixdof {

/// models/models.json as it was when the library was built, so that an installed program needs no data file.
std::string_view manifest_text();

}  // namespace sixdof
