#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

/// Reads OFF as Geomview describes it (oogl.html, "OFF files"), with what other programs make of it.
class Reader {
 public:
  explicit Reader(const Source& source)
      : source_(source),
        lines_(source, {.comment = '#'}),
        values_(lines_, [this] { return fmt::format("vertex {}", surface_.vertices.size()); }) {}

  FileMesh read() {
    read_keyword();
    read_counts();
    read_vertices();
    constexpr std::size_t k_bytes_of_triangle = sizeof("3 0 1 2\n") - 1;
    surface_.triangles.reserve(std::min(face_count_, (lines_.remaining() + 1) / k_bytes_of_triangle));
    for (std::size_t i = 0; i < face_count_; ++i) read_face(i);
    lines_.expect_end();
    ForgivenKinds& forgiven = surface_.repairs.forgiven;
    forgiven.set(Forgiven::lone_returns, lines_.lone_returns());
    forgiven.set(Forgiven::loose_elements, values_.loose_elements());
    return std::move(surface_);
  }

 private:
  /// [ST][C][N][4][n]OFF, the letters in any order, as writers have them.
  void read_keyword() {
    if (!lines_.next()) lines_.fail("no data");
    words_ = lines_.words();
    const std::string_view keyword = words_[0];
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (std::all_of(keyword.begin(), keyword.end(), is_digit)) {  // Geomview lets it be left out
      return surface_.repairs.forgiven.add(Forgiven::off_keyword, [&] { return lines_.place(); });
    }
    std::string_view rest = keyword;
    const auto take = [&](std::string_view prefix) {
      if (!rest.starts_with(prefix)) return false;
      rest.remove_prefix(prefix.size());
      return true;
    };
    while (!rest.starts_with("OFF")) {
      if (take("ST") || take("C") || take("N")) {
        announced_ = true;
      } else if (take("4")) {
        homogeneous_ = true;
      } else if (take("n")) {
        any_dimension_ = true;
      } else {
        break;
      }
    }
    if (!take("OFF")) {
      lines_.fail(fmt::format("begins with '{}', not OFF, COFF, NOFF, CNOFF, STOFF or 4OFF", visible_text(keyword)));
    }
    if (any_dimension_ && homogeneous_) lines_.fail("4nOFF is not supported");
    words_.erase(words_.begin());
    if (rest.empty()) {
      if (!words_.empty() && words_[0] == "BINARY") lines_.fail("binary OFF is not supported");
      return;
    }
    if (!std::all_of(rest.begin(), rest.end(), is_digit)) {
      lines_.fail(fmt::format("begins with '{}', not OFF", visible_text(keyword)));
    }
    words_.insert(words_.begin(), rest);  // "OFF490 518 0", as in a well-known collection of shapes
    surface_.repairs.forgiven.add(Forgiven::off_keyword, [&] { return lines_.place(); });
  }

  /// Counts of vertices, faces and edges, of which the last is often 0 or missing, and not used: on one line or on
  /// three.
  void read_counts() {
    const auto next_line = [&] {
      if (!lines_.next()) lines_.fail("the counts are missing");
      words_.insert(words_.end(), lines_.words().begin(), lines_.words().end());
    };
    if (words_.empty()) next_line();
    if (any_dimension_) {
      if (lines_.integer(words_[0]) != 3) lines_.fail(visible_text(words_[0]) + " dimensions are not supported");
      words_.erase(words_.begin());
      if (words_.empty()) next_line();
    }
    if (words_.size() == 1) {
      for (int i = 0; i < 2; ++i) {
        next_line();
        if (lines_.size() != 1) lines_.fail("the counts of vertices, faces and edges are expected");
      }
    }
    if (words_.size() != 3 && words_.size() != 2) lines_.fail("the counts of vertices, faces and edges are expected");
    constexpr std::size_t k_least_vertex = sizeof("0 0 0\n") - 1;
    constexpr std::size_t k_least_face = sizeof("0\n") - 1;
    vertex_count_ = count(words_[0], "vertices", k_least_vertex);
    face_count_ = count(words_[1], "faces", k_least_face);
    if (words_.size() == 3) lines_.integer(words_[2]);
  }

  std::size_t count(std::string_view word, const char* what, std::size_t least_bytes) const {
    const std::int64_t count = lines_.integer(word);
    // The last line may lack its line break.
    if (count < 0 || static_cast<std::uint64_t>(count) > (lines_.remaining() + 1) / least_bytes) {
      lines_.fail(fmt::format("{} {} do not fit into the {} bytes that follow", count, what, lines_.remaining()));
    }
    return static_cast<std::size_t>(count);
  }

