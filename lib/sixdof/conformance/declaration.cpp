#include <sixdof/conformance/declaration.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::conformance {
namespace {

constexpr std::pair<const char*, double Declaration::*> k_errors[] = {
    {"distance_error", &Declaration::distance_error},
    {"witness_error", &Declaration::witness_error},
    {"volume_error", &Declaration::volume_error},
    {"force_degrees", &Declaration::force_degrees},
    {"order_error", &Declaration::order_error},
    {"motion_error", &Declaration::motion_error},
    {"scale_error", &Declaration::scale_error},
    {"repeat_error", &Declaration::repeat_error},
    {"cast_error", &Declaration::cast_error},
    {"contact_error", &Declaration::contact_error},
    {"contact_degrees", &Declaration::contact_degrees},
    {"depth_error", &Declaration::depth_error},
    {"contact_change_degrees", &Declaration::contact_change_degrees}};

/// Which of two words a value is. @throws BadArgument
bool is_first(const std::string& name, const std::string& value, const char* first, const char* second) {
  if (value == first) return true;
  if (value == second) return false;
  throw BadArgument(fmt::format("claim {}={}: must be {} or {}", name, value, first, second));
}

double parse_error(const std::string& name, const std::string& value) {
  if (value == "none") return k_no_claim;
  double number = 0.0;
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || stop != end || !(number >= 0.0)) {
    throw BadArgument(fmt::format("claim {}={}: must be a number, 0 or more, or none", name, value));
  }
  return number;
}

}  // namespace

void set_claim(Declaration& declaration, const std::string& name, const std::string& value) {
  if (name == "collide") {
    declaration.collide = is_first(name, value, "bodies", "surfaces") ? Meaning::bodies : Meaning::surfaces;
    return;
  }
  if (name == "open_meshes") {
    declaration.open_meshes = is_first(name, value, "yes", "no");
    return;
  }
  const auto* const found = std::ranges::find_if(k_errors, [&](const auto& each) { return name == each.first; });
  if (found != std::end(k_errors)) {
    declaration.*found->second = parse_error(name, value);
    return;
  }
  std::string names = "collide, open_meshes";
  for (const auto& each : k_errors) names += fmt::format(", {}", each.first);
  throw BadArgument(fmt::format("claim {}: no such claim; there are {}", name, names));
}

}  // namespace sixdof::conformance
