#include "meshing/cutter/mesh_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::meshing {
namespace {

// Cells between steel and interface. snappyHexMesh refines the cells on both sides of each pair of cell centres separated by steel; with
// the steel 1.75 cells from the interface the centres are 0.25 and 1.25 cells outside it, so that one whole layer at the interface
// stays unrefined, also with small errors of the surface.
constexpr double k_clearance_cells = 1.75;
constexpr int k_annulus_cells = 3;  // the layer at the interface and those that the head's outer surface can touch
// Beyond this width over height of a cell in the gap, the step from a halved to a whole cell is skewer than 65 degrees.
constexpr double k_gap_aspect_max = 4.5;
constexpr int k_gap_cells_min = 2;
constexpr double k_mouth_cells_min = 4.0;  // across the mouth
constexpr double k_tank_cells_min = 2.0;
constexpr double k_passage_cells_min = 2.0;  // of the cutter's, across the passage between two blades
constexpr double k_cutter_cell = 0.5;        // of the background's, by one level of refinement
// Corner of the core over the annulus' inner radius: cells of the core about as wide as those of the annulus are high.
constexpr double k_core_ratio = 0.82;
// Bulge with which the core's corners have 120 degrees: three blocks meet there.
constexpr double k_core_bulge = 0.80;

// Calibrated on the presets' meshes of the model cutter, docs/design/003-meshing.md.
constexpr double k_refined_per_area = 1.9;  // background cells that a surface of unit area refines, times the cell's mean face area
constexpr double k_mouth_rate = 1.26;       // Courant number per step over (mouth velocity x step / height of the gap's cells)
constexpr double k_tip_rate = 1.95;         // over (tip speed x step / width of the cutter's cells)
constexpr double k_core_s_per_cell_step = 5.9e-6;
constexpr double k_mesh_memory = 0.13e9, k_mesh_memory_per_cell = 1.36e3;  // snappyHexMesh [bytes]
constexpr double k_run_memory = 0.32e9, k_run_memory_per_cell = 2.04e3;    // cutterFoam on one rank [bytes]

/// All presets, from coarse to fine: the source of the study's choices and of the advice to use a finer one.
const std::vector<MeshResolution>& presets() {
    static const std::vector<MeshResolution> all{
        {"draft", 0.075, 1.15, 1.6}, {"standard", 0.0375, 1.15, 1.35}, {"paper", 0.0225, 1.1, 1.3}};
    return all;
}

int count(double number) {
    return static_cast<int>(std::lround(number));
}

int cells_of(const std::vector<CellRow>& rows) {
    return std::accumulate(rows.begin(), rows.end(), 0, [](int sum, const CellRow& row) { return sum + row.cells; });
}

/// First cell of a row of n cells that grow by q each.
double first_of(double length, int n, double q) {
    return std::abs(q - 1.0) < 1e-9 ? length / n : length * (q - 1.0) / (std::pow(q, n) - 1.0);
}

double row_growth(const CellRow& row) {
    return row.cells > 1 ? std::pow(row.expansion, 1.0 / (row.cells - 1)) : 1.0;
}

CellRow even_row(double from, double to, int cells) {
    return {from, to, cells, 1.0};
}

/// The row in reverse direction.
CellRow reversed(const CellRow& row) {
    return {row.from, row.to, row.cells, 1.0 / row.expansion};
}

double mouth_velocity(const MeshInput& input) {
    return input.discharge / (k_pi * std::pow(input.steel.mouth.radius, 2));
}

void require_sizes(const MeshInput& in) {
    const std::array<double, 16> positive = {in.ring_radius,
                                             in.cutter.radius,
                                             in.cutter.area,
                                             in.cutter.volume,
                                             -in.cutter.z_min,
                                             in.steel.plate_radius,
                                             in.steel.plate_thickness,
                                             in.steel.mouth.radius,
                                             in.steel.pipe_wall,
                                             in.tank.radius,
                                             in.resolution.cell_size,
                                             in.resolution.axial_stretch,
                                             in.resolution.stator_growth - 1.0,
                                             std::abs(in.rotation_speed),
                                             in.discharge,
                                             in.max_courant};
    if (std::any_of(positive.begin(), positive.end(), [](double x) { return !(x > 0.0) || !std::isfinite(x); }))
        throw std::invalid_argument("a size of the mesh input that must be positive is not");
}

/// Smallest gap [m] that holds the interface with cells no flatter than k_gap_aspect_max.
double needed_gap(double ring_radius, const MeshResolution& resolution) {
    return 2.0 * k_gap_cells_min * resolution.cell_size * ring_radius / k_gap_aspect_max;
}

double needed_mouth_radius(double ring_radius, const MeshResolution& resolution) {
    return 0.5 * k_mouth_cells_min * resolution.cell_size * ring_radius;
}

double needed_passage(double ring_radius, const MeshResolution& resolution) {
    return k_passage_cells_min * k_cutter_cell * resolution.cell_size * ring_radius;
}

/// One cell of the cutter's.
double needed_thickness(double ring_radius, const MeshResolution& resolution) {
    return k_cutter_cell * resolution.cell_size * ring_radius;
}

/// "Use preset standard or ", or nothing when no preset is fine enough.
template <class Enough>
std::string finer_preset(const Enough& enough) {
    for (const MeshResolution& preset : presets())
        if (enough(preset)) return fmt::format("Use mesh.preset = \"{}\", or ", preset.preset);
    return {};
}

std::string sentence(const std::string& optional_start, const std::string& rest) {
    return optional_start.empty() ? static_cast<char>(std::toupper(rest.front())) + rest.substr(1) : optional_start + rest;
}

/// With four digits, not below the value: who gives what a refusal asks for is not refused again.
std::string not_below(double value) {
    const double last_digit = std::pow(10.0, std::floor(std::log10(value)) - 3.0);
    const std::string text = fmt::format("{:.4g}", value);
    return std::stod(text) < value ? fmt::format("{:.4g}", std::stod(text) + last_digit) : text;
}

void check_gap(const MeshInput& in, std::vector<Mistake>& mistakes) {
    const double top = std::max(0.0, in.cutter.z_max);
    const double gap = in.steel.gap - top;
    const double needed = needed_gap(in.ring_radius, in.resolution);
    if (gap >= needed) return;
    const std::string finer = finer_preset(
        [&](const MeshResolution& r) { return r.cell_size < in.resolution.cell_size && gap >= needed_gap(in.ring_radius, r); });
    mistakes.push_back({"",
                        fmt::format("suction.gap_m = {:.4g} leaves {:.4g} m between the cutter (up to z = {:.4g} m) and the backplate",
                                    in.steel.gap, gap, in.cutter.z_max),
                        fmt::format("The rotor zone must end between them with {} cells on each side, which takes {} m at preset {}",
                                    k_gap_cells_min, not_below(needed), in.resolution.preset),
                        sentence(finer, fmt::format("make suction.gap_m at least {}", not_below(top + needed)))});
}

void check_mouth(const MeshInput& in, std::vector<Mistake>& mistakes) {
    const double needed = needed_mouth_radius(in.ring_radius, in.resolution);
    const double radius = in.steel.mouth.radius;
    if (radius >= needed) return;
    const std::string finer = finer_preset(
        [&](const MeshResolution& r) { return r.cell_size < in.resolution.cell_size && radius >= needed_mouth_radius(in.ring_radius, r); });
    mistakes.push_back({"", fmt::format("suction.mouth_radius_m = {:.4g}", radius),
                        fmt::format("The mouth needs {:g} cells across, a radius of {} m at preset {}", k_mouth_cells_min,
                                    not_below(needed), in.resolution.preset),
                        sentence(finer, "enlarge the mouth")});
}

void check_passage(const MeshInput& in, std::vector<Mistake>& mistakes) {
    const double needed = needed_passage(in.ring_radius, in.resolution);
    if (!in.cutter.passage || *in.cutter.passage >= needed) return;
    const double passage = *in.cutter.passage;
    const std::string finer = finer_preset(
        [&](const MeshResolution& r) { return r.cell_size < in.resolution.cell_size && passage >= needed_passage(in.ring_radius, r); });
    mistakes.push_back(
        {"", fmt::format("The passage between two blades is {:.4g} m wide", passage),
         fmt::format("It needs {:g} cells across, {} m at preset {}", k_passage_cells_min, not_below(needed), in.resolution.preset),
         sentence(finer, "widen the passages, with fewer or thinner blades")});
}

/// Room of the tank around zone, backplate and pipe.
void check_tank(const MeshPlan& plan, std::vector<Mistake>& mistakes) {
    const MeshInput& in = plan.input;
    const double margin = k_tank_cells_min * plan.cell_size;
    const auto require = [&](bool holds, const std::string& what, double needed, const std::string& remedy) {
        if (!holds) mistakes.push_back({"", what, fmt::format("The mesh needs {} m there", not_below(needed)), remedy});
    };
    const double mouth_reach = in.steel.mouth.offset + in.steel.mouth.radius + in.steel.pipe_wall;
    const double reach = std::max({plan.rotor.radius, in.steel.plate_radius, mouth_reach}) + margin;
    require(in.tank.radius >= reach,
            fmt::format("tank.radius_m = {:.4g} leaves too little water around head, backplate and pipe", in.tank.radius), reach,
            "Widen the tank");
    const double below = plan.rotor.z_bottom - in.tank.z_min;
    require(below >= margin, fmt::format("The rotor zone ends {:.4g} m above the tank's bottom", below), margin,
            "Enlarge tank.bed_clearance_m");
    const double above = in.tank.z_max - in.steel.gap - in.steel.plate_thickness;
    require(above >= margin, fmt::format("The tank's top is {:.4g} m above the backplate", above), margin, "Enlarge tank.height_m");
}

void place_rotor_zone(MeshPlan& plan) {
    const MeshInput& in = plan.input;
    const double h = plan.cell_size;
    const double top = std::max(0.0, in.cutter.z_max);
    const double gap = in.steel.gap - top;

    plan.rotor.radius = in.cutter.radius + k_clearance_cells * h;
    plan.rotor.facets = 4 * std::max(2, count(2.0 * k_pi * plan.rotor.radius / (4.0 * in.resolution.axial_stretch * h)));
    const int layers = std::max(4, count((top - in.cutter.z_min) / (in.resolution.axial_stretch * h) + k_clearance_cells));
    const double height = (top - in.cutter.z_min) / (layers - k_clearance_cells);
    plan.rotor.z_bottom = in.cutter.z_min - k_clearance_cells * height;
    plan.rotor.z_top = top + 0.5 * gap;
    const int gap_layers = std::max(k_gap_cells_min, count(0.5 * gap / h));
    plan.zone = {even_row(plan.rotor.z_bottom, top, layers), even_row(top, plan.rotor.z_top, gap_layers)};

    // The steel's cells are halved: the whole layer at the interface counts one, what is left up to the steel two a cell.
    const double cells_to_cutter = 1.0 + 2.0 * (k_clearance_cells - 1.0);
    plan.to_ring = {plan.rotor.radius - in.cutter.radius, cells_to_cutter};
    plan.to_hub = {in.cutter.z_min - plan.rotor.z_bottom, cells_to_cutter};
    plan.to_cutter_top = {0.5 * gap, gap_layers + 1.0};
    plan.to_backplate = {0.5 * gap, static_cast<double>(gap_layers)};
}

void divide_section(MeshPlan& plan) {
    const double h = plan.cell_size;
    const double annulus_inner = plan.rotor.radius - k_annulus_cells * h;
    plan.annulus = even_row(annulus_inner, plan.rotor.radius, k_annulus_cells);
    plan.core_radius = k_core_ratio * annulus_inner;
    plan.core_side_radius = k_core_bulge * plan.core_radius;
    plan.transition_cells = std::max(1, count((annulus_inner - 0.5 * (plan.core_radius + plan.core_side_radius)) / h));
    plan.outer = growing_row(plan.rotor.radius, plan.input.tank.radius, h, plan.input.resolution.stator_growth);
}

void divide_stator_height(MeshPlan& plan) {
    const MeshInput& in = plan.input;
    const double growth = in.resolution.stator_growth;
    const double height = first_cell(plan.zone.front());
    plan.below = {reversed(growing_row(in.tank.z_min, plan.rotor.z_bottom, height, growth))};
    const double plate_top = in.steel.gap + in.steel.plate_thickness;
    // The pipe leads up through these cells: they grow half as fast.
    plan.above = {even_row(plan.rotor.z_top, in.steel.gap, plan.zone.back().cells),
                  even_row(in.steel.gap, plate_top, std::max(1, count(in.steel.plate_thickness / height))),
                  growing_row(plate_top, in.tank.z_max, height, 1.0 + 0.5 * (growth - 1.0))};
}

/// Cells of the refined mesh that the cutter takes. `steel`: its volume in background cells; half of the refined cells are on its side.
double cells_in_cutter(double steel, double refined) {
    const double shell = std::min(steel, 0.5 * refined);
    return 8.0 * shell + (steel - shell);
}

/// Backplate and the pipe's wall within the tank.
double volume_of_stationary_steel(const MeshInput& in) {
    const auto disc = [](double radius) { return k_pi * radius * radius; };
    const double mouth = disc(in.steel.mouth.radius);
    const double pipe_height = in.tank.z_max - in.steel.gap - in.steel.plate_thickness;
    return (disc(in.steel.plate_radius) - mouth) * in.steel.plate_thickness +
           (disc(in.steel.mouth.radius + in.steel.pipe_wall) - mouth) * pipe_height;
}

MeshPrediction predict(const MeshPlan& plan) {
    const MeshInput& in = plan.input;
    const double h = plan.cell_size;
    const double width = plan.rotor.facet_angle() * in.cutter.radius;
    const double height = first_cell(plan.zone.front());
    const double cell_volume = h * height * 0.5 * (h + width);  // between the core's square cells and the annulus' wider ones
    const double refined = k_refined_per_area * in.cutter.area / std::pow(cell_volume, 2.0 / 3.0);

    MeshPrediction prediction;
    prediction.cells = static_cast<double>(plan.background_cells()) + 7.0 * refined -
                       cells_in_cutter(in.cutter.volume / cell_volume, refined) - volume_of_stationary_steel(in) / cell_volume;
    const double gap_cell = first_cell(plan.zone.back());
    prediction.cell_size_min = 0.5 * std::cbrt(h * std::min(h, width) * std::min(gap_cell, height));

    const double tip_speed = std::abs(in.rotation_speed) * in.cutter.radius;
    // The largest Courant number is that of a cell which has a part of both: the fits of the model at 30, 60 and 90 rpm lie on this sum.
    const double rate =
        std::hypot(k_mouth_rate * mouth_velocity(in) / gap_cell, k_tip_rate * tip_speed / (k_cutter_cell * std::min(h, height)));
    prediction.time_step = in.max_courant / rate;
    const double steps = 2.0 * k_pi / std::abs(in.rotation_speed) / prediction.time_step;
    prediction.core_hours_per_revolution = steps * prediction.cells * k_core_s_per_cell_step / 3600.0;
    prediction.mesh_memory = k_mesh_memory + k_mesh_memory_per_cell * prediction.cells;
    prediction.run_memory = k_run_memory + k_run_memory_per_cell * prediction.cells;
    return prediction;
}

}  // namespace

