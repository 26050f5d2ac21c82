#include "postproc/draw/head/head_series.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/head/head_names.hpp"
#include "postproc/draw/image.hpp"
#include "postproc/draw/indexed_surface.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_folder = "report/head";

std::optional<double> as_time(const std::string& name) {
    char* end = nullptr;
    const double value = std::strtod(name.c_str(), &end);
    if (name.empty() || *end != '\0' || !std::isfinite(value) || value < 0.0) return std::nullopt;
    return value;
}

/// Times by their names: OpenFOAM's time directories, of a whole case or of its first part, and the pictures of the rock.
std::map<double, std::string> written_times(const fs::path& run_directory) {
    std::map<double, std::string> times;
    for (const fs::path& folder : {run_directory, run_directory / "processor0", run_directory / "postProcessing/rock/vtk"}) {
        if (!fs::is_directory(folder)) continue;
        for (const auto& entry : fs::directory_iterator(folder)) {
            std::string name = entry.path().filename().string();
            if (name.rfind("rocks_", 0) == 0) name = entry.path().stem().string().substr(6);
            if (const auto time = as_time(name)) times.emplace(*time, name);
        }
    }
    return times;
}

/// Inline binary data of VTK's XML: the number of bytes, then the numbers.
template <typename Number>
std::string data_array(const std::string& attributes, const std::vector<Number>& numbers) {
    const auto size = static_cast<std::uint32_t>(numbers.size() * sizeof(Number));
    std::string bytes(sizeof size + size, '\0');
    std::memcpy(bytes.data(), &size, sizeof size);
    std::memcpy(bytes.data() + sizeof size, numbers.data(), size);
    return fmt::format("<DataArray {} format=\"binary\">{}</DataArray>\n", attributes, base64(bytes));
}

/// A file of VTK's poly data. \param counts  attributes of its one piece \param content  of the piece
std::string poly_data(const std::string& counts, const std::string& content) {
    return fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
        "<PolyData>\n<Piece {} NumberOfLines=\"0\" NumberOfStrips=\"0\">\n{}</Piece>\n</PolyData>\n</VTKFile>\n",
        counts, content);
}

std::string points_text(const std::vector<float>& points) {
    return "<Points>\n" + data_array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"", points) + "</Points>\n";
}

std::string cells_text(const char* kind, const std::vector<std::int32_t>& corners, const std::vector<std::int32_t>& ends) {
    return fmt::format("<{0}>\n{1}{2}</{0}>\n", kind, data_array("type=\"Int32\" Name=\"connectivity\"", corners),
                       data_array("type=\"Int32\" Name=\"offsets\"", ends));
}

std::string surface_text(const IndexedSurface& surface, double angle) {
    std::vector<float> points;
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        const Vec3 at = rotate_about({}, angle, surface.point(i));
        for (int axis = 0; axis < 3; ++axis) points.push_back(static_cast<float>(at[axis]));
    }
    std::vector<std::int32_t> corners, ends;
    for (const auto& triangle : surface.triangles) {
        for (const std::uint32_t corner : triangle) corners.push_back(static_cast<std::int32_t>(corner));
        ends.push_back(static_cast<std::int32_t>(corners.size()));
    }
    return poly_data(
        fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfPolys=\"{}\"", surface.points.size(), surface.triangles.size()),
        points_text(points) + cells_text("Polys", corners, ends));
}

/// Where rock came in, a point each. \param events  of the run
std::string feed_text(const Table& events) {
    std::vector<float> points, times, diameters;
    std::vector<std::int32_t> ids, corners, ends;
    for (std::size_t row = 0; row < events.rows(); ++row) {
        if (events.text("surface")[row] != "feed") continue;
        corners.push_back(static_cast<std::int32_t>(corners.size()));
        ends.push_back(static_cast<std::int32_t>(corners.size()));
        for (const char* column : {"x_m", "y_m", "z_m"}) points.push_back(static_cast<float>(events.number(column)[row]));
        ids.push_back(static_cast<std::int32_t>(events.number("id")[row]));
        times.push_back(static_cast<float>(events.number("time_s")[row]));
        diameters.push_back(static_cast<float>(events.number("diameter_m")[row]));
    }
    return poly_data(fmt::format("NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfPolys=\"0\"", corners.size()),
                     "<PointData>\n" + data_array("type=\"Int32\" Name=\"id\"", ids) + data_array("type=\"Float32\" Name=\"time\"", times) +
                         data_array("type=\"Float32\" Name=\"diameter\"", diameters) + "</PointData>\n" + points_text(points) +
                         cells_text("Verts", corners, ends));
}

/// Soil and feed, which do not turn.
void write_surroundings(const fs::path& run_directory, const fs::path& folder) {
    if (fs::exists(run_directory / names::bank_surface))
        write_file(folder / "bank.vtp", surface_text(index_surface(read_binary_stl(run_directory / names::bank_surface)), 0.0));
    const Table events = read_events(run_directory);
    if (!events.empty()) write_file(folder / "feed.vtp", feed_text(events));
}

/// [rad/s], signed.
double rotor_speed(const fs::path& run_directory) {
    const Table loads =
        read_joined_table(run_directory, "loads", "loads.csv", {{"time_s", "rotor_angle_rad"}, {}, {}, "Run the study again"});
    return loads.empty() ? 0.0 : loads.number("rotor_angle_rad").back() / loads.number("time_s").back();
}

}  // namespace

void write_head_series(const fs::path& run_directory) {
    const std::map<double, std::string> times = written_times(run_directory);
    if (times.empty()) return;
    const IndexedSurface head = index_surface(read_binary_stl(run_directory / names::cutter_surface));
    const double speed = rotor_speed(run_directory);
    const fs::path folder = run_directory / k_folder;
    fs::remove_all(folder);
    write_surroundings(run_directory, folder);
    std::string series;
    for (const auto& [time, name] : times) {
        const std::string file = fmt::format("head_{}.vtp", name);
        write_file(folder / file, surface_text(head, speed * time));
        series += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", name, file);
    }
    write_file(folder / "head.pvd", "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" + series +
                                        "</Collection>\n</VTKFile>\n");
}

}  // namespace cutterflow::postproc
