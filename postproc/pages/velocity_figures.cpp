#include "postproc/pages/velocity_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::postproc {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t k_arrow_stride = 2;  ///< every second point has an arrow: more cannot be told apart

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

/// A line through points of the picture.
struct Path {
    std::vector<double> x, y;
    void add(const Vec2& at) {
        x.push_back(at.x());
        y.push_back(at.y());
    }
};

Series thin_line(const Path& path, const char* colour, double width) {
    Series series{"", colour, path.x, path.y};
    series.line_width = width;
    return series;
}

/// Arrows as one broken line: shaft, then the two strokes of the head.
Path arrows(const Plane& plane, double largest) {
    Path path;
    const double length = 0.95 * static_cast<double>(k_arrow_stride) * spacing(plane);
    for (std::size_t i = 0; i < plane.points.size(); ++i) {
        const PlanePoint& point = plane.points[i];
        const bool has_arrow = (i / plane.columns) % k_arrow_stride == 0 && (i % plane.columns) % k_arrow_stride == 0;
        if (!has_arrow || !point.velocity.allFinite() || !(largest > 0.0)) continue;
        const Vec2 shaft = point.velocity * (length / std::max(largest, point.velocity.norm()));
        if (shaft.norm() < 0.08 * length) continue;
        const Vec2 tip = point.at + 0.5 * shaft, side(-shaft.y(), shaft.x());
        path.add(point.at - 0.5 * shaft);
        path.add(tip);
        path.add(tip - 0.35 * shaft + 0.18 * side);
        path.add(tip);
        path.add(tip - 0.35 * shaft - 0.18 * side);
        path.add({k_gap, k_gap});
    }
    return path;
}

/// \param outline  of the head in the picture
/// \param top      height up to which speeds count for the scale of colours
Plot plane_plot(const std::string& name, const Plane& plane, const Path& outline, double top, const std::string& x_title,
                const std::string& y_title) {
    Field field{{}, {}, {}, typical_largest(plane, top), "m/s", {".3f", " m/s"}};
    Vec2 low = plane.points.front().at, high = low;
    for (const PlanePoint& point : plane.points) {
        field.x.push_back(point.at.x());
        field.y.push_back(point.at.y());
        field.value.push_back(point.velocity.norm());
        low = low.cwiseMin(point.at);
        high = high.cwiseMax(point.at);
    }
    const double aspect = (high.y() - low.y()) / (high.x() - low.x());
    Plot plot;
    plot.name = name;
    plot.height = static_cast<int>(std::lround(110.0 + 390.0 * std::min(1.1, aspect)));
    plot.equal_scales = true;
    plot.tips = Tips::at_point;
    plot.legend = Legend::none;
    plot.x.title = x_title;
    plot.y.title = y_title;
    plot.x.tip = plot.y.tip = {".3f", " m"};
    plot.x.grid = plot.y.grid = false;
    plot.x.from = low.x();
    plot.x.to = high.x();
    plot.y.from = low.y();
    plot.y.to = high.y();
    plot.series = {thin_line(arrows(plane, field.darkest), palette::ink, 0.9), thin_line(outline, palette::spilled, 1.6)};
    plot.field = field;
    return plot;
}

/// Both sides of the contour, from the ring down to the hub and up again.
Path contour_outline(const geometry::Contour& contour) {
    Path path;
    path.add({contour.ring_radius(), contour.z_backplate()});
    for (std::size_t i = contour.z().size(); i-- > 0;) path.add({contour.radius()[i], contour.z()[i]});
    for (std::size_t i = 0; i < contour.z().size(); ++i) path.add({-contour.radius()[i], contour.z()[i]});
    path.add({-contour.ring_radius(), contour.z_backplate()});
    return path;
}

Path circle(double radius) {
    Path path;
    for (int i = 0; i <= 120; ++i) path.add({radius * std::cos(2.0 * k_pi * i / 120.0), radius * std::sin(2.0 * k_pi * i / 120.0)});
    return path;
}

/// "mean over 3 revolutions from t = 1 s": what the pictures are averages of.
std::string averaging_text(const Table& plane) {
    const double revolutions = plane.number("revolutions").front(), from = plane.number("from_s").front(),
                 to = plane.number("to_s").front();
    if (revolutions < 1.0) return fmt::format("mean over the samples from t = {:.3g} to {:.3g} s (no whole revolution yet)", from, to);
    return fmt::format("mean over {:g} whole revolution{} from t = {:.3g} s", revolutions, revolutions == 1.0 ? "" : "s", from);
}

}  // namespace

std::optional<Figure> axial_plane(const RunData& run) {
    if (run.plane_axial.empty()) return std::nullopt;
    const double azimuth = run.operating_point.mouth_azimuth_deg * k_pi / 180.0;
    const Vec3 outwards(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Plane plane = read_plane(run.plane_axial, outwards, Vec3::UnitZ(), Vec3::UnitZ());
    if (!has_velocity(plane)) return std::nullopt;
    return Figure{plane_plot("plane_axial", plane, contour_outline(run.contour), 0.0, "from the axis towards the mouth, m",
                             "z along the axis (ring at 0), m"),
                  "Velocity of the water on the plane through the axis and the suction mouth’s centre. Colour: speed in the plane (the "
                  "darkest stands for that speed and more); arrows: its direction; white: steel; orange: contour of revolution; " +
                      averaging_text(run.plane_axial) + ".",
                  ""};
}

std::optional<Figure> plane_under_ring(const RunData& run) {
    if (run.plane_under_ring.empty()) return std::nullopt;
    const Plane plane = read_plane(run.plane_under_ring, -Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitY());
    if (!has_velocity(plane)) return std::nullopt;
    const double z = run.plane_under_ring.number("z_m").front();
    return Figure{plane_plot("plane_under_ring", plane, circle(run.contour.radius_at(z)), std::numeric_limits<double>::infinity(),
                             "across (azimuth 270° to the right), m", "up from the lowest side, m"),
                  fmt::format("The same on a plane {:.3g} m below the ring, seen from the hub, the lowest side down.", -z), ""};
}

}  // namespace cutterflow::postproc