  void read_vertices() {
    surface_.vertices.reserve(vertex_count_);
    const std::size_t of_point = homogeneous_ ? 4 : 3;
    const std::size_t on_first_line = values_.on_line();
    const bool all_on_one_line = on_first_line == of_point * vertex_count_;
    if (announced_ || (!homogeneous_ && !all_on_one_line && on_first_line >= k_least_undeclared)) {
      read_vertex_lines(of_point, on_first_line);
    } else if (on_first_line <= of_point || all_on_one_line) {
      read_vertex_values(of_point);
    } else {
      lines_.fail(
          fmt::format("vertex 0 has {} values, not {}; with a colour the keyword would be COFF, with a weight "
                      "4OFF",
                      on_first_line, of_point));
    }
  }

  /// The point comes first. Colours, normals and texture coordinates behind it have no fixed number of values: they
  /// last to the end of the line.
  void read_vertex_lines(std::size_t of_point, std::size_t on_first_line) {
    for (std::size_t i = 0; i < vertex_count_; ++i) {
      if (i > 0 && !lines_.next()) fail_at_end(i);
      if (announced_ ? lines_.size() < of_point : lines_.size() != on_first_line) {
        lines_.fail(
            fmt::format("vertex {} has {} values, not {}", i, lines_.size(), announced_ ? of_point : on_first_line));
      }
      const Eigen::Vector3d p = lines_.point(0);
      surface_.add_vertex(homogeneous_ ? Eigen::Vector3d(p / lines_.number(3)) : p, lines_.line());
      if (!announced_) surface_.repairs.forgiven.add(Forgiven::undeclared_values, [&] { return lines_.place(); });
    }
  }

  void read_vertex_values(std::size_t of_point) {
    values_.begin_kind(false);
    for (std::size_t i = 0; i < vertex_count_; ++i) {
      if (!values_.begin_element()) fail_at_end(i);
      Eigen::Vector4d p(0, 0, 0, 1);
      for (std::size_t k = 0; k < of_point; ++k) p[static_cast<Eigen::Index>(k)] = lines_.number(values_.word());
      values_.end_element();
      surface_.add_vertex(p.head<3>() / p[3], lines_.line());
    }
    if (values_.left_on_line() > 0) lines_.fail("values behind the last vertex");
  }

  [[noreturn]] void fail_at_end(std::size_t vertex) const {
    lines_.fail(fmt::format("the file ends after {} of {} vertices", vertex, vertex_count_));
  }

  void read_face(std::size_t i) {
    if (!lines_.next()) lines_.fail(fmt::format("the file ends after {} of {} faces", i, face_count_));
    const std::int64_t count = lines_.integer(std::size_t{0});
    if (count < 0) lines_.fail(fmt::format("face {} has {} corners", i, count));
    const auto last = static_cast<std::size_t>(count);
    const std::size_t values = lines_.size() - 1;
    if (last > values) lines_.fail(fmt::format("face {} has {} corners, but {} indices", i, count, values));
    corners_.clear();
    for (std::size_t k = 1; k <= last; ++k) {
      const std::int64_t v = lines_.integer(k);
      if (v < 0 || static_cast<std::uint64_t>(v) >= vertex_count_) {
        lines_.fail(fmt::format("vertex index {} of {}", v, vertex_count_));
      }
      corners_.push_back(static_cast<std::uint32_t>(v));
    }
    // A colour may follow: an index into a colour map, or 3 or 4 components.
    if (values > last + 4) lines_.fail(fmt::format("face {} has {} corners, but {} values", i, count, values));
    for (std::size_t k = last + 1; k <= values; ++k) lines_.number(k);
    add_polygon(
        source_, corners_, [&] { return lines_.place(); }, surface_);
  }

  /// Vertices of fewer values have a weight, an index of a colour, or something that cannot be known.
  static constexpr std::size_t k_least_undeclared = 6;

  const Source& source_;
  TextLines lines_;
  FileMesh surface_;
  TextValues values_;                    ///< Of the vertices.
  std::vector<std::string_view> words_;  ///< Of the keyword's line and the counts.
  bool announced_ = false;               ///< Colours, normals or texture coordinates.
  bool homogeneous_ = false;             ///< A weight behind each point, by which it is divided.
  bool any_dimension_ = false;           ///< The counts begin with that of the dimensions.
  std::size_t vertex_count_ = 0, face_count_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

FileMesh read_off(const Source& source) { return Reader(source).read(); }

}  // namespace sixdof::loading
