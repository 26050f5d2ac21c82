#include "geometry/clump/clump_file.hpp"

#include <sstream>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_row.hpp"

namespace cutterflow::geometry {
namespace {

ParameterRow length(const char* key, const char* help) {
    return ParameterRow(key, ParameterKind::number, "m", help).repeated();
}

}  // namespace

const ParameterTable& clump_file_table() {
    static const ParameterTable table{
        ParameterRow("sphericity", ParameterKind::number, "-",
                     "Surface of the sphere of equal volume over that of the rock, for drag laws that use it.")
            .above(0.0)
            .at_most(1.0)
            .derived("closures.sphericity"),
        length("sphere.x_m", "Centre of the sphere, x."),
        length("sphere.y_m", "Centre of the sphere, y."),
        length("sphere.z_m", "Centre of the sphere, z."),
        length("sphere.radius_m", "Radius of the sphere.").above(0.0),
    };
    return table;
}

Clump read_clump(const std::filesystem::path& file) {
    const ParameterValues values = read_parameters(clump_file_table(), file);
    Clump clump;
    for (const ParameterValues& sphere : values.tables("sphere"))
        clump.balls.push_back({Vec3(sphere.number("sphere.x_m"), sphere.number("sphere.y_m"), sphere.number("sphere.z_m")),
                               sphere.number("sphere.radius_m")});
    if (values.has("sphericity")) clump.sphericity = values.number("sphericity");
    Mistakes mistakes(file.string());
    mistakes.add(clump_mistakes(clump));
    mistakes.refuse();
    return clump;
}

void write_clump(const Clump& clump, const std::string& remark, const std::filesystem::path& file) {
    std::string text;
    std::istringstream lines(remark);
    for (std::string line; std::getline(lines, line);) text += "# " + line + '\n';
    if (clump.sphericity) text += fmt::format("\nsphericity = {:.17g}\n", *clump.sphericity);
    for (const Ball& ball : clump.balls)
        text += fmt::format("\n[[sphere]]\nx_m = {:.17g}\ny_m = {:.17g}\nz_m = {:.17g}\nradius_m = {:.17g}\n", ball.centre.x(),
                            ball.centre.y(), ball.centre.z(), ball.radius);
    write_file(file, text);
}

}  // namespace cutterflow::geometry
