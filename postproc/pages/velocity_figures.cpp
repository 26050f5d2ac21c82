#include "postproc/pages/velocity_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/draw/palette.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;
using Vec2 = Eigen::Vector2d;

constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t k_arrow_stride = 2;  ///< every second point has an arrow: more cannot be told apart
constexpr int k_width = 540;
/// Light to dark, the same in print.
constexpr const char* k_colours[] = {"#f4f8fb", "#cfe3f1", "#93c4e4", "#4f9fd1", "#0072b2"};  // no darker: arrows lie over it

/// A point of the picture: where it is drawn and the velocity in the plane. NaN in steel.
struct PlanePoint {
    Vec2 at, velocity;
};

/// Points row by row on a grid; `columns` in a row.
struct Plane {
    std::vector<PlanePoint> points;
    std::size_t columns = 0;
};

/// Velocity in the run's frame from its cylindrical components; at r = 0 radial is x and tangential y.
Vec3 velocity_of(const Table& table, std::size_t row) {
    const double x = table.number("x_m")[row], y = table.number("y_m")[row], r = std::hypot(x, y);
    const double radial = table.number("u_radial_m_s")[row], tangential = table.number("u_tangential_m_s")[row];
    const double c = r > 0.0 ? x / r : 1.0, s = r > 0.0 ? y / r : 0.0;
    return {radial * c - tangential * s, radial * s + tangential * c, table.number("u_axial_m_s")[row]};
}

/// \param right, up  axes of the picture in the run's frame
/// \param row_axis   coordinate that is constant within a row of the table
Plane read_plane(const Table& table, const Vec3& right, const Vec3& up, const Vec3& row_axis) {
    Plane plane;
    double first_row = 0.0;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const Vec3 at(table.number("x_m")[i], table.number("y_m")[i], table.number("z_m")[i]), velocity = velocity_of(table, i);
        plane.points.push_back({{at.dot(right), at.dot(up)}, {velocity.dot(right), velocity.dot(up)}});
        if (i == 0) first_row = at.dot(row_axis);
        if (std::abs(at.dot(row_axis) - first_row) < 1e-9) plane.columns = i + 1;
    }
    if (plane.columns < 2 || plane.points.size() % plane.columns != 0 || plane.points.size() == plane.columns)
        throw UserError(fmt::format("a velocity plane has {} points, {} in its first row", plane.points.size(), plane.columns),
                        "Points of a plane stand row by row on a grid", "Run the study again");
    return plane;
}

/// Whether anything has been averaged yet.
bool has_velocity(const Plane& plane) {
    return std::any_of(plane.points.begin(), plane.points.end(), [](const PlanePoint& point) { return point.velocity.allFinite(); });
}

/// Speed that 95 % of the points at a height up to `top` stay below: the darkest colour and the longest arrow stand for it. Higher up is
/// the suction pipe, in which water is ten times as fast as in the head.
double typical_largest(const Plane& plane, double top) {
    std::vector<double> speeds;
    for (const PlanePoint& point : plane.points) {
        if (point.velocity.allFinite() && point.at.y() <= top) speeds.push_back(point.velocity.norm());
    }
    if (speeds.empty()) return 0.0;
    std::sort(speeds.begin(), speeds.end());
    return speeds[static_cast<std::size_t>(0.95 * static_cast<double>(speeds.size() - 1))];
}

/// Distance between neighbours, the smaller of the two.
double spacing(const Plane& plane) {
    return std::min((plane.points[1].at - plane.points[0].at).norm(), (plane.points[plane.columns].at - plane.points[0].at).norm());
}

/// Arrows as one broken line: shaft, then the two strokes of the head.
PlotRows arrows(const Plane& plane, double largest) {
    PlotRows rows;
    const auto add = [&](const Vec2& at) { rows.push_back({at.x(), at.y()}); };
    const double length = 0.95 * static_cast<double>(k_arrow_stride) * spacing(plane);
    for (std::size_t i = 0; i < plane.points.size(); ++i) {
        const PlanePoint& point = plane.points[i];
        const bool has_arrow = (i / plane.columns) % k_arrow_stride == 0 && (i % plane.columns) % k_arrow_stride == 0;
        if (!has_arrow || !point.velocity.allFinite() || !(largest > 0.0)) continue;
        const Vec2 shaft = point.velocity * (length / std::max(largest, point.velocity.norm()));
        if (shaft.norm() < 0.08 * length) continue;
        const Vec2 tip = point.at + 0.5 * shaft, side(-shaft.y(), shaft.x());
        add(point.at - 0.5 * shaft);
        add(tip);
        add(tip - 0.35 * shaft + 0.18 * side);
        add(tip);
        add(tip - 0.35 * shaft - 0.18 * side);
        rows.push_back({k_gap, k_gap});
    }
    return rows;
}

json colour_scale() {
    json scale = json::array();
    for (std::size_t i = 0; i < std::size(k_colours); ++i) {
        scale.push_back({static_cast<double>(i) / static_cast<double>(std::size(k_colours) - 1), k_colours[i]});
    }
    return scale;
}

std::string gnuplot_palette() {
    std::vector<std::string> steps;
    for (std::size_t i = 0; i < std::size(k_colours); ++i) steps.push_back(fmt::format("{} \"{}\"", i, k_colours[i]));
    return fmt::format("set palette defined ({})\n", fmt::join(steps, ", "));
}

json thin_line(const PlotRows& rows, const char* colour, double width) {
    json trace = curve(rows, 0, 1, "", colour);
    trace["line"]["width"] = width;
    trace["hoverinfo"] = "skip";
    return trace;
}

