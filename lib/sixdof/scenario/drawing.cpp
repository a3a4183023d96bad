#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <sixdof/scenario/scenario.h>

namespace sixdof {
namespace {

using Vector2d = Eigen::Vector2d;
using Vector3d = Eigen::Vector3d;

// Sizes in pixels.
constexpr double k_panel_width = 460.0;
constexpr double k_panel_height = 330.0;
constexpr double k_margin = 14.0;
constexpr double k_title = 26.0;
constexpr double k_legend = 22.0;
constexpr double k_force_arrow = 62.0;
/// Edges between faces at a larger angle than this are drawn: larger than at a facet of a round part, smaller than at a
/// corner.
const double k_crease_cosine = std::cos(20.0 * std::numbers::pi / 180.0);

constexpr unsigned k_rgb_a = 0xb9bcc2;
constexpr unsigned k_rgb_b = 0x8db4dc;
constexpr const char* k_color_wrench = "#123a8c";
constexpr const char* k_color_dimension = "#333333";

/// Orthographic projection of A's frame onto a panel.
struct View {
  Vector3d right, up, toward;  ///< Orthonormal; `toward` points to the eye.
  Vector2d origin;             ///< Pixels of (0, 0) in the view's plane.
  double scale = 1.0;          ///< Pixels per unit.

  Vector2d plane(const Vector3d& p) const { return {right.dot(p), up.dot(p)}; }
  Vector2d operator()(const Vector3d& p) const { return pixel(plane(p)); }
  Vector2d pixel(const Vector2d& q) const { return {origin.x() + scale * q.x(), origin.y() - scale * q.y()}; }

  /// Shows `box` of the view's plane in the middle of the panel whose left edge is at `left`.
  void fit(const Eigen::AlignedBox2d& box, double left) {
    const double width = k_panel_width - 2.0 * k_margin;
    const double height = k_panel_height - 2.0 * k_margin;
    scale = std::min(width / box.sizes().x(), height / box.sizes().y());
    const Vector2d middle = box.center();
    origin = {left + 0.5 * k_panel_width - scale * middle.x(), k_title + 0.5 * k_panel_height + scale * middle.y()};
  }
};

/// An SVG path along `points`. @param style attributes of the element
std::string svg_path(std::span<const Vector2d> points, const std::string& style, bool closed = false) {
  std::string d;
  for (const Vector2d& p : points) d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", p.x(), p.y());
  return fmt::format("<path d=\"{}{}\" {}/>\n", d, closed ? "Z" : "", style);
}

std::string svg_line(const Vector2d& from, const Vector2d& to, const std::string& style) {
  return svg_path(std::array{from, to}, style);
}

std::string svg_text(const Vector2d& at, const std::string& words, const char* style) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x(), at.y(), style, words);
}

/// `rgb` in the notation of SVG, darker the more a face points away from the light.
std::string shaded(unsigned rgb, double light) {
  const auto channel = [&](unsigned shift) {
    return static_cast<unsigned>(std::lround(std::min(255.0, ((rgb >> shift) & 0xffu) * (0.78 + 0.32 * light))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(16), channel(8), channel(0));
}

/// The faces that face `eye`, from back to front, each with its creases and outline edges. `eye` is view.toward, or its
/// opposite to show the far side.
std::string draw_mesh(const Mesh& mesh, const Pose& pose, const View& view, const Vector3d& eye, unsigned rgb) {
  const auto& triangles = mesh.triangles();
  std::vector<Vector3d> vertices;
  for (const Vector3d& v : mesh.vertices()) vertices.push_back(pose * v);
  std::vector<Vector3d> normals;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> owner;  // directed edge -> triangle
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& n = triangles[t];
    normals.push_back((vertices[n[1]] - vertices[n[0]]).cross(vertices[n[2]] - vertices[n[0]]).normalized());
    for (std::size_t e = 0; e < 3; ++e) owner[{n[e], n[(e + 1) % 3]}] = t;
  }
  std::vector<std::pair<double, std::size_t>> order;
  constexpr double k_edge_on = 1e-9;  // cosine up to which a face is seen edge-on
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (normals[t].dot(eye) <= k_edge_on) continue;
    const Triangle& n = triangles[t];
    order.emplace_back((vertices[n[0]] + vertices[n[1]] + vertices[n[2]]).dot(eye), t);
  }
  std::sort(order.begin(), order.end());
  const Vector3d light = (eye + 0.6 * view.up - 0.4 * view.right).normalized();
  std::string svg;
  for (const auto& [depth, t] : order) {
    const Triangle& n = triangles[t];
    const std::array<Vector2d, 3> p{view(vertices[n[0]]), view(vertices[n[1]]), view(vertices[n[2]])};
    const std::string fill = shaded(rgb, normals[t].dot(light));
    svg += svg_path(p, fmt::format("fill=\"{0}\" stroke=\"{0}\" stroke-width=\".4\"", fill), true);
    for (std::size_t e = 0; e < 3; ++e) {
      const auto other = owner.find({n[(e + 1) % 3], n[e]});
      const bool outline = other == owner.end() || normals[other->second].dot(eye) <= k_edge_on;
      if (outline || normals[other->second].dot(normals[t]) < k_crease_cosine) {
        svg += svg_line(p[e], p[(e + 1) % 3], "stroke=\"#222\" stroke-width=\".9\" stroke-linecap=\"round\"");
      }
    }
  }
  return svg;
}