MeshResolution mesh_preset(const std::string& name) {
    const auto preset = std::find_if(presets().begin(), presets().end(), [&](const MeshResolution& one) { return one.preset == name; });
    if (preset != presets().end()) return *preset;
    throw UserError(fmt::format("mesh.preset = \"{}\"", name), fmt::format("It must be one of {}", fmt::join(mesh_preset_names(), ", ")),
                    "Choose one of them");
}

std::vector<std::string> mesh_preset_names() {
    std::vector<std::string> names;
    for (const MeshResolution& preset : presets()) names.push_back(preset.preset);
    return names;
}

CutterExtent extent_of_cutter(const geometry::TriangleSurface& cutter) {
    const geometry::Bounds bounds = geometry::bounds_of(cutter);
    double radius = 0.0;
    for (const Vec3& point : cutter.points) radius = std::max(radius, std::hypot(point.x(), point.y()));
    return {radius, bounds.min.z(), bounds.max.z(), geometry::area_of(cutter), geometry::volume_of(cutter)};
}

double first_cell(const CellRow& row) {
    return first_of(row.to - row.from, row.cells, row_growth(row));
}

CellRow growing_row(double from, double to, double first, double growth) {
    const double length = to - from;
    if (!(length > 0.0) || !(first > 0.0) || !(growth > 1.0))
        throw std::invalid_argument("a growing row of cells needs a length, a cell and a growth above 1");
    const int cells = std::max(1, static_cast<int>(std::ceil(std::log1p(length * (growth - 1.0) / first) / std::log(growth) - 1e-9)));
    if (length <= first * cells) return even_row(from, to, cells);
    double low = 1.0, high = growth * 1.0001;
    for (int i = 0; i < 60; ++i) {
        const double q = 0.5 * (low + high);
        (first_of(length, cells, q) > first ? low : high) = q;
    }
    return {from, to, cells, std::pow(0.5 * (low + high), cells - 1)};
}

