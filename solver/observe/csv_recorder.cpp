#include "solver/observe/csv_recorder.hpp"

#include <algorithm>
#include <iostream>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"
#include "geometry/head/axial_bins.hpp"
#include "solver/observe/velocity/velocity_tables.hpp"

namespace cutterflow::coupling {
namespace {

constexpr const char* k_rock = "rock";

std::string time_name(double time) {
    return fmt::format("{:.6g}", time);
}

std::string optional_number(const std::optional<double>& value) {
    return value ? fmt::format("{:.9g}", *value) : std::string();
}

double area_of(const SteelTriangle& triangle) {
    return 0.5 * (triangle.b - triangle.a).cross(triangle.c - triangle.a).norm();
}

/// A wall's triangles with the work on each over its area, as VTK XML polygons.
std::string vtp_of(const WallWork& work) {
    const std::size_t n = work.triangles.size();
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<Points>\n",
        3 * n, n);
    const auto array = [&](const char* type, const char* name, int components, const auto& value_of) {
        text += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type, name, components);
        for (std::size_t t = 0; t < n; ++t) text += value_of(t);
        text += "</DataArray>\n";
    };
    const auto per_area = [&](const char* name, const std::vector<double>& of_triangle) {
        array("Float64", name, 1, [&](std::size_t t) {
            const double area = area_of(work.triangles[t]);
            return fmt::format("{:.9g}\n", area > 0.0 ? of_triangle[t] / area : 0.0);
        });
    };
    array("Float64", "Points", 3, [&](std::size_t t) {
        std::string corners;
        for (const Vec3& p : {work.triangles[t].a, work.triangles[t].b, work.triangles[t].c})
            corners += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
        return corners;
    });
    text += "</Points>\n<Polys>\n";
    array("Int64", "connectivity", 1, [](std::size_t t) { return fmt::format("{} {} {}\n", 3 * t, 3 * t + 1, 3 * t + 2); });
    array("Int64", "offsets", 1, [](std::size_t t) { return fmt::format("{}\n", 3 * t + 3); });
    text += "</Polys>\n<CellData>\n";
    per_area("impact_j_m2", work.impact);
    per_area("sliding_j_m2", work.sliding);
    return text + "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace

CsvRecorder::CsvRecorder(const std::filesystem::path& case_folder, const CouplingSettings& settings, double start_time, int ranks)
    : root_(case_folder / "postProcessing"), settings_(settings), start_(time_name(start_time)), ranks_(ranks) {}

void CsvRecorder::begin() {
    note_replaced_start(root_.parent_path(), folder("cost"), ranks_);
    std::filesystem::remove(folder("cost") / "cost.json");  // it would say that this start has come to its end
    const std::string soil = settings_.soil ? ",soil_force_x_n,soil_force_y_n,soil_force_z_n" : "";
    loads_ = open("loads", "loads.csv", "time_s,rotor_angle_rad,torque_pressure_n_m,torque_viscous_n_m,torque_rock_n_m,power_w" + soil);
    balance_ =
        open("balance", "balance.csv",
             "time_s,solid_volume_error,deposit_error,momentum_error,momentum_interface_error,momentum_replaced,momentum_turned,"
             "momentum_carried,momentum_boundary,"
             "flow_balance_error,interface_imbalance,interface_mismatch,continuity_error,domain_surplus,clipped_cells,"
             "outlet_flow_m3_s,outlet_pressure_m2_s2,solid_fraction_max,overfull_cells,swept_limited_cells,wake_limited_rocks,hidden_rocks,"
             "cramped_rocks,courant_max,speed_max_m_s,overlap_ratio_max,dem_substeps,rocks,contacts,exchanged_volume_m3,"
             "exchanged_momentum_n_s");
    cost_ = open("cost", "cost.csv", "time_s,step_s,fluid_s,mesh_motion_s,mapping_s,dem_s,output_s");
    warnings_.open(folder("cost") / names::warnings);
    require_written(warnings_, folder("cost") / names::warnings);
    if (settings_.outflow && settings_.fates) {
        std::string header = "time_s";
        for (const geometry::AxialBin& bin : geometry::axial_bins(read_contour(*settings_.fates), settings_.fates->bin_width))
            header += "," + bin.name;
        outflow_ = open("outflow", "contour_velocity.csv", header);
        flux_ = open("outflow", "contour_flux.csv", header);
    }
    if (!settings_.has_rock) return;
    events_ = open(k_rock, "events.csv",
                   "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,"
                   "density_kg_m3,bin");
    if (settings_.fates) {
        ledger_ = open(k_rock, "ledger.csv",
                       "time_s,fed_kg,owed_kg,in_head_kg,delivered_kg,spilled_mixing_kg,spilled_cutting_kg,on_bed_kg,left_behind_kg,"
                       "left_behind_cutting_kg,error");
        fates_ = open(k_rock, "fates.csv",
                      "time_s,placed_count,placed_kg,sucked_up_count,sucked_up_kg,spilled_count,spilled_kg,in_cutter_count,in_cutter_kg,"
                      "never_entered_count,never_entered_kg");
    }
    rejected_ = open(k_rock, "rejected.csv", "id,time_s,reason");
    std::string whereabouts = "time_s,placed_count,placed_kg";
    for (const char* where : k_whereabouts) whereabouts += fmt::format(",{0}_count,{0}_kg", where);
    account_ = open(k_rock, "account.csv", whereabouts);
    contacts_ = open(k_rock, "contacts.csv", "time_s,contacts,overlap_ratio_max");
    walls_ = open(k_rock, "walls.csv", "time_s,wall,force_x_n,force_y_n,force_z_n,pressed_x_m,pressed_y_m,pressed_z_m");
    wall_work_ = open(k_rock, "wall_work.csv", "time_s,wall,impact_j,sliding_j,since_s");
    if (!settings_.gates.empty())
        gates_ = open(k_rock, "gates.csv", "time_s,gate,id,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_m,mass_kg");
    if (std::any_of(settings_.operations.begin(), settings_.operations.end(),
                    [](const OperationSettings& operation) { return operation.kind == OperationKind::extract; }))
        extractions_ = open(k_rock, "extract.csv", "time_s,event,due_kg,extracted_kg,in_region,starved");
    if (!settings_.shapes.empty()) write_shapes(settings_.shapes);

    keep_pictures_before_start();
}

/// Pictures of an earlier part of the run stay in the series; those of the part that this start replaces leave it at once, and stay in
/// the folder.
void CsvRecorder::keep_pictures_before_start() {
    const std::filesystem::path pictures = root_ / k_rock / "vtk";
    std::filesystem::create_directories(pictures);
    const double start = std::strtod(start_.c_str(), nullptr);  // in as many digits as the names of the pictures
    for (const auto& entry : std::filesystem::directory_iterator(pictures)) {
        const std::string name = entry.path().stem().string();
        const double time = name.rfind("rocks_", 0) == 0 ? std::strtod(name.c_str() + 6, nullptr) : start + 1.0;
        if (time <= start) pictures_[time] = "vtk/" + entry.path().filename().string();
    }
    if (std::filesystem::exists(root_ / k_rock / "rocks.pvd")) write_series();
}

void CsvRecorder::describe(std::vector<ModelNote> models, std::map<std::string, std::string> versions) {
    models_ = std::move(models);
    versions_ = std::move(versions);
}

/// What the numbers of `shape` in the pictures stand for.
void CsvRecorder::write_shapes(const std::vector<ClumpShape>& shapes) const {
    nlohmann::json list = nlohmann::json::array();
    for (const ClumpShape& shape : shapes) {
        nlohmann::json spheres = nlohmann::json::array();
        for (const geometry::Ball& ball : shape.clump.balls)
            spheres.push_back({{"centre", {ball.centre.x(), ball.centre.y(), ball.centre.z()}}, {"radius", ball.radius}});
        list.push_back({{"name", shape.name}, {"spheres_over_diameter", spheres}});
    }
    write_file(root_ / k_rock / "shapes.json", list.dump(2) + "\n");
}

std::filesystem::path CsvRecorder::folder(const std::string& what) const {
    return root_ / what / start_;
}

std::ofstream CsvRecorder::open(const std::string& what, const std::string& file, const std::string& header) const {
    std::filesystem::create_directories(folder(what));
    std::ofstream stream(folder(what) / file);
    stream << header << '\n';
    require_written(stream, folder(what) / file);
    return stream;
}

void CsvRecorder::event(const RockEvent& e) {
    fmt::print(events_, "{:.9g},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", e.time, e.id,
               surface_name(e.surface), direction_name(e.direction), e.position[0], e.position[1], e.position[2], e.velocity[0],
               e.velocity[1], e.velocity[2], e.rotor_angle, e.azimuth, e.axial, e.diameter, e.density, e.bin);
}

void CsvRecorder::rejected(const RejectedRock& rock) {
    fmt::print(rejected_, "{},{:.9g},{}\n", rock.id, rock.time, rock.reason);
}

void CsvRecorder::account(double time, const AccountTotals& totals) {
    int count = 0;
    double mass = 0.0;
    for (std::size_t where = 0; where < k_whereabouts.size(); ++where) {
        count += totals.count[where];
        mass += totals.mass[where];
    }
    fmt::print(account_, "{:.9g},{},{:.12g}", time, count, mass);
    for (std::size_t where = 0; where < k_whereabouts.size(); ++where)
        fmt::print(account_, ",{},{:.12g}", totals.count[where], totals.mass[where]);
    account_ << '\n';
}

void CsvRecorder::gate(const GateRow& row) {
    fmt::print(gates_, "{:.9g},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", row.time, row.gate, row.id, row.sense,
               row.position[0], row.position[1], row.position[2], row.velocity[0], row.velocity[1], row.velocity[2], row.diameter,
               row.mass);
}

void CsvRecorder::extraction(const ExtractionRow& row) {
    fmt::print(extractions_, "{:.9g},{},{:.9g},{:.9g},{},{}\n", row.time, row.event, row.due, row.extracted, row.in_region,
               row.starved ? 1 : 0);
}

void CsvRecorder::contacts(double time, int contacts, double overlap_ratio) {
    fmt::print(contacts_, "{:.9g},{},{:.6g}\n", time, contacts, overlap_ratio);
}

void CsvRecorder::walls(double time, gsl::span<const WallForce> forces) {
    for (const WallForce& wall : forces)
        fmt::print(walls_, "{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", time, wall.wall, wall.force[0], wall.force[1],
                   wall.force[2], wall.pressed[0], wall.pressed[1], wall.pressed[2]);
}

void CsvRecorder::fates(double time, const FateTotals& totals) {
    fmt::print(fates_, "{:.9g},{},{:.9g}", time, totals.placed.count, totals.placed.mass);
    for (const Fate fate : {Fate::sucked_up, Fate::spilled, Fate::in_cutter, Fate::never_entered})
        fmt::print(fates_, ",{},{:.9g}", totals.of(fate).count, totals.of(fate).mass);
    fates_ << '\n';
}

void CsvRecorder::ledger(double time, const RockLedger& ledger) {
    fmt::print(ledger_, "{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.3g}\n", time, ledger.fed,
               ledger.owed, ledger.in_head, ledger.delivered, ledger.spilled_mixing, ledger.spilled_cutting, ledger.on_bed,
               ledger.left_behind(), ledger.left_behind_cutting, ledger.error());
}

void CsvRecorder::outflow(double time, gsl::span<const double> radial_velocity, gsl::span<const double> flux) {
    const auto print_row = [time](std::ofstream& table, gsl::span<const double> values) {
        fmt::print(table, "{:.9g}", time);
        for (const double value : values) fmt::print(table, ",{:.6g}", value);
        table << '\n';
    };
    print_row(outflow_, radial_velocity);
    print_row(flux_, flux);
}

void CsvRecorder::loads(const LoadsRow& row) {
    fmt::print(loads_, "{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", row.time, row.rotor_angle, row.torque_pressure, row.torque_viscous,
               row.torque_rock, row.power);
    const Vec3 force = row.soil_force.value_or(Vec3::Zero());
    if (settings_.soil) fmt::print(loads_, ",{:.9g},{:.9g},{:.9g}", force.x(), force.y(), force.z());
    loads_ << '\n';
}

void CsvRecorder::balance(const BalanceRow& row) {
    fmt::print(balance_, "{:.9g}", row.time);
    for (const double error :
         {row.solid_volume_error, row.deposit_error, row.momentum.error, row.momentum.interface_error, row.momentum.replaced,
          row.momentum.turned, row.momentum.carried, row.momentum.boundary, row.flow_balance_error, row.interface_imbalance,
          row.interface_mismatch, row.continuity_error, row.domain_surplus})
        fmt::print(balance_, ",{:.4g}", error);
    fmt::print(balance_, ",{},{},{},{:.6g},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{},{:.9g},{:.9g}\n", row.clipped_cells,
               optional_number(row.outlet_flow), optional_number(row.outlet_pressure), row.solid_fraction_max, row.overfull_cells,
               row.limited.swept_cells, row.limited.wake_rocks, row.limited.hidden_rocks, row.limited.cramped_rocks, row.courant_max,
               row.speed_max, row.overlap_ratio_max, row.dem_substeps, row.rocks, row.contacts, row.exchanged_volume,
               row.exchanged_momentum);
}

void CsvRecorder::cost(const CostRow& row) {
    fmt::print(cost_, "{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", row.time, row.step, row.fluid, row.mesh_motion, row.mapping,
               row.dem, row.output);
}

void CsvRecorder::picture(const RockPicture& picture) {
    const std::string file = fmt::format("vtk/rocks_{}.vtp", time_name(picture.time));
    std::ofstream stream(root_ / k_rock / file);
    const std::size_t n = static_cast<std::size_t>(picture.id.size());
    const auto array = [&](const char* type, const char* name, int components, const auto& write_values) {
        fmt::print(stream, "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type, name, components);
        for (std::size_t p = 0; p < n; ++p) write_values(p);
        stream << "</DataArray>\n";
    };
    const auto vector = [&](const Vec3& v) { fmt::print(stream, "{:.9g} {:.9g} {:.9g}\n", v[0], v[1], v[2]); };
    fmt::print(
        stream,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n",
        n);
    array("Float64", "Points", 3, [&](std::size_t p) { vector(picture.position[p]); });
    stream << "</Points>\n<Verts>\n";
    array("Int32", "connectivity", 1, [&](std::size_t p) { fmt::print(stream, "{}\n", p); });
    array("Int32", "offsets", 1, [&](std::size_t p) { fmt::print(stream, "{}\n", p + 1); });
    stream << "</Verts>\n<PointData>\n";
    array("Int32", "id", 1, [&](std::size_t p) { fmt::print(stream, "{}\n", picture.id[p]); });
    array("Float64", "diameter", 1, [&](std::size_t p) { fmt::print(stream, "{:.9g}\n", picture.diameter[p]); });
    array("Float64", "density", 1, [&](std::size_t p) { fmt::print(stream, "{:.9g}\n", picture.density[p]); });
    array("Float64", "velocity", 3, [&](std::size_t p) { vector(picture.velocity[p]); });
    array("Float64", "hydrodynamic_force", 3, [&](std::size_t p) { vector(picture.hydrodynamic_force[p]); });
    array("Float64", "contact_force", 3, [&](std::size_t p) { vector(picture.contact_force[p]); });
    array("Int32", "frozen", 1, [&](std::size_t p) {
        fmt::print(stream, "{}\n", std::binary_search(picture.frozen.begin(), picture.frozen.end(), picture.id[p]) ? 1 : 0);
    });
    if (!picture.fate.empty())
        array("Int32", "fate", 1, [&](std::size_t p) { fmt::print(stream, "{}\n", static_cast<int>(picture.fate[p])); });
    if (!picture.shape.empty()) {
        array("Int32", "shape", 1, [&](std::size_t p) { fmt::print(stream, "{}\n", picture.shape[p]); });
        array("Float64", "orientation", 4, [&](std::size_t p) {
            const Eigen::Quaterniond& q = picture.orientation[p];
            fmt::print(stream, "{:.9g} {:.9g} {:.9g} {:.9g}\n", q.w(), q.x(), q.y(), q.z());
        });
    }
    stream << "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
    close_written(stream, root_ / k_rock / file);
    pictures_[picture.time] = file;
    write_series();
    flush();  // one who watches a run finds tables as far as its pictures
}

void CsvRecorder::write_series() const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
    for (const auto& [time, file] : pictures_) text += fmt::format("<DataSet timestep=\"{:.9g}\" file=\"{}\"/>\n", time, file);
    write_file(root_ / k_rock / "rocks.pvd", text + "</Collection>\n</VTKFile>\n");
}

void CsvRecorder::wall_work(double time, gsl::span<const WallWork> works) {
    const auto sum = [](const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); };
    for (const WallWork& work : works) {
        fmt::print(wall_work_, "{:.9g},{},{:.9g},{:.9g},{:.9g}\n", time, work.wall, sum(work.impact), sum(work.sliding), work.since);
        write_file(root_ / k_rock / fmt::format("wall_work_{}.vtp", work.wall), vtp_of(work));
    }
    wall_work_.flush();
}

