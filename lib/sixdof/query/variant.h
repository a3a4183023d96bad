#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/query/algorithm.h>

/// One algorithm with several settings in one program: each is a variant with a name of its own, so that rows, tables
/// and figures, which know algorithms by their names, tell them apart.

namespace sixdof {

/// Stands in a variant's name between the algorithm's name and its settings: "vps@point_spacing=0.004".
inline constexpr char k_variant_mark = '@';

/// The algorithm's own name: "vps" of "vps@point_spacing=0.004" and of "vps".
inline std::string base_name(std::string_view name) { return std::string(name.substr(0, name.find(k_variant_mark))); }

/// "vps@voxel_size=0.01,point_spacing=0.004". @param assignments each reads "parameter=value"
std::string variant_name(std::string_view algorithm, const std::vector<std::string>& assignments);

/// {"voxel_size=0.01", "point_spacing=0.004"} of the name above; empty for the name of an algorithm.
std::vector<std::string> variant_assignments(std::string_view name);

/// An algorithm whose defaults are other values of its parameters, under a name that says so; with none, the algorithm
/// as it is.
class VariantAlgorithm final : public Algorithm {
 public:
  /// @param assignments each reads "parameter=value" @throws BadArgument as Settings::set_all() does
  explicit VariantAlgorithm(std::shared_ptr<const Algorithm> base, const std::vector<std::string>& assignments = {});

  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return base_->prepare(a, b, settings);
  }

  /// The algorithm with its own name and defaults.
  const Algorithm& base() const { return *base_; }

 private:
  std::shared_ptr<const Algorithm> base_;
  Traits traits_;
};

/// The algorithm of a variant; any other one itself.
const Algorithm& base_algorithm(const Algorithm& algorithm);

}  // namespace sixdof
