#include <sixdof/scene/scene_csv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/scene/csv_text.h>

namespace sixdof::scene {
namespace {

constexpr std::array<std::string_view, 12> k_columns{"frame", "body", "mesh", "qw", "qx",    "qy",
                                                     "qz",    "tx",   "ty",   "tz", "fixed", "ignored"};
enum Column : std::size_t {
  frame,
  body,
  mesh,
  first_number,
  fixed = 10,  // this one and the next may be left out
  ignored = 11
};

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

/// A number with or without a sign. @returns nothing for other text, and for what no T can hold
template <class T>
std::optional<T> parse(std::string_view text) {
  // "+" is what from_chars does not read.
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A count, also one that was written as a float: "3", "3.0".
std::optional<std::uint32_t> parse_count(std::string_view text) {
  if (const auto count = parse<std::uint32_t>(text)) return count;
  const auto number = parse<double>(text);
  if (!number || *number != std::floor(*number) || !(*number >= 0.0) || *number > 4294967295.0) return std::nullopt;
  return static_cast<std::uint32_t>(*number);
}

class Table {
 public:
  Table(const std::filesystem::path& folder, const std::filesystem::path& file, double margin)
      : folder_(folder), file_(file) {
    scene_.name = file.stem().string();
    scene_.margin = margin;
  }

  Scene read() {
    CsvText text(file_);
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder_, ignored)) throw BadFile(folder_.string(), "no such folder");
    for (CsvText::Row row; text.next(row);) {
      line_ = row.line;
      while (row.cells.size() > columns_ && row.cells.back().empty()) row.cells.pop_back();
      places_.empty() ? read_header(row.cells) : read_row(row.cells);
    }
    if (scene_.frames.empty()) throw BadFile(file_.string(), "has no rows");
    if (scene_.bodies.size() < 2) throw BadFile(file_.string(), "has one body; a scene needs two");
    add_ignored_pairs();
    if (scene_.deforms()) scene_.deformations.resize(scene_.frames.size());
    check();
    return std::move(scene_);
  }

 private:
  void check() const {
    try {
      scene_.check();
    } catch (const BadArgument& e) {
      throw BadFile(file_.string(), e.what());
    }
  }
  [[noreturn]] void refuse(const std::string& cause) const {
    throw BadFile(file_.string(), fmt::format("line {}", line_), cause);
  }
  [[noreturn]] void refuse(std::size_t column, const std::string& cause) const {
    throw BadFile(file_.string(), fmt::format("line {}, column {}", line_, k_columns[column]), cause);
  }

  void read_header(const std::vector<std::string>& names) {
    columns_ = names.size();
    places_.resize(k_columns.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = std::ranges::find(k_columns, in_small_letters(names[i]));
      if (found == k_columns.end()) {
        refuse(fmt::format("no column '{}'; there are {}", names[i], fmt::join(k_columns, ", ")));
      }
      auto& place = places_[static_cast<std::size_t>(found - k_columns.begin())];
      if (place) refuse(fmt::format("column {} comes twice", *found));
      place = i;
    }
    for (std::size_t c = 0; c < fixed; ++c) {
      if (!places_[c]) refuse(fmt::format("the column {} is missing", k_columns[c]));
    }
  }

  std::uint32_t count(std::size_t column, std::string_view text) const {
    const auto value = parse_count(text);
    if (!value) refuse(column, fmt::format("'{}' is not a count", text));
    return *value;
  }

  double number(std::size_t column, std::string_view text) const {
    const auto value = parse<double>(text);
    if (!value && text.find(',') != std::string_view::npos) {
      refuse(column, fmt::format("'{}' is not a number; decimals are written with a point", text));
    }
    if (!value) refuse(column, fmt::format("'{}' is not a number", text));
    if (!std::isfinite(*value)) refuse(column, "is not finite");
    return *value;
  }

  void read_row(const std::vector<std::string>& cells) {
    if (cells.size() != columns_) refuse(fmt::format("{} cells, not {}", cells.size(), columns_));
    const auto cell = [&](std::size_t column) {
      return places_[column] ? std::string_view(cells[*places_[column]]) : std::string_view();
    };
    const std::uint32_t at = count(frame, cell(frame)), id = count(body, cell(body));
    RecordedPose pose;
    for (std::size_t k = 0; k < pose.numbers.size(); ++k) {
      pose.numbers[k] = number(first_number + k, cell(first_number + k));
    }
    try {
      pose.pose();
    } catch (const BadArgument& e) {
      refuse(e.what());
    }
    begin_frame(at);
    if (at == 0) {
      add_body(id, pose, cell(mesh), is_fixed(cell(fixed)));
      note_ignored(id, cell(ignored));
    } else {
      add_motion(id, pose, cell(mesh));
      if (!cell(ignored).empty()) refuse(ignored, "pairs are ignored in all frames; name them in frame 0");
    }
  }

  bool is_fixed(std::string_view text) const {
    const std::string word = in_small_letters(text);
    if (word == "1" || word == "true") return true;
    if (!word.empty() && word != "0" && word != "false") refuse(fixed, fmt::format("'{}' is not 0 or 1", text));
    return false;
  }

  /// Identifiers separated by blanks; in quotes also by separators of cells.
  void note_ignored(std::uint32_t id, std::string_view text) {
    constexpr std::string_view k_between = " \t,;";
    while (!text.empty()) {
      const std::size_t begin = std::min(text.find_first_not_of(k_between), text.size());
      text.remove_prefix(begin);
      const std::string_view word = text.substr(0, text.find_first_of(k_between));
      if (word.empty()) break;
      const std::uint32_t other = count(ignored, word);
      if (other == id) refuse(ignored, fmt::format("body {} is no pair with itself", id));
      ignored_.push_back({line_, other});
      scene_.ignored.push_back(BodyPair::of(id, other));
      text.remove_prefix(word.size());
    }
  }