std::string draw_path(const Scenario& scenario, const View& view) {
  constexpr int k_pieces = 96;
  std::vector<Vector2d> points;
  double length = 0.0;
  for (int k = 0; k <= k_pieces; ++k) {
    const double progress = static_cast<double>(k) / k_pieces;
    points.push_back(view(scenario.pose(progress) * scenario.description().reference_b));
    if (k > 0) length += (points.back() - points[points.size() - 2]).norm();
  }
  constexpr double k_visible = 2.0;  // pixels; a rotation about the reference point has no path
  if (length < k_visible) return {};
  return svg_path(points, "fill=\"none\" stroke=\"#c8102e\" stroke-width=\"1.6\" stroke-dasharray=\"6 4\"");
}

/// The ideal force of the volume law as an arrow, its torque (along z in all scenarios) as an arc in the x, y plane.
std::string draw_wrench(const Scenario& scenario, double progress, const View& view) {
  const auto ideal = scenario.ideal(IdealLaw::volume, progress);
  const Vector3d at = scenario.pose(progress) * scenario.description().reference_b;
  const std::string style =
      fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2.6\" marker-end=\"url(#wrench)\"", k_color_wrench);
  std::string svg;
  if (ideal->force.norm() > 0.0) {
    const Vector2d p = view(at);
    Vector2d tip = view(at + ideal->force.normalized());
    tip = p + (tip - p) / view.scale * k_force_arrow;
    svg += svg_line(p, tip, style);
  }
  if (ideal->torque.norm() > 0.0) {
    constexpr int k_pieces = 24;
    const double radius = 0.55 * scenario.description().reference_length + 12.0 / view.scale;
    const double arc = (ideal->torque.z() > 0.0 ? 1.0 : -1.0) * 1.25 * std::numbers::pi;
    std::vector<Vector2d> points;
    for (int k = 0; k <= k_pieces; ++k) {
      const double angle = -0.4 * std::numbers::pi + arc * k / k_pieces;
      points.push_back(view(at + radius * Vector3d(std::cos(angle), std::sin(angle), 0.0)));
    }
    svg += svg_path(points, style);
  }
  return svg;
}

std::string draw_dimension(const Dimension& dimension, const View& view) {
  const Vector2d from = view.pixel(dimension.from + dimension.offset);
  const Vector2d to = view.pixel(dimension.to + dimension.offset);
  const std::string thin = fmt::format("stroke=\"{}\" stroke-width=\".6\"", k_color_dimension);
  const std::string arrows = fmt::format(
      "stroke=\"{}\" stroke-width=\".9\" marker-start=\"url(#dim)\" marker-end=\"url(#dim)\"", k_color_dimension);
  std::string svg = svg_line(view.pixel(dimension.from), from, thin) + svg_line(view.pixel(dimension.to), to, thin);
  svg += svg_line(from, to, arrows);
  // The label is beside a vertical line, above a horizontal one.
  const bool vertical = std::abs(to.y() - from.y()) > std::abs(to.x() - from.x());
  constexpr double k_tiny = 14.0;  // pixels: shorter than a label, which is then above the arrows
  const bool tiny = (to - from).norm() < k_tiny;
  const Vector2d shift = vertical ? Vector2d(6.0, tiny ? -8.0 : 4.0) : Vector2d(0.0, -5.0);
  const Vector2d at = vertical ? Vector2d(0.35 * from + 0.65 * to) : Vector2d(0.5 * (from + to));
  const std::string label = fmt::format("{} = {:g}", dimension.symbol, dimension.length);
  return svg + svg_text(at + shift, label,
                        vertical ? "font-size=\"12\" class=\"halo\""
                                 : "font-size=\"12\" text-anchor=\"middle\" class=\"halo\"");
}

