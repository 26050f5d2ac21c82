#include "postproc/pages/free_surface/surface_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr const char *k_air = palette::field[0], *k_slow = palette::field[1], *k_fast = palette::field[4];
constexpr const char *k_solid = palette::faint, *k_body = palette::in_cutter;
constexpr int k_snapshots = 6;
constexpr double k_same_time = 1e-6;  // [s]: digits of a file's name
constexpr int k_picture_width = 560;  // [px]
constexpr int k_scales_height = 46;   // below a picture [px]

/// Numbers of a data array of a VTK file that was written as text.
std::vector<double> array_of(const std::string& text, const std::string& name) {
    const std::size_t head = text.find("Name=\"" + name + "\"");
    if (head == std::string::npos) return {};
    const char* at = text.c_str() + text.find('>', head) + 1;
    const char* end = text.c_str() + text.find("</DataArray>", head);
    std::vector<double> values;
    while (at < end) {
        char* next = nullptr;
        const double value = std::strtod(at, &next);
        if (next == at || next > end) break;
        values.push_back(value);
        at = next;
    }
    return values;
}

struct Snapshot {
    double time = 0.0;
    fs::path file;
};

/// As many as asked for, evenly over the times that were written.
std::vector<Snapshot> snapshots(const fs::path& run_directory) {
    std::vector<Snapshot> all;
    const fs::path folder = run_directory / "postProcessing/water/vtk";
    if (!fs::is_directory(folder)) return all;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() == ".vti") all.push_back({std::strtod(name.c_str() + name.find('_') + 1, nullptr), entry.path()});
    }
    std::sort(all.begin(), all.end(), [](const Snapshot& a, const Snapshot& b) { return a.time < b.time; });
    std::vector<Snapshot> chosen;
    const std::size_t count = std::min<std::size_t>(all.size(), k_snapshots);
    for (std::size_t n = 0; n < count; ++n) chosen.push_back(all[count > 1 ? n * (all.size() - 1) / (count - 1) : 0]);
    return chosen;
}

Colour mixed(const Colour& a, const Colour& b, double share) {
    return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green), a.blue + share * (b.blue - a.blue)};
}

struct Disc {
    double x = 0.0, z = 0.0, radius = 0.0;
    double turned = 0.0;  // about the axis across, clockwise [rad]
};

/// Across the tank the layer of cells that pictures show: the middle one; scenes of earlier programs are plane.
int section_layer(const nlohmann::json& scene) {
    return scene.value("layers", 1) / 2;
}

/// Radius [m] of a body in that section: a cylinder reaches across, a sphere does not.
double radius_in_section(const nlohmann::json& scene, double radius, double y) {
    if (!scene.value("spheres", false)) return radius;
    const double off = y - (section_layer(scene) + 0.5) * scene.at("cell_m").get<double>();
    return std::sqrt(std::max(0.0, radius * radius - off * off));
}

/// By how much each body has turned until a time [rad], in the order of their ids: its spin over the outputs, by the trapezoidal rule.
std::vector<double> turned_until(const Table& bodies, double time) {
    const std::vector<double>* spins = counted(bodies, "spin_y_rad_s");
    if (!spins) return {};
    struct Turn {
        double time = 0.0, spin = 0.0, angle = 0.0;
    };
    std::map<double, Turn> turns;
    for (std::size_t n = 0; n < bodies.rows(); ++n) {
        const double now = bodies.number("time_s")[n], spin = (*spins)[n];
        if (now > time + k_same_time) continue;
        const auto [turn, first] = turns.try_emplace(bodies.number("id")[n], Turn{now, spin, 0.0});
        if (!first) turn->second = {now, spin, turn->second.angle + 0.5 * (now - turn->second.time) * (spin + turn->second.spin)};
    }
    std::vector<double> angles;
    for (const auto& [id, turn] : turns) angles.push_back(turn.angle);
    return angles;
}

