// Tables of poses (CSV). An input is the text of a table; its folder has two mesh files. Models by name are refused
// here, as they may be large.
//
// A table is refused by an error that names it, or gives a scene that its own check accepts. A byte order mark and
// lines that end in CR LF change neither.
#include <string>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/scene/scene_csv.h>

#include "fuzz.h"
#include "small_meshes.h"

namespace sixdof::fuzz {
namespace {

const std::filesystem::path& mesh_folder() {
  static const std::filesystem::path folder = [] {
    const auto made = scratch_folder() / "meshes";
    std::filesystem::create_directories(made);
    save_mesh(box(), made / "a.off");
    save_mesh(tetrahedron(), made / "b.off");
    return made;
  }();
  return folder;
}

/// The hash of the scene; the error's words if the table is refused.
std::string outcome(const std::string& text) {
  const auto file = scratch_folder() / "poses.csv";
  write_bytes(file, text);
  try {
    const scene::Scene scene = scene::read_scene_csv(mesh_folder(), file, 0.5);
    scene.check();
    require(scene.bodies.size() >= 2, "a scene has two bodies");
    return scene.hash();
  } catch (const BadFile& e) {
    require(std::string_view(e.what()).starts_with(file.string() + ": "), "an error names the table");
    return e.what();
  }
}

/// Whether a word may be a model's name with a count, "cone-1k": "-" behind letters, but not that of "1e-3".
bool has_model_names(std::string_view text) {
  const auto is_letter = [&](std::size_t at) { return at < text.size() && text[at] >= 'a' && text[at] <= 'z'; };
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string_view::npos; ++at) {
    if (is_letter(at - 1) && (text[at - 1] != 'e' || is_letter(at - 2))) return true;
  }
  return false;
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof::fuzz;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (has_model_names(text)) return 0;
  const std::string once = outcome(text);
  // A carriage return is an end of line of its own, and a mark stands at the beginning only.
  if (text.find('\r') != std::string::npos || text.starts_with("\xEF\xBB\xBF") || text.starts_with("\xFF\xFE") ||
      text.starts_with("\xFE\xFF")) {
    return 0;
  }
  require(outcome("\xEF\xBB\xBF" + text) == once, "a byte order mark changes nothing");
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  require(outcome(crlf) == once, "lines that end in CR LF change nothing");
  return 0;
}
