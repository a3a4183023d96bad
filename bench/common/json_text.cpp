#include "bench/common/json_text.h"

#include <nlohmann/json.hpp>

namespace sixdof {

using Json = nlohmann::ordered_json;

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sixdof
