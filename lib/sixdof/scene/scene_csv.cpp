#include <sixdof/scene/scene_csv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>

namespace sixdof::scene {
namespace {

constexpr std::array<std::string_view, 11> k_columns{"frame", "body", "mesh", "qw", "qx",   "qy",
                                                     "qz",    "tx",   "ty",   "tz", "fixed"};
enum Column : std::size_t {
  frame,
  body,
  mesh,
  first_number,
  fixed = 10
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view k_blank = " \t\r";
  const std::size_t first = text.find_first_not_of(k_blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(k_blank) - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    cells.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return cells;
}

class Table {
 public:
  Table(const std::filesystem::path& folder, const std::filesystem::path& file, double margin)
      : folder_(folder), file_(file) {
    scene_.name = file.stem().string();
    scene_.margin = margin;
  }

  Scene read() {
    std::ifstream in(file_);
    if (!in) throw BadFile(file_.string(), "cannot be read");
    if (!std::filesystem::is_directory(folder_)) throw BadFile(folder_.string(), "no such folder");
    for (std::string text; std::getline(in, text);) {
      ++line_;
      const std::string_view row = trimmed(text);
      if (row.empty() || row.front() == '#') continue;
      places_.empty() ? read_header(split(row)) : read_row(split(row));
    }
    if (scene_.frames.empty()) throw BadFile(file_.string(), "has no rows");
    scene_.check();
    return std::move(scene_);
  }

 private:
  [[noreturn]] void refuse(const std::string& cause) const {
    throw BadFile(file_.string(), fmt::format("line {}", line_), cause);
  }

  void read_header(const std::vector<std::string_view>& names) {
    columns_ = names.size();
    places_.resize(k_columns.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = std::ranges::find(k_columns, names[i]);
      if (found == k_columns.end()) {
        refuse(fmt::format("no column '{}'; there are {}", names[i], fmt::join(k_columns, ", ")));
      }
      auto& place = places_[static_cast<std::size_t>(found - k_columns.begin())];
      if (place) refuse(fmt::format("column {} comes twice", names[i]));
      place = i;
    }
    for (std::size_t c = 0; c < fixed; ++c) {
      if (!places_[c]) refuse(fmt::format("the column {} is missing", k_columns[c]));
    }
  }

  template <class T>
  T number(std::string_view text, std::string_view what) const {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      refuse(fmt::format("{} '{}' is not {}", what, text, std::is_integral_v<T> ? "a count" : "a number"));
    }
    return value;
  }

  void read_row(const std::vector<std::string_view>& cells) {
    if (cells.size() != columns_) refuse(fmt::format("{} cells, not {}", cells.size(), columns_));
    const auto cell = [&](std::size_t column) { return cells[*places_[column]]; };
    const auto at = number<std::uint32_t>(cell(frame), "frame");
    const auto id = number<std::uint32_t>(cell(body), "body");
    RecordedPose pose;
    for (std::size_t k = 0; k < pose.numbers.size(); ++k) {
      pose.numbers[k] = number<double>(cell(first_number + k), k_columns[first_number + k]);
      if (!std::isfinite(pose.numbers[k])) refuse(fmt::format("{} is not finite", k_columns[first_number + k]));
    }
    try {
      pose.pose();
    } catch (const BadArgument& e) {
      refuse(e.what());
    }
    begin_frame(at);
    at == 0 ? add_body(id, pose, cell(mesh), places_[fixed] ? cell(fixed) : "0") : add_motion(id, pose, cell(mesh));
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

  void add_body(std::uint32_t id, const RecordedPose& pose, std::string_view name, std::string_view is_fixed) {
    if (name.empty()) refuse(fmt::format("body {} has no mesh", id));
    if (is_fixed != "0" && is_fixed != "1") refuse(fmt::format("fixed '{}' is not 0 or 1", is_fixed));
    if (!index_.emplace(id, scene_.bodies.size()).second) refuse(fmt::format("body {} comes twice in frame 0", id));
    scene_.bodies.push_back({id, mesh_of(name), is_fixed == "1", pose});
  }

  void add_motion(std::uint32_t id, const RecordedPose& pose, std::string_view name) {
    const auto found = index_.find(id);
    if (found == index_.end()) refuse(fmt::format("body {} is not in frame 0", id));
    const Body& moved = scene_.bodies[found->second];
    if (moved.fixed) refuse(fmt::format("body {} is fixed and moves", id));
    if (!name.empty() && mesh_of(name) != moved.mesh) refuse(fmt::format("body {} has another mesh in frame 0", id));
    if (const auto last = last_.find(id); last != last_.end() && last->second + 1 == scene_.frames.size()) {
      refuse(fmt::format("body {} comes twice in frame {}", id, last->second));
    }
    last_[id] = scene_.frames.size() - 1;
    scene_.frames.back().push_back({static_cast<std::uint32_t>(found->second), pose});
  }

  std::uint32_t mesh_of(std::string_view name) {
    const auto [found, is_new] = meshes_.emplace(name, static_cast<std::uint32_t>(scene_.meshes.size()));
    if (is_new) {
      if (!std::filesystem::exists(folder_ / name)) refuse(fmt::format("no file {}", (folder_ / name).string()));
      scene_.meshes.push_back(std::make_shared<const Mesh>(load_mesh(folder_ / name)));
    }
    return found->second;
  }

  std::filesystem::path folder_, file_;
  std::size_t line_ = 0;
  std::size_t columns_ = 0;
  std::vector<std::optional<std::size_t>> places_;  // of each of k_columns in a row; empty before the header
  std::map<std::uint32_t, std::size_t> index_;      // of a body by its identifier
  std::map<std::uint32_t, std::size_t> last_;       // frame in which a body moved last
  std::map<std::string, std::uint32_t, std::less<>> meshes_;
  Scene scene_;
};

}  // namespace

Scene read_scene_csv(const std::filesystem::path& folder, const std::filesystem::path& table, double margin) {
  return Table(folder, table, margin).read();
}

}  // namespace sixdof::scene
