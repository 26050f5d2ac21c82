#include "cases/scenes/cutter/contact_surfaces.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/case_builder.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/surface/contact_surface.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double k_deviation_per_diameter = 0.01;
constexpr double k_edge_per_ring_radius = 0.1;
constexpr double k_degrees = 180.0 / k_pi;

json to_json(const WallSurfaceReport& report) {
    return {{"triangles_given", report.triangles_given},
            {"triangles", report.triangles},
            {"smallest_angle_given_deg", report.smallest_angle_given * k_degrees},
            {"smallest_angle_deg", report.smallest_angle * k_degrees},
            {"deviation_m", report.deviation},
            {"allowed_deviation_m", report.allowed_deviation},
            {"kept_because", report.kept_because.empty() ? json() : json(report.kept_because)}};
}

}  // namespace

std::string WallSurfaceReport::text() const {
    if (!kept_because.empty())
        return fmt::format("rock touches the {} original triangles of the {}: {}", triangles_given, wall, kept_because);
    return fmt::format("rock touches {} triangles of the {} (of {}), {:.2g} mm off at most ({:.2g} allowed), smallest angle {:.0f} degrees",
                       triangles, wall, triangles_given, 1e3 * deviation, 1e3 * allowed_deviation, smallest_angle * k_degrees);
}

std::vector<WallSurfaceReport> write_contact_surfaces(const fs::path& run_directory, double smallest_diameter, double ring_radius,
                                                      const std::vector<MadeWall>& made) {
    const geometry::ContactSurfaceBounds bounds{k_deviation_per_diameter * smallest_diameter, k_edge_per_ring_radius * ring_radius};
    std::vector<WallSurfaceReport> reports;
    json walls = json::object();
    for (const WallSource& source : wall_sources()) {
        const geometry::TriangleSurface given = geometry::welded(geometry::read_surface(run_directory / source.surface));
        const geometry::ContactSurface contact = geometry::contact_surface(given, bounds);
        fs::create_directories((run_directory / source.wall.file).parent_path());
        geometry::write_stl(contact.surface, run_directory / source.wall.file);
        reports.push_back({source.wall.name, given.triangles.size(), contact.surface.triangles.size(), geometry::smallest_angle_of(given),
                           contact.smallest_angle, contact.deviation, bounds.deviation, contact.kept_because});
    }
    for (const MadeWall& wall : made) {
        geometry::write_stl(wall.surface, run_directory / wall.file);
        reports.push_back(wall.report);
    }
    for (const WallSurfaceReport& report : reports) walls[report.wall] = to_json(report);
    write_file(run_directory / k_contact_surface_report, walls.dump(2) + "\n");
    return reports;
}

}  // namespace cutterflow::cases
