#pragma once

#include <string_view>

#include <sixdof/conformance/declaration.h>

namespace sixdof::conformance {

/// What this project's algorithms and its adapters of other libraries claim, by Traits::name; the defaults for any
/// other name.
Declaration declaration_of(std::string_view algorithm);

}  // namespace sixdof::conformance