void CsvRecorder::outcomes(gsl::span<const RockOutcome> outcomes) {
    std::string text = "id,fate,last_exit_bin,first_exit_time_s,first_exit_azimuth_rad,x_m,y_m,z_m,diameter_m,density_kg_m3\n";
    for (const RockOutcome& rock : outcomes)
        text += fmt::format("{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", rock.id, fate_name(rock.fate), rock.last_exit_bin,
                            optional_number(rock.first_exit_time), optional_number(rock.first_exit_azimuth), rock.position[0],
                            rock.position[1], rock.position[2], rock.diameter, rock.density);
    write_file(folder(k_rock) / "final.csv", text);
}

void CsvRecorder::velocity(const VelocitySets& sets, double time) {
    std::filesystem::create_directories(folder("velocity"));
    write_velocity_tables(folder("velocity"), sets, time);
}

void CsvRecorder::finished(const RunCost& cost) {
    flush();  // cost.json says that the run came to its end and that its tables are whole
    nlohmann::json json;
    json["ranks"] = cost.ranks;
    json["cells"] = static_cast<std::int64_t>(cost.cells);
    json["steps"] = cost.steps;
    json["wall_s"] = cost.wall;
    json["core_s"] = cost.core;
    const double total = cost.totals.fluid + cost.totals.mesh_motion + cost.totals.mapping + cost.totals.dem + cost.totals.output;
    const auto share = [total](double part) { return total > 0.0 ? part / total : 0.0; };
    json["share"] = {{"fluid", share(cost.totals.fluid)},
                     {"mesh_motion", share(cost.totals.mesh_motion)},
                     {"mapping", share(cost.totals.mapping)},
                     {"dem", share(cost.totals.dem)},
                     {"output", share(cost.totals.output)}};
    json["models"] = nlohmann::json::array();
    for (const ModelNote& model : models_) json["models"].push_back({{"name", model.name}, {"why", model.why}});
    json["versions"] = versions_;
    write_file(folder("cost") / "cost.json", json.dump(2) + "\n");
}

void CsvRecorder::warning(double time, const std::string& text) {
    const std::string line = fmt::format("time {:.6g} s: {}", time, text);
    std::cerr << "cutterFoam: warning: " << line << std::endl;
    warnings_ << line << std::endl;  // on the disk at once, whatever becomes of this start
    require_written(warnings_, folder("cost") / names::warnings);
}

void CsvRecorder::flush() {
    for (std::ofstream* stream : {&events_, &rejected_, &account_, &gates_, &extractions_, &contacts_, &walls_, &fates_, &ledger_,
                                  &outflow_, &flux_, &loads_, &balance_, &cost_, &wall_work_}) {
        stream->flush();
        require_written(*stream, root_);
    }
}

}  // namespace cutterflow::coupling
