#include "bench/cli/commands.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/shard_file.h>
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/pair_warnings.h"
#include "bench/common/progress_line.h"

namespace sixdof::cli {
namespace {

struct Arguments {
  std::string folder, output;
  bool progress = false;
};

void merge(const Arguments& arguments) {
  remove_stale_partials(arguments.output);
  {
    ProgressLine line("merged", arguments.progress);
    merge_shards(arguments.folder, arguments.output,
                 {.progress = [&](std::uint64_t done, std::uint64_t total) { line.show(done, total); },
                  .cancelled = InterruptGuard::requested});
  }
  const ConfigurationSet set(arguments.output);
  warn_of_unreached("sixdof", set);
  fmt::print("{}: {} with {}, {} buckets, content hash {}\n", arguments.output, set.description().a.name,
             set.description().b.name, set.buckets().size(), set.hash());
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto* const command = app.add_subcommand("merge", "Make one configuration set of the shards in a folder");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("folder", arguments->folder, "The folder that sixdof generate --shards wrote")
      ->required()
      ->type_name("FOLDER");
  command->add_option("-o,--output", arguments->output, "The set to write (HDF5); replaced if it exists")
      ->required()
      ->type_name("FILE");
  command->add_flag("--progress", arguments->progress, "Show progress where stderr is not a terminal, too");
  add_examples(*command, "sixdof generate --a cone-1k --grid 60 --distances 0:3 --shards 4 --resume -o shards",
               "sixdof merge shards -o merged.h5");
  command->callback([arguments] { merge(*arguments); });
}

}  // namespace sixdof::cli
