#include "postproc/tests/synthetic_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/head/axial_bins.hpp"

namespace cutterflow::postproc::testing {
namespace {

namespace fs = std::filesystem;

constexpr double k_density = 2650.0;
constexpr const char* k_events_header =
    "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,density_kg_m3,bin\n";
constexpr const char* k_fates_header =
    "time_s,placed_count,placed_kg,sucked_up_count,sucked_up_kg,spilled_count,spilled_kg,in_cutter_count,in_cutter_kg,never_entered_count,"
    "never_entered_kg\n";
constexpr const char* k_final_header =
    "id,fate,last_exit_bin,first_exit_time_s,first_exit_azimuth_rad,x_m,y_m,z_m,diameter_m,density_kg_m3\n";
constexpr const char* k_balance_header =
    "time_s,solid_volume_error,deposit_error,momentum_error,momentum_interface_error,momentum_replaced,momentum_turned,momentum_carried,"
    "flow_balance_error,"
    "interface_imbalance,interface_mismatch,continuity_error,domain_surplus,clipped_cells,outlet_flow_m3_s,"
    "outlet_pressure_m2_s2,solid_fraction_max,overfull_cells,courant_max,overlap_ratio_max,dem_substeps,rocks,contacts\n";
constexpr const char* k_loads_header = "time_s,rotor_angle_rad,torque_pressure_n_m,torque_viscous_n_m,torque_rock_n_m,power_w\n";
constexpr const char* k_cost_header = "time_s,step_s,fluid_s,mesh_motion_s,mapping_s,dem_s,output_s\n";

/// A temporary folder that goes with its owner.
class ProcessFolder {
public:
    ProcessFolder() {
        std::string name = (fs::temp_directory_path() / "cutterflow_postproc_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~ProcessFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ProcessFolder(const ProcessFolder&) = delete;
    ProcessFolder& operator=(const ProcessFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

double mass_of(double diameter) {
    return sphere_mass(diameter, k_density);
}

geometry::Contour head_contour() {
    return geometry::Contour({-0.44, -0.40, -0.25, -0.10, 0.0}, {0.10, 0.20, 0.32, 0.39, 0.40}, 0.40, 0.03);
}

std::string event_line(const Event& event, double axial) {
    const double radius = 0.4;
    return fmt::format("{:.9g},{},{},{},{:.6g},{:.6g},{:.6g},0.1,0.2,-0.3,{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", event.time, event.id,
                       event.surface, event.direction, radius * std::cos(event.azimuth), radius * std::sin(event.azimuth), axial,
                       2.0 * k_pi * event.time, event.azimuth, axial, event.diameter, k_density, event.bin);
}

/// State of one rock as a run keeps it, by the definitions of the contract.
struct RockState {
    bool inside = false, was_inside = false, sucked_up = false;
    double diameter = 0.02;
    std::string last_exit_bin;
    double first_exit_time = -1.0, first_exit_azimuth = 0.0;
    std::string fate() const {
        if (sucked_up) return "sucked_up";
        if (inside) return "in_cutter";
        return was_inside ? "spilled" : "never_entered";
    }
};

std::map<int, RockState> states_at(const std::vector<Event>& events, double time) {
    std::map<int, RockState> states;
    for (const Event& event : events) {
        if (event.time > time + 1e-9) break;
        RockState& state = states[event.id];
        state.diameter = event.diameter;
        if (event.surface == "mouth") state.sucked_up = true;
        if (event.surface != "head") continue;
        state.inside = event.direction == "in";
        state.was_inside = true;
        if (state.inside) continue;
        state.last_exit_bin = event.bin;
        if (state.first_exit_time >= 0.0) continue;
        state.first_exit_time = event.time;
        state.first_exit_azimuth = event.azimuth;
    }
    return states;
}

std::string fates_line(const std::vector<Event>& events, double time) {
    std::map<std::string, std::pair<int, double>> sums;
    for (const auto& [id, state] : states_at(events, time)) {
        for (const std::string& key : {std::string("placed"), state.fate()}) {
            ++sums[key].first;
            sums[key].second += mass_of(state.diameter);
        }
    }
    std::string line = fmt::format("{:.9g}", time);
    for (const char* key : {"placed", "sucked_up", "spilled", "in_cutter", "never_entered"}) {
        line += fmt::format(",{},{:.12g}", sums[key].first, sums[key].second);
    }
    return line + "\n";
}

std::string final_table(const std::vector<Event>& events, double time, const std::map<int, Vec3>& positions) {
    std::string text = k_final_header;
    for (const auto& [id, state] : states_at(events, time)) {
        const auto found = positions.find(id);
        const Vec3 at = found == positions.end() ? Vec3(0.2, 0.0, -0.1) : found->second;
        const std::string exit =
            state.first_exit_time < 0.0 ? "," : fmt::format("{:.6g},{:.6g}", state.first_exit_time, state.first_exit_azimuth);
        text += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", id, state.fate(), state.last_exit_bin, exit, at.x(), at.y(),
                            at.z(), state.diameter, k_density);
    }
    return text;
}

std::string contour_table() {
    std::string text = "z_m,r_m\n";
    const geometry::Contour contour = head_contour();
    for (std::size_t i = 0; i < contour.z().size(); ++i) text += fmt::format("{},{}\n", contour.z()[i], contour.radius()[i]);
    return text;
}

void write_stl(const fs::path& file, const std::vector<std::array<Vec3, 3>>& triangles) {
    std::string bytes(80, ' ');
    const auto count = static_cast<std::uint32_t>(triangles.size());
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto& triangle : triangles) {
        const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
        for (const Vec3& vector : {normal, triangle[0], triangle[1], triangle[2]}) {
            for (int axis = 0; axis < 3; ++axis) {
                const auto value = static_cast<float>(vector[axis]);
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
        }
        bytes.append(2, '\0');
    }
    write_text(file, bytes);
}

using Triangles = std::vector<std::array<Vec3, 3>>;

void add_quad(Triangles& triangles, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
}

Vec3 ring_point(double radius, double azimuth, double z) {
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

/// Wall of revolution between two circles; radius 0 closes it to a point.
void add_ring_wall(Triangles& triangles, double r0, double z0, double r1, double z1, const Vec3& shift = Vec3::Zero()) {
    constexpr int segments = 96;
    for (int i = 0; i < segments; ++i) {
        const double a = 2.0 * k_pi * i / segments, b = 2.0 * k_pi * (i + 1) / segments;
        add_quad(triangles, shift + ring_point(r0, a, z0), shift + ring_point(r0, b, z0), shift + ring_point(r1, b, z1),
                 shift + ring_point(r1, a, z1));
    }
}

/// A six-blade crown: ring, hub and helical blades that follow the contour.
Triangles crown() {
    Triangles triangles;
    const std::vector<std::pair<double, double>> ring{{0.33, 0.0}, {0.40, 0.0}, {0.40, -0.05}, {0.35, -0.05}, {0.33, 0.0}};
    for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        add_ring_wall(triangles, ring[i].first, ring[i].second, ring[i + 1].first, ring[i + 1].second);
    const std::vector<std::pair<double, double>> hub{{0.0, -0.44}, {0.10, -0.44}, {0.13, -0.36}, {0.07, -0.30}, {0.0, -0.30}};
    for (std::size_t i = 0; i + 1 < hub.size(); ++i)
        add_ring_wall(triangles, hub[i].first, hub[i].second, hub[i + 1].first, hub[i + 1].second);
    const geometry::Contour contour = head_contour();
    constexpr int steps = 48;
    for (int blade = 0; blade < 6; ++blade) {
        std::array<Vec3, 4> last{};
        for (int i = 0; i <= steps; ++i) {
            const double z = -0.42 + 0.40 * i / steps;
            const double azimuth = 2.0 * k_pi * blade / 6.0 + 1.2 * (z + 0.42) / 0.42;
            const double outer = contour.radius_at(z), inner = std::max(0.07, 0.72 * outer - 0.02), half = 0.012;
            const std::array<Vec3, 4> section{ring_point(inner, azimuth - half / inner + 0.10, z),
                                              ring_point(inner, azimuth + half / inner + 0.10, z),
                                              ring_point(outer, azimuth + half / outer, z), ring_point(outer, azimuth - half / outer, z)};
            for (std::size_t k = 0; i > 0 && k < 4; ++k) add_quad(triangles, last[k], last[(k + 1) % 4], section[(k + 1) % 4], section[k]);
            if (i == 0 || i == steps) add_quad(triangles, section[0], section[1], section[2], section[3]);
            last = section;
        }
    }
    return triangles;
}

void write_surfaces(const fs::path& directory) {
    write_stl(directory / "geometry/cutter.stl", crown());
    Triangles backplate, pipe;
    add_ring_wall(backplate, 0.0, 0.03, 0.40, 0.03);
    add_ring_wall(backplate, 0.40, 0.03, 0.40, 0.06);
    add_ring_wall(backplate, 0.40, 0.06, 0.0, 0.06);
    add_ring_wall(pipe, 0.10, 0.03, 0.10, 0.42, Vec3(0.22, 0.0, 0.0));
    add_ring_wall(pipe, 0.11, 0.03, 0.11, 0.42, Vec3(0.22, 0.0, 0.0));
    write_stl(directory / "geometry/backplate.stl", backplate);
    write_stl(directory / "geometry/suction_pipe.stl", pipe);
}

std::string quoted_toml(const std::string& text) {
    return nlohmann::json(text).dump();
}

std::string study_toml(const std::string& name, double length_ratio, double speed_rpm) {
    return fmt::format(
        "name = {}\n[rotor]\nspeed_rpm = {}\ndirection = \"right_handed\"\n[suction]\ndischarge_m3_s = 0.12\nmouth_radius_m = 0.1\ngap_m = "
        "0.03\n"
        "mouth_offset_m = 0.22\nmouth_azimuth_deg = 0\n[ladder]\ninclination_deg = 45\n[swing]\ndirection = \"over_cut\"\n"
        "[mesh]\npreset = \"draft\"\n[fluid]\ndensity_kg_m3 = 998.2\n[report]\nbin_width_m = 0.03\noutflow_start_s = 1.0\n"
        "[scale]\nlength_ratio = {}\n",
        quoted_toml(name), speed_rpm, length_ratio);
}

nlohmann::json feed_report(int requested, int placed, double settling_velocity) {
    return {
        {"feeds",
         {{{"requested", requested},
           {"placed", placed},
           {"rejected", requested - placed},
           {"reasons", {fmt::format("{} places lay inside steel", requested - placed)}},
           {"start_s", 1.0},
           {"classes",
            {{{"diameter_m", 0.02}, {"density_kg_m3", k_density}, {"count", placed}, {"settling_velocity_m_s", settling_velocity}}}}}}}};
}

nlohmann::json mesh_report() {
    return {{"cells", 61240},
            {"rotor_cells", 33100},
            {"stator_cells", 28140},
            {"cell_size_min_m", 0.0081},
            {"cell_size_max_m", 0.19},
            {"cell_size_at_cutter_m", 0.016},
            {"non_orthogonality_max_deg", 61.3},
            {"non_orthogonality_mean_deg", 9.8},
            {"skewness_max", 2.9},
            {"aspect_ratio_max", 11.2},
            {"interface_weight_min", 0.9993},
            {"interface_weight_max", 1.0006},
            {"interface_faces", 5760},
            {"time_step_s", 0.00062},
            {"preset", "draft"},
            {"wall_s", 48.1},
            {"core_s", 47.0},
            {"retries", nlohmann::json::array()},
            {"gates",
             {{{"name", "non-orthogonality, deg"}, {"value", 61.3}, {"limit", 70}, {"passed", true}},
              {{"name", "skewness"}, {"value", 2.9}, {"limit", 4}, {"passed", true}},
              {{"name", "smallest interface weight"}, {"value", 0.9993}, {"limit", 0.98}, {"passed", true}}}}};
}

nlohmann::json cost_summary(int steps, double wall) {
    return {{"ranks", 2},
            {"cells", 61240},
            {"steps", steps},
            {"wall_s", wall},
            {"core_s", 2 * wall},
            {"share", {{"fluid", 0.6}}},
            {"models",
             {{{"name", "drag brown_lawler"}, {"why", "closures.drag"}},
              {{"name", "hindrance di_felice"}, {"why", "closures.hindrance"}},
              {{"name", "added mass 0.5"}, {"why", "rock is accelerated by the blades"}},
              {{"name", "realizable k-epsilon"}, {"why", "turbulent at the operating Reynolds number"}}}},
            {"versions", {{"cutterFoam", "0.1.0"}, {"OpenFOAM", "1912"}, {"LIGGGHTS", "3.8.0"}}}};
}

nlohmann::json manifest() {
    return {{"stages",
             {{"geometry", {{"state", "done"}, {"wall_s", 2.1}, {"core_s", 2.0}}},
              {"mesh", {{"state", "done"}, {"wall_s", 48.1}, {"core_s", 47.0}}},
              {"start", {{"state", "done"}, {"wall_s", 61.0}, {"core_s", 121.0}}},
              {"run", {{"state", "done"}, {"wall_s", 812.0}, {"core_s", 1610.0}}}}},
            {"versions", {{"cutterflow", "0.1.0"}, {"gnuplot", "5.4"}}}};
}

void write_static_files(const fs::path& directory, const std::string& name, double length_ratio, double speed_rpm) {
    write_text(directory / "study.resolved.toml", study_toml(name, length_ratio, speed_rpm));
    write_text(directory / "geometry/contour.csv", contour_table());
    write_text(directory / "geometry/geometry.json",
               R"({"file": "/data/Cutter <rev B>.STL", "head": {"ring_radius_m": 0.4, "lowest_z_m": -0.44, "blades": 6},
             "surface": {"triangles": 5312, "closed": true, "volume_m3": 0.0101}})");
    write_text(directory / "mesh.json", mesh_report().dump());
    write_text(directory / "manifest.json", manifest().dump());
    write_surfaces(directory);
}

std::string outflow_header() {
    std::string header = "time_s";
    for (const geometry::AxialBin& bin : geometry::axial_bins(head_contour(), 0.03)) header += "," + bin.name;
    return header + "\n";
}

}  // namespace

fs::path fresh_directory(const std::string& name) {
    static const ProcessFolder folder;
    const fs::path directory = folder.path() / name;
    fs::remove_all(directory);
    fs::create_directories(directory);
    return directory;
}

void write_text(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

std::string read_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

double small_rock_mass() {
    return mass_of(0.02);
}

SmallRun::SmallRun(const std::string& name) : directory(fresh_directory(name)) {
    const double quarter = 0.5 * k_pi;
    for (int id = 1; id <= 9; ++id) events.push_back({1.0, id, "feed", "in", "", 0.0, id == 9 ? 0.04 : 0.02});
    for (const int id : {1, 2, 3, 4, 5, 6, 7}) events.push_back({1.1, id, "head", "in", "0-30mm"});
    events.push_back({1.1, 9, "head", "in", "0-30mm", 0.0, 0.04});
    events.push_back({1.255, 1, "head", "out", "gap", 0.1});
    events.push_back({1.255, 2, "head", "out", "gap", quarter + 0.1});
    events.push_back({1.3, 3, "head", "out", "gap", 2.0 * quarter + 0.1});
    events.push_back({1.352, 4, "mouth", "in", ""});
    events.push_back({1.4, 3, "head", "in", "gap"});
    events.push_back({1.45, 5, "mouth", "in", ""});
    events.push_back({1.5, 6, "head", "out", "below_hub", 3.0 * quarter + 0.1});
    events.push_back({1.6, 6, "head", "in", "below_hub"});
    events.push_back({1.65, 9, "head", "out", "60-90mm", 3.0 * quarter + 0.2, 0.04});
    events.push_back({1.7, 3, "head", "out", "0-30mm", 0.2});
    events.push_back({1.8, 6, "mouth", "in", ""});
}

void SmallRun::write_tables(const std::string& start_folder, double from, double to) const {
    const fs::path post = directory / "postProcessing";
    std::string fates = k_fates_header, outflow = outflow_header(), loads = k_loads_header, balance = k_balance_header,
                cost = k_cost_header;
    const std::size_t bin_count = geometry::axial_bins(head_contour(), 0.03).size();
    for (int step = static_cast<int>(std::lround(from / 0.01)) + 1; step <= static_cast<int>(std::lround(to / 0.01)); ++step) {
        const double time = 0.01 * step, wave = std::sin(2.0 * k_pi * time);
        fates += fates_line(events, time);
        outflow += fmt::format("{:.9g}", time);
        for (std::size_t k = 0; k < bin_count; ++k) {
            outflow += fmt::format(",{:.12g}", step <= 100 ? 100.0 : 0.1 * static_cast<double>(k) - 0.3 + 0.5 * wave);
        }
        outflow += "\n";
        const double pressure = -10.0 - 4.0 * wave, rock = step <= 100 || !with_rock ? 0.0 : -2.0;
        loads += fmt::format("{:.9g},{:.12g},{:.12g},-1,{},{:.12g}\n", time, 2.0 * k_pi * time, pressure, rock,
                             -(pressure - 1.0 + rock) * 2.0 * k_pi);
        balance += fmt::format("{:.9g},{},1e-15,{},2e-4,3e-3,2e-3,{},-3e-8,2e-5,4e-3,1e-9,3e-16,7,0.12,-1.5,0.3,2,0.8,0.01,12,9,4\n", time,
                               step == 150 ? -4e-14 : 1e-15, step == 160 ? 5e-12 : -1e-12, step == 170 ? 6.5 : 0.01);
        cost += fmt::format("{:.9g},2,1.2,0.4,0.1,0.06,0.04\n", time);
    }
    if (with_rock) {
        std::string rows = k_events_header;
        for (const Event& event : events) {
            if (event.time > from + 1e-9 && event.time <= to + 1e-9) rows += event_line(event, -0.01);
        }
        write_text(post / "rock" / start_folder / "events.csv", rows);
        write_text(post / "rock" / start_folder / "fates.csv", fates);
        write_text(post / "rock" / start_folder / "final.csv", final_table(events, to, {}));
        write_text(post / "rock" / start_folder / "rejected.csv", "id,time_s,reason\n");
    }
    write_text(post / "outflow" / start_folder / "contour_velocity.csv", outflow);
    write_text(post / "loads" / start_folder / "loads.csv", loads);
    write_text(post / "balance" / start_folder / "balance.csv", balance);
    write_text(post / "cost" / start_folder / "cost.csv", cost);
    if (finished) write_text(post / "cost" / start_folder / "cost.json", cost_summary(200, 400.0).dump());
}

void SmallRun::write() const {
    write_static_files(directory, study_name, length_ratio, speed_rpm);
    if (with_rock) write_text(directory / "feed.json", feed_report(11, 9, 1.036).dump());
    write_tables("0", 0.0, end_time);
}

void add_events(const fs::path& directory, const std::vector<Event>& events) {
    const fs::path file = directory / "postProcessing/rock/0/events.csv";
    std::string rows = read_text(file);
    for (const Event& event : events) rows += event_line(event, -0.01);
    write_text(file, rows);
}

void make_fed(const SmallRun& run, double held, double stuck) {
    constexpr double rate = 10.0, begin = 1.0, wave = 0.1;  // [kg/s], [s], [kg]
    write_text(run.directory / "study.resolved.toml",
               read_text(run.directory / "study.resolved.toml") +
                   "\n[bank]\nmodel = \"wall\"\n[soil]\ngrain_density_kg_m3 = 2500\nporosity = 0.2\n[[feed]]\nkind = \"cut_face\"\n");
    write_stl(run.directory / "geometry/bank.stl", {{Vec3(0.3, 0.5, -0.4), Vec3(0.3, 0.9, -0.4), Vec3(0.3, 0.9, 0.0)}});
    std::string text =
        "time_s,fed_kg,owed_kg,in_head_kg,delivered_kg,spilled_mixing_kg,spilled_cutting_kg,on_bed_kg,left_behind_kg,"
        "left_behind_cutting_kg,error\n";
    for (int step = 1; step <= 3100; ++step) {
        const double time = 0.01 * step, fed = rate * std::max(0.0, time - begin), gone = std::max(0.0, (1.0 - stuck) * fed - held);
        const double to_and_fro = gone > 0.0 ? wave * std::cos(k_pi * time) : 0.0;
        const double delivered = std::max(0.0, 0.6 * gone + to_and_fro), spilled = gone - delivered;
        text += fmt::format("{:.9g},{:.12g},0,{:.12g},{:.12g},{:.12g},0,0,0,0,0\n", time, fed, fed - gone, delivered, spilled);
    }
    write_text(run.directory / "postProcessing/rock/0/ledger.csv", text);
}

void set_swing_speed(const fs::path& directory, double m_min) {
    std::string study = read_text(directory / "study.resolved.toml");
    const std::string section = "[swing]\n";
    study.insert(study.find(section) + section.size(), fmt::format("speed_m_min = {}\n", m_min));
    write_text(directory / "study.resolved.toml", study);
}

void write_velocity_planes(const fs::path& directory, PlaneFlow flow) {
    const auto table = [&](int columns, int rows, const std::function<Vec3(int, int)>& place) {
        std::string text =
            "point,x_m,y_m,z_m,rotating,u_radial_m_s,u_tangential_m_s,u_axial_m_s,se_radial_m_s,se_tangential_m_s,se_axial_m_s,samples,"
            "dry_samples,revolutions,from_s,to_s\n";
        for (int i = 0; i < columns * rows; ++i) {
            const Vec3 at = place(i % columns, i / columns), u = flow(std::hypot(at.x(), at.y()), at.z());
            const bool steel = i >= 7 * columns && i < 7 * columns + k_plane_points_in_steel;
            const std::string velocity =
                steel || !u.allFinite() ? ",,,,," : fmt::format("{:.6g},{:.6g},{:.6g},0.01,0.01,0.01", u.x(), u.y(), u.z());
            text += fmt::format("{},{:.9g},{:.9g},{:.9g},0,{},120,{},1,1,2\n", i + 1, at.x(), at.y(), at.z(), velocity, steel ? 120 : 0);
        }
        return text;
    };
    const auto between = [](double low, double high, int i, int n) { return low + (high - low) * (i + 0.5) / n; };
    const fs::path folder = directory / "postProcessing/velocity/0";
    write_text(folder / "plane_axial.csv",
               table(60, 40, [&](int i, int j) { return Vec3(between(-0.7, 0.7, i, 60), 0.0, between(-0.6, 0.1, j, 40)); }));
    write_text(folder / "plane_under_ring.csv",
               table(50, 50, [&](int i, int j) { return Vec3(between(-0.6, 0.6, i, 50), between(-0.6, 0.6, j, 50), -0.137); }));
}

void write_realistic_run(const fs::path& directory) {
    std::mt19937 random(20231);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> normal;
    write_static_files(directory, "Model cutter 1:4, 60 rpm, batch of 368 rocks", 4.0, 60.0);
    write_text(directory / "feed.json", feed_report(368, 361, 1.036).dump());
    write_velocity_planes(directory, [](double r, double z) {
        return Vec3(0.6 * std::sin(9.0 * r) * std::cos(6.0 * z), 2.4 * r * std::exp(-4.0 * r), 0.5 * std::cos(5.0 * r) * std::exp(3.0 * z));
    });

    constexpr int rocks = 361;
    const geometry::Contour contour = head_contour();
    const std::vector<geometry::AxialBin> bins = geometry::axial_bins(contour, 0.03);
    std::vector<Event> events;
    std::map<int, Vec3> positions;
    for (int id = 1; id <= rocks; ++id) {
        events.push_back({1.0, id, "feed", "in", ""});
        const double draw = unit(random), z = -0.05 - 0.3 * unit(random), azimuth = 2.0 * k_pi * unit(random);
        positions[id] = ring_point((0.4 + 0.5 * unit(random)) * contour.radius_at(z), azimuth, z);
        if (draw > 0.97) {
            positions[id] = ring_point(contour.radius_at(z) + 0.05, azimuth, z);
            continue;
        }
        events.push_back({1.0005, id, "head", "in", bins[geometry::bin_of(bins, z)].name});
        if (draw < 0.34) {
            const double depth = unit(random) < 0.12 ? -0.01 : std::min(0.43, 0.05 * -std::log(1.0 - unit(random)));
            const double exit_azimuth = std::fmod(2.0 * k_pi + 1.1 + 0.7 * normal(random), 2.0 * k_pi);
            const double time = 1.0 + 0.12 + 0.35 * -std::log(1.0 - 0.9 * unit(random));
            if (time >= 2.0) continue;
            events.push_back({time, id, "head", "out", bins[geometry::bin_of(bins, -depth)].name, exit_azimuth});
            positions[id] = ring_point(contour.radius_at(-depth) + 0.02 + 0.25 * unit(random), exit_azimuth + 0.4 * unit(random),
                                       -depth - 0.25 * unit(random) * unit(random));
        } else if (draw < 0.83) {
            const double time = 1.0 + 0.18 + 0.5 * -std::log(1.0 - 0.9 * unit(random));
            if (time >= 2.0) continue;
            events.push_back({time, id, "mouth", "in", ""});
            positions[id] = Vec3(0.22 + 0.12 * (unit(random) - 0.5), 0.12 * (unit(random) - 0.5), 0.25 + 0.15 * unit(random));
        }
    }
    std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.time < b.time; });

    constexpr double step = 6.2e-4;
    constexpr int steps = 3226;
    std::string fates = k_fates_header, outflow = outflow_header(), loads = k_loads_header, balance = k_balance_header,
                cost = k_cost_header;
    double wall = 0.0;
    for (int i = 1; i <= steps; ++i) {
        const double time = std::min(2.0, step * i), omega = 2.0 * k_pi;
        fates += fates_line(events, time);
        outflow += fmt::format("{:.9g}", time);
        for (std::size_t k = 0; k < bins.size(); ++k) {
            const double depth = k == 0 ? -0.015 : k + 1 == bins.size() ? 0.47 : -0.5 * (bins[k].z_min + bins[k].z_max);
            const double mean = k == 0 ? -0.35 : 0.75 * std::exp(-std::pow((depth - 0.05) / 0.07, 2)) - 0.18 * (depth > 0.1);
            outflow += fmt::format(",{:.6g}", mean + 0.12 * std::sin(6.0 * omega * time + depth) + 0.05 * normal(random));
        }
        outflow += "\n";
        const double pressure = -62.0 - 30.0 * std::exp(-6.0 * time) - 5.0 * std::sin(6.0 * omega * time) - 1.5 * normal(random);
        const double rock = time <= 1.0 ? 0.0 : -14.0 * std::exp(-1.6 * (time - 1.0)) * (0.6 + 0.8 * unit(random));
        loads +=
            fmt::format("{:.9g},{:.9g},{:.6g},-1.8,{:.6g},{:.6g}\n", time, omega * time, pressure, rock, -(pressure - 1.8 + rock) * omega);
        const bool with_rock = time > 1.0;
        balance +=
            fmt::format("{:.9g},{:.3g},1e-15,{:.3g},2e-4,3e-3,2e-3,0.01,{:.3g},{:.3g},4e-3,1e-9,0,0,0.12,-1.5,0.21,0,0.87,0.031,{},{},55\n",
                        time, with_rock ? 3e-15 * unit(random) : 0.0, with_rock ? 8e-13 * unit(random) : 0.0, 2e-8 * (0.2 + unit(random)),
                        6e-5 * (0.5 + unit(random)), with_rock ? 14 : 0, with_rock ? rocks : 0);
        const double fluid = 0.165 + 0.01 * unit(random), motion = 0.060, mapping = with_rock ? 0.012 : 0.0, dem = with_rock ? 0.016 : 0.0;
        wall += fluid + motion + mapping + dem + 0.002;
        cost +=
            fmt::format("{:.9g},{:.6g},{:.6g},{},{},{},0.002\n", time, fluid + motion + mapping + dem + 0.002, fluid, motion, mapping, dem);
    }
    std::string event_rows = k_events_header;
    for (const Event& event : events) {
        const auto bin = std::find_if(bins.begin(), bins.end(), [&](const geometry::AxialBin& b) { return b.name == event.bin; });
        event_rows += event_line(event, bin == bins.end() ? 0.0 : bin->z_max - 0.01);
    }
    const fs::path post = directory / "postProcessing";
    write_text(post / "rock/0/events.csv", event_rows);
    write_text(post / "rock/0/fates.csv", fates);
    write_text(post / "rock/0/final.csv", final_table(events, 2.0, positions));
    write_text(post / "rock/0/rejected.csv", "id,time_s,reason\n");
    write_text(post / "outflow/0/contour_velocity.csv", outflow);
    write_text(post / "loads/0/loads.csv", loads);
    write_text(post / "balance/0/balance.csv", balance);
    write_text(post / "cost/0/cost.csv", cost);
    write_text(post / "cost/0/cost.json", cost_summary(steps, wall).dump());
}

}  // namespace cutterflow::postproc::testing