/// Bodies at the time of a snapshot, from the file that was written with it.
std::vector<Disc> bodies_of(const SurfaceRows& rows, const fs::path& run_directory, const Snapshot& snapshot) {
    const std::string time = snapshot.file.stem().string().substr(std::string("water_").size());
    const fs::path file = run_directory / "postProcessing/bodies/vtk" / ("bodies_" + time + ".vtp");
    if (!fs::exists(file)) return {};
    const std::string text = read_file(file);
    const std::vector<double> places = array_of(text, "Points"), radii = array_of(text, "radius_m");
    const std::vector<double> angles = turned_until(rows.bodies, snapshot.time);
    std::vector<Disc> discs;
    for (std::size_t n = 0; n < radii.size() && 3 * n + 2 < places.size(); ++n)
        discs.push_back({places[3 * n], places[3 * n + 2], radius_in_section(rows.scene, radii[n], places[3 * n + 1]),
                         n < angles.size() ? angles[n] : 0.0});
    return discs;
}

/// Water by its share of a cell, darker where it is faster; solids and bodies over it.
Image picture(const SurfaceRows& rows, const Snapshot& snapshot, const std::vector<Disc>& discs, double fastest) {
    const auto number = [&](const char* key) { return rows.scene.at(key).get<double>(); };
    const int columns = rows.scene.at("columns").get<int>(), lines = rows.scene.at("rows").get<int>();
    const int layers = rows.scene.value("layers", 1), layer = section_layer(rows.scene);
    const std::string text = read_file(snapshot.file);
    const std::vector<double> fraction = array_of(text, "water_fraction"), open = array_of(text, "open_volume"),
                              velocity = array_of(text, "velocity_m_s");
    Image image;
    image.width = k_picture_width;
    image.height = std::max(1, static_cast<int>(std::lround(k_picture_width * number("height_m") / number("width_m"))));
    const double pixel = number("width_m") / image.width, cell_size = number("cell_m");
    const Colour air = colour_of(k_air), wall = colour_of(k_solid), body = colour_of(k_body), edge = colour_of(palette::ink);
    const Colour slow = colour_of(k_slow), fast = colour_of(k_fast);
    for (int row = 0; row < image.height; ++row) {
        for (int n = 0; n < image.width; ++n) {
            const double x = (n + 0.5) * pixel, z = (image.height - row - 0.5) * pixel;
            const int i = std::min(columns - 1, static_cast<int>(x / cell_size)), k = std::min(lines - 1, static_cast<int>(z / cell_size));
            const std::size_t cell = (static_cast<std::size_t>(k) * layers + layer) * columns + i;
            Colour colour = air;
            if (cell < fraction.size() && 3 * cell + 2 < velocity.size()) {
                const double speed = std::hypot(velocity[3 * cell], velocity[3 * cell + 2]);
                colour = mixed(air, mixed(slow, fast, std::min(1.0, speed / fastest)), std::clamp(2.0 * fraction[cell] - 0.5, 0.0, 1.0));
                if (cell < open.size() && open[cell] < 0.5) colour = wall;
            }
            for (const Disc& disc : discs) {
                const double distance = std::hypot(x - disc.x, z - disc.z);
                if (distance < disc.radius) colour = distance > disc.radius - 1.2 * pixel ? edge : body;
            }
            for (const double part : {colour.red, colour.green, colour.blue})
                image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * part)));
        }
    }
    return image;
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a value.
double round_below(double value) {
    const double ten = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * ten <= value * (1.0 + 1e-9)) return factor * ten;
    }
    return ten;
}

/// A line with ends, and what it stands for below.
std::string bar(double left, double right, double y, const std::string& text) {
    return fmt::format(
        "<path d=\"M{0:.1f},{1} V{2} M{0:.1f},{3} H{4:.1f} M{4:.1f},{1} V{2}\" fill=\"none\" stroke=\"{5}\" stroke-width=\"1.5\"/>"
        "<text x=\"{6:.1f}\" y=\"{7}\" text-anchor=\"middle\" font-size=\"14\" fill=\"{5}\">{8}</text>",
        left, y - 5.0, y + 5.0, y, right, palette::ink, 0.5 * (left + right), y + 22.0, text);
}

