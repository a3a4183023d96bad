// Part of every program that links sixdof::bench_main or sixdof::cli_main: where the data of that package are.
#include <sixdof/base/data_folder.h>

namespace {
const sixdof::LinkedDataFolder k_linked_data_folder(SIXDOF_LINKED_DATA_FOLDER);
}