/// \param outline  of the head in the picture
/// \param top      height up to which speeds count for the scale of colours
Plot plane_plot(const std::string& name, const Plane& plane, const PlotRows& outline, double top, const std::string& x_title,
                const std::string& y_title) {
    const double largest = typical_largest(plane, top);
    PlotRows speeds;
    Vec2 low = plane.points.front().at, high = low;
    for (const PlanePoint& point : plane.points) {
        speeds.push_back({point.at.x(), point.at.y(), point.velocity.norm()});
        low = low.cwiseMin(point.at);
        high = high.cwiseMax(point.at);
    }
    const PlotRows strokes = arrows(plane, largest);
    const double aspect = (high.y() - low.y()) / (high.x() - low.x());
    Plot plot{{name, k_width, static_cast<int>(std::lround(110.0 + 390.0 * std::min(1.1, aspect))), ""},
              json::array(),
              {{"xaxis", axis(x_title)}, {"yaxis", axis(y_title)}, {"hovermode", "closest"}, {"showlegend", false}}};
    plot.layout["xaxis"].update({{"range", {low.x(), high.x()}}, {"constrain", "domain"}, {"showgrid", false}});
    plot.layout["yaxis"].update({{"range", {low.y(), high.y()}}, {"scaleanchor", "x"}, {"constrain", "domain"}, {"showgrid", false}});
    plot.traces.push_back({{"type", "heatmap"},
                           {"x", column(speeds, 0)},
                           {"y", column(speeds, 1)},
                           {"z", column(speeds, 2)},
                           {"zmin", 0},
                           {"zmax", largest},
                           {"colorscale", colour_scale()},
                           {"hoverongaps", false},
                           {"colorbar", {{"title", {{"text", "m/s"}}}, {"thickness", 12}, {"outlinewidth", 0}}},
                           {"hovertemplate", "%{x:.3f} m, %{y:.3f} m: %{z:.3f} m/s<extra></extra>"}});
    plot.traces.push_back(thin_line(strokes, palette::ink, 1.0));
    plot.traces.push_back(thin_line(outline, palette::spilled, 1.6));

    std::string& commands = plot.script.commands;
    commands += data_block("speeds", speeds) + data_block("outline", outline);
    // gnuplot breaks a line at an empty row.
    PlotRows broken = strokes;
    for (auto& row : broken) row = std::isnan(row[0]) ? std::vector<double>{} : row;
    commands += data_block("strokes", broken) + gnuplot_palette();
    commands += fmt::format(
        "set xlabel {}\nset ylabel {}\nset cblabel \"m/s\"\nset xrange [{}:{}]\nset yrange [{}:{}]\nset cbrange [0:{}]\nset size ratio -1\n"
        "unset grid\nunset key\nplot $speeds using 1:2:3 with image, $strokes using 1:2 with lines lw 0.9 lc rgb \"{}\", "
        "$outline using 1:2 with lines lw 1.6 lc rgb \"{}\"\n",
        quoted(x_title), quoted(y_title), plot_number(low.x()), plot_number(high.x()), plot_number(low.y()), plot_number(high.y()),
        plot_number(std::max(largest, 1e-9)), palette::ink, palette::spilled);
    return plot;
}

/// Both sides of the contour, from the ring down to the hub and up again.
PlotRows contour_outline(const geometry::Contour& contour) {
    PlotRows rows{{contour.ring_radius(), contour.z_backplate()}};
    for (std::size_t i = contour.z().size(); i-- > 0;) rows.push_back({contour.radius()[i], contour.z()[i]});
    for (std::size_t i = 0; i < contour.z().size(); ++i) rows.push_back({-contour.radius()[i], contour.z()[i]});
    rows.push_back({-contour.ring_radius(), contour.z_backplate()});
    return rows;
}

PlotRows circle(double radius) {
    PlotRows rows;
    for (int i = 0; i <= 120; ++i) rows.push_back({radius * std::cos(2.0 * k_pi * i / 120.0), radius * std::sin(2.0 * k_pi * i / 120.0)});
    return rows;
}

}  // namespace

std::optional<Plot> axial_plane_plot(const RunData& run) {
    if (run.plane_axial.empty()) return std::nullopt;
    const double azimuth = run.operating_point.mouth_azimuth_deg * k_pi / 180.0;
    const Vec3 outwards(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Plane plane = read_plane(run.plane_axial, outwards, Vec3::UnitZ(), Vec3::UnitZ());
    if (!has_velocity(plane)) return std::nullopt;
    return plane_plot("plane_axial", plane, contour_outline(run.contour), 0.0, "from the axis towards the mouth, m",
                      "z along the axis (ring at 0), m");
}

std::optional<Plot> under_ring_plot(const RunData& run) {
    if (run.plane_under_ring.empty()) return std::nullopt;
    const Plane plane = read_plane(run.plane_under_ring, -Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitY());
    if (!has_velocity(plane)) return std::nullopt;
    const double z = run.plane_under_ring.number("z_m").front();
    return plane_plot("plane_under_ring", plane, circle(run.contour.radius_at(z)), std::numeric_limits<double>::infinity(),
                      "across (azimuth 270° to the right), m", "up from the lowest side, m");
}

std::string averaging_text(const Table& plane) {
    const double revolutions = plane.number("revolutions").front(), from = plane.number("from_s").front(),
                 to = plane.number("to_s").front();
    if (revolutions < 1.0) return fmt::format("mean over the samples from t = {:.3g} to {:.3g} s (no whole revolution yet)", from, to);
    return fmt::format("mean over {:g} whole revolution{} from t = {:.3g} s", revolutions, revolutions == 1.0 ? "" : "s", from);
}

}  // namespace cutterflow::postproc
