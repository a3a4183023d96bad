#include <sixdof/algorithm/registry.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/algorithm/exact.h>
#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/null.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/base/error.h>

namespace sixdof {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::unsupported:
      return "unsupported";
    case Status::failed:
      return "failed";
    case Status::non_finite:
      return "non_finite";
    case Status::timed_out:
      return "timed_out";
  }
  return "unknown";
}

void Registry::add(std::unique_ptr<Algorithm> algorithm) {
  const std::string& name = algorithm->traits().name;
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos) {
    throw BadArgument(fmt::format("algorithm name '{}': only a-z, 0-9 and '-'", name));
  }
  for (const auto& other : algorithms_) {
    if (other->traits().name == name) throw BadArgument(fmt::format("algorithm {}: registered already", name));
  }
  algorithms_.push_back(std::move(algorithm));
}

const Algorithm& Registry::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const auto& algorithm : algorithms_) {
    if (algorithm->traits().name == name) return *algorithm;
    names.push_back(algorithm->traits().name);
  }
  throw BadArgument(fmt::format("algorithm {}: no such algorithm; there are {}", name, fmt::join(names, ", ")));
}

void register_core_algorithms(Registry& registry) {
  registry.add(make_null_algorithm());
  registry.add(make_exact_algorithm());
  registry.add(make_ist_algorithm());
  registry.add(make_vps_algorithm());
  registry.add(make_vps_field_algorithm());
}

}  // namespace sixdof
