#include <sixdof/query/variant.h>

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sixdof {

std::string variant_name(std::string_view algorithm, const std::vector<std::string>& assignments) {
  return fmt::format("{}{}{}", algorithm, k_variant_mark, fmt::join(assignments, ","));
}

std::vector<std::string> variant_assignments(std::string_view name) {
  std::vector<std::string> assignments;
  std::size_t at = name.find(k_variant_mark);
  while (at != std::string_view::npos) {
    const std::size_t end = name.find(',', at + 1);
    assignments.emplace_back(name.substr(at + 1, end == std::string_view::npos ? end : end - at - 1));
    at = end;
  }
  return assignments;
}

VariantAlgorithm::VariantAlgorithm(std::shared_ptr<const Algorithm> base, const std::vector<std::string>& assignments)
    : base_(std::move(base)), traits_(base_->traits()) {
  Settings settings = base_->settings();
  settings.set_all(assignments);
  for (Parameter& parameter : traits_.parameters) parameter.default_value = settings.choice(parameter.name);
  if (!assignments.empty()) traits_.name = variant_name(traits_.name, assignments);
}

const Algorithm& base_algorithm(const Algorithm& algorithm) {
  const auto* const variant = dynamic_cast<const VariantAlgorithm*>(&algorithm);
  return variant == nullptr ? algorithm : variant->base();
}

}  // namespace sixdof