/// Speeds by colour, from 0 on.
std::string speed_scale(double left, double right, double y, double fastest, const std::string& id) {
    std::string markup = fmt::format(
        "<defs><linearGradient id=\"{0}\"><stop offset=\"0\" stop-color=\"{1}\"/><stop offset=\"1\" "
        "stop-color=\"{2}\"/></linearGradient></defs>"
        "<rect x=\"{3:.1f}\" y=\"{4}\" width=\"{5:.1f}\" height=\"10\" fill=\"url(#{0})\" stroke=\"{6}\" stroke-width=\"0.5\"/>",
        id, k_slow, k_fast, left, y - 5.0, right - left, palette::ink);
    for (const double share : {0.0, 0.5, 1.0}) {
        const std::string unit = share == 1.0 ? " m/s and more" : "";
        markup += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" font-size=\"14\" fill=\"{}\">{:g}{}</text>",
                              left + share * (right - left), y + 22.0, palette::ink, share * fastest, unit);
    }
    return markup;
}

/// A line from the middle of each body to the place of its rim that was the highest at the start.
std::string spin_marks(const std::vector<Disc>& discs, const Image& image, double width) {
    if (discs.empty()) return "";
    const double scale = image.width / width;
    std::string ways;
    for (const Disc& disc : discs)
        ways += fmt::format("M{:.1f},{:.1f} l{:.1f},{:.1f}", scale * disc.x, image.height - scale * disc.z,
                            scale * disc.radius * std::sin(disc.turned), -scale * disc.radius * std::cos(disc.turned));
    return fmt::format("<path class=\"spin\" d=\"{}\" stroke=\"{}\" stroke-width=\"1.2\"/>", ways, palette::ink);
}

/// A picture with marks on it, and a bar of length and the speeds of its colours below.
std::string with_scales(const Image& image, const std::string& address, const std::string& label, double width, double fastest,
                        const std::string& id, const std::string& marks) {
    const double length = round_below(width / 4.0), y = image.height + 14.0;
    return fmt::format(
        "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\"><image width=\"{0}\" height=\"{3}\" href=\"{4}\"/>{5}{6}{7}</svg>",
        image.width, image.height + k_scales_height, label, image.height, address, marks,
        bar(20.0, 20.0 + length / width * image.width, y, fmt::format("{:g} mm", 1e3 * length)),
        speed_scale(0.5 * image.width, 0.86 * image.width, y, fastest, id));
}

}  // namespace

std::string surface_pictures(const Page& page, const SurfaceRows& rows, const fs::path& run_directory) {
    const double width = rows.scene.at("width_m").get<double>();
    const double fastest = round_below(2.0 * std::sqrt(9.81 * rows.scene.at("height_m").get<double>()));
    std::string markup;
    int number = 0;
    for (const Snapshot& snapshot : snapshots(run_directory)) {
        const std::string id = fmt::format("water_{}", number++), time = fmt::format("{:.3f} s", snapshot.time);
        const std::vector<Disc> discs = bodies_of(rows, run_directory, snapshot);
        const Image image = picture(rows, snapshot, discs, fastest);
        const std::string marks = spin_marks(discs, image, width);
        markup += html::figure(with_scales(image, page.address(image, id), "Water and bodies at " + time, width, fastest, id, marks), time);
    }
    if (markup.empty()) return markup;
    const std::string section =
        rows.scene.value("layers", 1) > 1
            ? fmt::format("<p>Section at y = {:g} m.</p>", (section_layer(rows.scene) + 0.5) * rows.scene.at("cell_m").get<double>())
            : "";
    return section +
           html::legend({{k_fast, "water, darker where it is faster"}, {k_body, "bodies; the line turns with them"}, {k_solid, "solids"}}) +
           "<div class=\"figures\">" + markup + "</div>";
}

}  // namespace cutterflow::postproc
