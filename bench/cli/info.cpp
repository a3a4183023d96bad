#include "bench/cli/info.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "bench/cli/info_mesh.h"
#include "bench/cli/set_info.h"
#include <sixdof/configuration/configuration_set.h>

namespace sixdof::cli {
namespace {

/// A kind of file: which ones, and what to print.
struct Reader {
  bool (*claims)(std::string_view name_or_file);
  void (*print)(const std::string& name_or_file, bool json);
};

/// Asked in this order; the last claims everything.
constexpr std::array k_readers{
    Reader{[](std::string_view file) { return looks_like_configuration_set(file); }, print_set_info},
    Reader{[](std::string_view) { return true; }, print_mesh_info},
};

}  // namespace

void add_info_command(CLI::App& app) {
  auto* const command = app.add_subcommand("info", "What is in a file: counts, soundness, measures, hash");
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("file", *name, "File, or a model's name (see sixdof models list)")->required();
  command->add_flag("--json", *json, "As JSON");
  command->callback([name, json] {
    const auto* const reader =
        std::find_if(k_readers.begin(), k_readers.end(), [&](const Reader& r) { return r.claims(*name); });
    reader->print(*name, *json);
  });
}

}  // namespace sixdof::cli