double RotorZone::volume() const {
    return 0.5 * facets * radius * radius * std::sin(facet_angle()) * (z_top - z_bottom);
}

double RotorZone::facet_angle() const {
    return 2.0 * k_pi / facets;
}

std::size_t MeshPlan::cells_per_disc() const {
    return static_cast<std::size_t>(core_cells() * core_cells() + rotor.facets * (transition_cells + annulus.cells));
}

std::size_t MeshPlan::background_rotor_cells() const {
    return cells_per_disc() * static_cast<std::size_t>(cells_of(zone));
}

std::size_t MeshPlan::background_cells() const {
    const std::size_t ring = static_cast<std::size_t>(rotor.facets * outer.cells);
    const std::size_t outside = static_cast<std::size_t>(cells_of(below) + cells_of(above));
    return background_rotor_cells() + cells_per_disc() * outside + ring * (outside + static_cast<std::size_t>(cells_of(zone)));
}

std::size_t MeshPlan::interface_faces() const {
    return static_cast<std::size_t>(rotor.facets * cells_of(zone)) + 2 * cells_per_disc();
}

MeshPlan plan_mesh(const MeshInput& input) {
    require_sizes(input);
    std::vector<Mistake> mistakes;
    check_gap(input, mistakes);
    check_mouth(input, mistakes);
    check_passage(input, mistakes);

    MeshPlan plan;
    plan.input = input;
    plan.cell_size = input.resolution.cell_size * input.ring_radius;
    place_rotor_zone(plan);
    check_tank(plan, mistakes);
    if (!mistakes.empty()) throw UserError(std::move(mistakes));

    divide_section(plan);
    divide_stator_height(plan);
    plan.prediction = predict(plan);
    return plan;
}

std::vector<Mistake> mesh_warnings(const MeshInput& in) {
    const double needed = needed_thickness(in.ring_radius, in.resolution);
    if (!in.cutter.thickness || *in.cutter.thickness >= needed) return {};
    const double thickness = *in.cutter.thickness;
    const std::string finer = finer_preset(
        [&](const MeshResolution& r) { return r.cell_size < in.resolution.cell_size && thickness >= needed_thickness(in.ring_radius, r); });
    return {{"", fmt::format("The thinnest steel of the cutter is {:.4g} m thick", thickness),
             fmt::format("The mesh keeps steel thinner than the cutter's cells, {:.4g} m at preset {}, but not its thickness and its edges",
                         needed, in.resolution.preset),
             sentence(finer, "look at the steel's volume among the gates of mesh.json")}};
}

}  // namespace cutterflow::meshing