std::string draw_panel(const Scenario& scenario, const Sketch& sketch, const View& view, bool underside,
                       const std::string& clip) {
  const Pose pose = scenario.pose(sketch.progress);
  std::string svg = fmt::format("<g clip-path=\"url(#{})\">\n", clip);
  const Vector3d eye_b = underside ? Vector3d(-view.toward) : view.toward;
  svg += draw_mesh(scenario.a(), Pose{}, view, view.toward, k_rgb_a);
  svg += "<g opacity=\".62\">\n" + draw_mesh(scenario.b(), pose, view, eye_b, k_rgb_b) + "</g>\n";
  svg += draw_path(scenario, view);
  svg += draw_wrench(scenario, sketch.progress, view);
  return svg + "</g>\n";
}

View oblique(const Scenario& scenario, const Sketch& sketch, double left) {
  // From the front right, a little above.
  const Vector3d side = sketch.up.z() > 0.5 ? Vector3d(0.55, -0.83, 0.0) : Vector3d(0.55, 0.0, 0.83);
  View view;
  view.toward = (side + 0.75 * sketch.up).normalized();
  view.right = sketch.up.cross(view.toward).normalized();
  view.up = view.toward.cross(view.right);
  Eigen::AlignedBox2d box;
  for (const Vector3d& v : scenario.a().vertices()) box.extend(view.plane(v));
  const Pose pose = scenario.pose(sketch.progress);
  for (const Vector3d& v : scenario.b().vertices()) box.extend(view.plane(pose * v));
  view.fit(box, left);
  return view;
}

}  // namespace

std::string draw(const Scenario& scenario) {
  const Sketch sketch = scenario.sketch();
  View plan{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), Vector2d::Zero()};
  plan.fit(sketch.region, 0.0);
  const double width = 2.0 * k_panel_width;
  const double height = k_title + k_panel_height + k_legend;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "font-family=\"sans-serif\">\n"
      "<style>.halo{{paint-order:stroke;stroke:#fff;stroke-width:3.5px;fill:#111}}</style>\n"
      "<defs><marker id=\"wrench\" viewBox=\"0 0 10 10\" refX=\"6\" refY=\"5\" markerWidth=\"4.5\" "
      "markerHeight=\"4.5\" "
      "orient=\"auto\"><path d=\"M0 0L10 5L0 10Z\" fill=\"{2}\"/></marker>\n"
      "<marker id=\"dim\" viewBox=\"0 0 10 10\" refX=\"10\" refY=\"5\" markerWidth=\"7\" markerHeight=\"7\" "
      "orient=\"auto-start-reverse\"><path d=\"M0 2L10 5L0 8Z\" fill=\"{3}\"/></marker>\n",
      width, height, k_color_wrench, k_color_dimension);
  for (const auto& [id, left] : {std::pair("plan", 0.0), std::pair("view", k_panel_width)}) {
    svg += fmt::format("<clipPath id=\"{}\"><rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\"/></clipPath>\n",
                       id, left, k_title, k_panel_width, k_panel_height);
  }
  svg += fmt::format("</defs>\n<rect width=\"{:g}\" height=\"{:g}\" fill=\"#fff\"/>\n", width, height);
  svg += svg_text({10.0, 18.0}, "Scenario " + scenario.name(), "font-size=\"15\" font-weight=\"bold\"");
  svg += draw_panel(scenario, sketch, plan, sketch.underside, "plan");
  for (const Dimension& dimension : sketch.dimensions) svg += draw_dimension(dimension, plan);
  svg += draw_panel(scenario, sketch, oblique(scenario, sketch, k_panel_width), false, "view");
  const std::string legend = fmt::format(
      "Grey: A, fixed. Blue: B, moving{}. Dashed: path of the reference point. Arrows: ideal force and torque on B.",
      sketch.underside ? " (plan: its underside, as through glass)" : "");
  svg += svg_text({10.0, height - 7.0}, legend, "font-size=\"11\" fill=\"#333\"");
  return svg + "</svg>\n";
}

}  // namespace sixdof
