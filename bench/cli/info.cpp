#include "bench/cli/info.h"

#include <memory>
#include <string>

#include <sixdof/configuration/configuration_set.h>

#include "bench/cli/info_mesh.h"
#include "bench/cli/set_info.h"
#include "bench/common/examples.h"

namespace sixdof::cli {

void add_info_command(CLI::App& app) {
  auto* const command = app.add_subcommand("info", "Print what a mesh or a configuration set holds");
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("file", *name, "File, or name of a model (sixdof models list)")->required();
  command->add_flag("--json", *json, "As JSON");
  command->callback([name, json] {
    looks_like_configuration_set(*name) ? print_set_info(*name, *json) : print_mesh_info(*name, *json);
  });
  add_examples(*command, "sixdof info cone.ply", "sixdof info torus-knot-10k --json");
}

}  // namespace sixdof::cli
