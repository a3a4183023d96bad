#include "bench/cli/rival_claims.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::cli {

conformance::Declaration declaration_of_rival(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / "ready" / (name + ".json");
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  conformance::Declaration declaration;
  try {
    const auto json = nlohmann::json::parse(in).value("conformance", nlohmann::json::object());
    const auto claims = json.value("claims", nlohmann::json::object());
    for (const auto& [claim, value] : claims.items()) {
      conformance::set_claim(declaration, claim, value.get<std::string>());
    }
    const auto known = json.value("known_failures", nlohmann::json::array());
    for (const auto& each : known) {
      declaration.known_failures.push_back({each.at("check").get<std::string>(), each.at("reason").get<std::string>(),
                                            each.value("issue", std::string())});
    }
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), e.what());
  } catch (const BadArgument& e) {
    throw BadFile(file.string(), e.what());
  }
  return declaration;
}

}  // namespace sixdof::cli
