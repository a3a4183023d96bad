#pragma once

#include <filesystem>
#include <string>

#include <sixdof/conformance/declaration.h>

namespace sixdof::cli {

/// What a rival's recipe says of its conformance: the member "conformance" of ready/NAME.json in a folder of rivals,
/// {"claims": {NAME: VALUE}, "known_failures": [{"check", "reason", "issue"}]}, all optional. Claims are those of
/// conformance::set_claim(), as texts. The defaults where the file has none.
/// @throws BadFile for a file that is not there, or has another form
conformance::Declaration declaration_of_rival(const std::filesystem::path& folder, const std::string& name);

}  // namespace sixdof::cli