  /// Either of two bodies may name the other.
  void add_ignored_pairs() {
    for (const auto& [line, id] : ignored_) {
      line_ = line;
      if (!index_.contains(id)) refuse(ignored, fmt::format("body {} is not in frame 0", id));
    }
    std::ranges::sort(scene_.ignored);
    scene_.ignored.erase(std::unique(scene_.ignored.begin(), scene_.ignored.end()), scene_.ignored.end());
  }

  void begin_frame(std::uint32_t at) {
    constexpr std::uint32_t k_most_frames = 10'000'000;
    if (at > k_most_frames) refuse(fmt::format("frame {}: at most {}", at, k_most_frames));
    if (at + 1 < scene_.frames.size()) {
      refuse(fmt::format("frame {} after frame {}", at, scene_.frames.size() - 1));
    }
    if (scene_.frames.empty() && at != 0) refuse(fmt::format("the first frame is {}, not 0", at));
    scene_.frames.resize(at + 1);
  }

  void add_body(std::uint32_t id, const RecordedPose& pose, std::string_view name, bool never_moves) {
    if (name.empty()) refuse(mesh, fmt::format("body {} has none", id));
    if (!index_.emplace(id, scene_.bodies.size()).second) refuse(fmt::format("body {} comes twice in frame 0", id));
    scene_.bodies.push_back({id, mesh_of(name), never_moves, pose});
  }

  void add_motion(std::uint32_t id, const RecordedPose& pose, std::string_view name) {
    const auto found = index_.find(id);
    if (found == index_.end()) refuse(fmt::format("body {} is not in frame 0", id));
    const Body& moved = scene_.bodies[found->second];
    if (moved.fixed) refuse(fmt::format("body {} is fixed and moves", id));
    if (!name.empty()) deform(moved.mesh, std::string(name));
    if (const auto last = last_.find(id); last != last_.end() && last->second + 1 == scene_.frames.size()) {
      refuse(fmt::format("body {} comes twice in frame {}", id, last->second));
    }
    last_[id] = scene_.frames.size() - 1;
    scene_.frames.back().push_back({static_cast<std::uint32_t>(found->second), pose});
  }

  /// From this frame on a mesh has the vertices of a file or model of the same triangles.
  void deform(std::uint32_t deformed, const std::string& name) {
    Shape& shape = shapes_[deformed];
    const std::size_t at = scene_.frames.size() - 1;
    const std::string& before = shape.name.empty() ? name_of(deformed) : shape.name;
    if (name == before) return;
    if (shape.frame == at) refuse(mesh, fmt::format("{} is {} in this frame already", name_of(deformed), before));
    const Mesh& rest = *scene_.meshes[deformed];
    const Mesh other = load(name);
    if (other.triangles() != rest.triangles()) {
      refuse(mesh, fmt::format("{} does not have the triangles of {}, which the body has in frame 0; a mesh deforms if "
                               "its vertices move",
                               name, name_of(deformed)));
    }
    scene_.deformations.resize(at + 1);
    auto& frame = scene_.deformations[at];
    const auto place = std::ranges::lower_bound(frame, deformed, {}, &Deformation::mesh);
    frame.insert(place, {deformed, std::make_shared<const std::vector<Eigen::Vector3d>>(other.vertices())});
    shape = {name, at};
  }

  const std::string& name_of(std::uint32_t index) const {
    return std::ranges::find(meshes_, index, [](const auto& entry) { return entry.second; })->first;
  }

  std::uint32_t mesh_of(std::string_view name) {
    const auto [found, is_new] = meshes_.emplace(name, static_cast<std::uint32_t>(scene_.meshes.size()));
    if (is_new) scene_.meshes.push_back(std::make_shared<const Mesh>(load(found->first)));
    return found->second;
  }

  /// A file of the folder, else a model.
  Mesh load(const std::string& name) const {
    const std::filesystem::path file = folder_ / name;
    std::error_code too_long;  // a name, for a file: it is none
    if (std::filesystem::is_regular_file(file, too_long)) return load_mesh(file);
    if (names_file(name)) refuse(mesh, fmt::format("no file {}", file.string()));
    try {
      return load_model(name);
    } catch (const Error& e) {
      refuse(mesh, fmt::format("no file {}, and: {}", file.string(), e.what()));
    }
  }

  std::filesystem::path folder_, file_;
  std::size_t line_ = 0;
  std::size_t columns_ = 0;                         // 0 before the header
  std::vector<std::optional<std::size_t>> places_;  // of each of k_columns in a row; empty before the header
  std::map<std::uint32_t, std::size_t> index_;      // of a body by its identifier
  std::map<std::uint32_t, std::size_t> last_;       // frame in which a body moved last
  std::map<std::string, std::uint32_t, std::less<>> meshes_;
  struct Shape {
    std::string name;       // empty: as in frame 0
    std::size_t frame = 0;  // since when
  };
  std::map<std::uint32_t, Shape> shapes_;                       // of a mesh
  std::vector<std::pair<std::size_t, std::uint32_t>> ignored_;  // line, and identifier that it names
  Scene scene_;
};

}  // namespace

Scene read_scene_csv(const std::filesystem::path& folder, const std::filesystem::path& table, double margin) {
  return Table(folder, table, margin).read();
}

}  // namespace sixdof::scene
