#include <sixdof/base/data_folder.h>

#include <cstdlib>
#include <system_error>
#include <utility>

namespace sixdof {
namespace {

std::filesystem::path& linked_folder() {
  static std::filesystem::path folder;
  return folder;
}

std::filesystem::path resolved(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(folder, ignored);
}

std::filesystem::path folder_above_program() {
  std::error_code ignored;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  const std::filesystem::path data = std::filesystem::path("share") / "sixdof";
  const std::filesystem::path found = find_above(here, data);
  return found.empty() ? data : found;
}

}  // namespace

std::filesystem::path find_above(std::filesystem::path folder, const std::filesystem::path& wanted) {
  std::error_code ignored;
  for (; !folder.empty(); folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / wanted, ignored)) return folder / wanted;
    if (folder == folder.parent_path()) break;
  }
  return {};
}

std::filesystem::path data_folder() {
  const char* const chosen = std::getenv("SIXDOF_DATA");
  if (chosen != nullptr && *chosen != '\0') return resolved(chosen);
  std::error_code ignored;
  if (std::filesystem::is_directory(linked_folder(), ignored)) return resolved(linked_folder());
  return resolved(folder_above_program());
}

LinkedDataFolder::LinkedDataFolder(std::filesystem::path folder) { linked_folder() = std::move(folder); }

}  // namespace sixdof
