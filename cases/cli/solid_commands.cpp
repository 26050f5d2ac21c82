/// \file generate-solid: simple solids, and the steel that does not turn.
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/cli/numbers.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/surface/simple_solids.hpp"

namespace cutterflow::cli {
namespace {

using Generate = std::function<geometry::TriangleSurface()>;

void write_solid(const Generate& generate, double exact_volume, const std::string& output) {
    Mistakes mistakes;
    geometry::TriangleSurface surface;
    mistakes.gather([&] { require_new_file(output); });
    mistakes.gather([&] { surface = generate(); });
    mistakes.refuse();
    geometry::write_stl(surface, output);
    std::cout << fmt::format("wrote {}: {} triangles, {:.5g} m3, {:.2g} % less than the exact solid, in metres\n", output,
                             surface.triangles.size(), geometry::volume_of(surface),
                             100.0 * std::max(0.0, 1.0 - geometry::volume_of(surface) / exact_volume));
}

/// Options that every solid has.
struct Solid {
    double edge_length = 0.0;
    std::string output;
};

/// A size that has to be given; the solid's generator knows whether it may be 0.
void add_length(CLI::App& command, const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->required()->check(k_length);
}

void add_common_options(CLI::App& command, Solid& solid) {
    command.add_option("--edge-m", solid.edge_length, "Longest edge of the surface's triangles")
        ->required()
        ->check(k_positive)
        ->check(k_length);
    command.add_option("-o,--output", solid.output, "STL file to write")->required()->check(k_stl_name);
}

void add_pipe(CLI::App& app) {
    auto* command = app.add_subcommand("pipe", "A pipe about the z axis from z = 0 up; a rod when its inner radius is 0.");
    const auto pipe = std::make_shared<geometry::PipeParameters>();
    const auto solid = std::make_shared<Solid>();
    add_length(*command, "--inner-radius-m", pipe->inner_radius, "Inner radius");
    add_length(*command, "--wall-m", pipe->wall, "Thickness of the wall");
    add_length(*command, "--length-m", pipe->length, "Length");
    add_common_options(*command, *solid);
    command->callback([pipe, solid] {
        pipe->edge_length = solid->edge_length;
        write_solid([&] { return geometry::generate_pipe(*pipe); }, pipe->volume(), solid->output);
    });
}

void add_box(CLI::App& app) {
    auto* command = app.add_subcommand("box", "A box centred on the z axis, from z = 0 up.");
    const auto size = std::make_shared<Vec3>(Vec3::Zero());
    const auto solid = std::make_shared<Solid>();
    add_length(*command, "--x-m", size->x(), "Length along x");
    add_length(*command, "--y-m", size->y(), "Length along y");
    add_length(*command, "--z-m", size->z(), "Length along z");
    add_common_options(*command, *solid);
    command->callback(
        [size, solid] { write_solid([&] { return geometry::generate_box(*size, solid->edge_length); }, size->prod(), solid->output); });
}

void add_funnel(CLI::App& app) {
    auto* command = app.add_subcommand("funnel", "A funnel about the z axis: its spout ends at z = 0, the cone is above it.");
    const auto funnel = std::make_shared<geometry::FunnelParameters>();
    const auto solid = std::make_shared<Solid>();
    add_length(*command, "--inlet-radius-m", funnel->inlet_radius, "Inner radius of the cone's upper end");
    add_length(*command, "--outlet-radius-m", funnel->outlet_radius, "Inner radius of the cone's lower end and of the spout");
    add_length(*command, "--height-m", funnel->cone_height, "Height of the cone");
    command->add_option("--spout-m", funnel->spout_length, "Length of the spout")->check(k_length)->capture_default_str();
    add_length(*command, "--wall-m", funnel->wall, "Thickness of the wall along the radius");
    add_common_options(*command, *solid);
    command->callback([funnel, solid] {
        funnel->edge_length = solid->edge_length;
        write_solid([&] { return geometry::generate_funnel(*funnel); }, funnel->volume(), solid->output);
    });
}

double exact_volume(const geometry::StationarySteelParameters& p) {
    const auto disc = [](double radius) { return k_pi * radius * radius; };
    const double bore = disc(p.mouth.radius);
    return (disc(p.plate_radius) - bore) * p.plate_thickness +
           (disc(p.mouth.radius + p.pipe_wall) - bore) * (p.pipe_top - p.gap - p.plate_thickness);
}

void add_backplate(CLI::App& app) {
    auto* command =
        app.add_subcommand("backplate", "A backplate with suction mouth and pipe, one solid in the frame of a run: ring plane z = 0.");
    const auto steel = std::make_shared<geometry::StationarySteelParameters>();
    const auto azimuth_deg = std::make_shared<double>(0.0);
    const auto pipe_length = std::make_shared<double>(0.0);
    const auto solid = std::make_shared<Solid>();
    const auto length = [command](const char* name, double& value, const char* help) {
        command->add_option(name, value, help)->required()->check(k_positive)->check(k_length);
    };
    length("--radius-m", steel->plate_radius, "Radius of the plate");
    length("--thickness-m", steel->plate_thickness, "Thickness of the plate");
    length("--gap-m", steel->gap, "Distance of the plate from the ring plane");
    length("--mouth-radius-m", steel->mouth.radius, "Inner radius of mouth and pipe");
    command->add_option("--mouth-offset-m", steel->mouth.offset, "Distance of the mouth's centre from the axis")
        ->required()
        ->check(k_not_negative)
        ->check(k_length);
    command->add_option("--mouth-azimuth-deg", *azimuth_deg, "Azimuth of the mouth's centre")->check(k_angle_deg)->capture_default_str();
    length("--pipe-wall-m", steel->pipe_wall, "Thickness of the pipe's wall");
    length("--pipe-length-m", *pipe_length, "Length of the pipe above the plate");
    add_common_options(*command, *solid);
    command->callback([steel, azimuth_deg, pipe_length, solid] {
        steel->mouth.azimuth = *azimuth_deg * k_pi / 180.0;
        steel->pipe_top = steel->gap + steel->plate_thickness + *pipe_length;
        steel->edge_length = solid->edge_length;
        write_solid([&] { return geometry::generate_stationary_steel(*steel).solid(); }, exact_volume(*steel), solid->output);
    });
}

}  // namespace

void add_generate_solid(CLI::App& app) {
    auto* command = app.add_subcommand("generate-solid", "Write the STL of a pipe, a box, a funnel, or a backplate with its suction pipe.");
    command->require_subcommand(1);
    add_pipe(*command);
    add_box(*command);
    add_funnel(*command);
    add_backplate(*command);
}

}  // namespace cutterflow::cli
