/// 24 parametric heads through `cutterflow mesh` at preset draft: a table of gates, cells and core seconds, and exit code 4 when a head
/// fails a gate or has a quarter more or fewer cells than predicted. Usage: mesh_study DIRECTORY; a head that is meshed already is only
/// read, so that an interrupted study resumes.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/io/write_stl.hpp"
#include "validation/studies/heads/head_family.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int k_heads = 24;
constexpr double k_cells_error = 0.25;

/// The model cutter's operating point, 60 rpm and 0.12 m3/s at a ring radius of 0.4 m, scaled by Froude's law.
std::string study_text(const geometry::CrownParameters& head) {
    const double scale = head.ring_radius / 0.4;
    return fmt::format(
        "[cutter]\nfile = \"cutter.stl\"\nunit = \"m\"\n[rotor]\nspeed_rpm = {:.6g}\ndirection = \"{}\"\n"
        "[suction]\ndischarge_m3_s = {:.6g}\n[mesh]\npreset = \"draft\"\n",
        60.0 / std::sqrt(scale), head.blade_wrap > 0.0 ? "right_handed" : "left_handed", 0.12 * std::pow(scale, 2.5));
}

/// Runs `cutterflow mesh` in a folder of the head's own. Its exit code is that of the check; mesh.json tells the rest.
int mesh_head(const geometry::CrownParameters& head, const fs::path& folder) {
    fs::create_directories(folder);
    if (!fs::exists(folder / "cutter.stl")) geometry::write_stl(geometry::generate_crown_cutter(head), folder / "cutter.stl");
    write_file(folder / "study.toml", study_text(head));
    return run_child({{(installation().programs / "cutterflow").string(), "mesh", "study.toml", "-o", "run"},
                      folder,
                      folder / "log.cutterflow",
                      {}})
        .exit_code;
}

struct HeadMesh {
    int exit_code = 0;
    json mesh;

    bool meshed() const { return !mesh.is_null(); }
    double cells() const { return mesh.at("cells").get<double>(); }
    double cells_error() const { return mesh.at("predicted_cells").get<double>() / cells() - 1.0; }
    double time_ratio() const { return mesh.at("core_s").get<double>() / mesh.at("program_core_s").at("snappyHexMesh").get<double>(); }
    bool passed() const { return exit_code == 0 && meshed() && std::abs(cells_error()) <= k_cells_error; }
};

HeadMesh study_head(int index, const fs::path& folder) {
    HeadMesh result;
    result.exit_code = mesh_head(family_head(index), folder);
    const fs::path report = folder / "run" / names::mesh_report;
    if (fs::exists(report)) result.mesh = json::parse(read_file(report));
    return result;
}

double steel_error(const json& mesh) {
    for (const json& gate : mesh.at("gates"))
        if (gate.at("name").get<std::string>().find("steel") != std::string::npos) return gate.at("value").get<double>();
    return NAN;
}

void print_header() {
    std::cout << fmt::format("{:>3} {:>6} {:>6} {:>5} {:>5} {:>6} {:>7} {:>9} {:>6} {:>9} {:>5} {:>15} {:>6} {:>7} {:>8} {:>8} {:>6}\n",
                             "no", "R, m", "blades", "wrap", "picks", "t/R, %", "cells", "predicted", "err, %", "nonortho", "skew",
                             "weights", "steel%", "retries", "snappy,s", "total, s", "ratio");
}

void print_row(int index, const HeadMesh& result) {
    const geometry::CrownParameters head = family_head(index);
    std::cout << fmt::format("{:>3} {:>6.3f} {:>6} {:>5.0f} {:>5} {:>6.1f} ", index + 1, head.ring_radius, head.blade_count,
                             head.blade_wrap * 180.0 / k_pi, head.picks_per_blade,
                             100.0 * std::min(head.blade_thickness, head.blade_thickness_at_hub) / head.ring_radius);
    if (!result.meshed()) {
        std::cout << fmt::format("no mesh: exit code {}", result.exit_code) << std::endl;
        return;
    }
    const json& m = result.mesh;
    std::cout << fmt::format("{:>7} {:>9} {:>6.1f} {:>9.1f} {:>5.2f} {:>7.4f}-{:>7.4f} {:>6.1f} {:>7} {:>8.1f} {:>8.1f} {:>6.2f} {}",
                             result.cells(), m.at("predicted_cells").get<double>(), 100.0 * result.cells_error(),
                             m.at("non_orthogonality_max_deg").get<double>(), m.at("skewness_max").get<double>(),
                             m.at("interface_weight_min").get<double>(), m.at("interface_weight_max").get<double>(), 100.0 * steel_error(m),
                             m.at("retries").size(), m.at("program_core_s").at("snappyHexMesh").get<double>(), m.at("wall_s").get<double>(),
                             result.time_ratio(), result.passed() ? "passed" : "FAILED")
              << std::endl;
    for (const json& retry : m.at("retries"))
        std::cout << fmt::format("      tried again with {}: {} had failed", retry.at("change").get<std::string>(),
                                 retry.at("failed_gate").get<std::string>())
                  << std::endl;
}

int study(const fs::path& directory) {
    int passed = 0;
    double largest_error = 0.0, largest_ratio = 0.0;
    print_header();
    for (int i = 0; i < k_heads; ++i) {
        const HeadMesh result = study_head(i, directory / fmt::format("head_{:02}", i + 1));
        print_row(i, result);
        passed += result.passed() ? 1 : 0;
        if (!result.meshed()) continue;
        largest_error = std::max(largest_error, std::abs(result.cells_error()));
        largest_ratio = std::max(largest_ratio, result.time_ratio());
    }
    std::cout << fmt::format("{} of {} passed; cells predicted within {:.1f} %; at most {:.2f} times snappyHexMesh's own core time\n",
                             passed, k_heads, 100.0 * largest_error, largest_ratio);
    return passed == k_heads ? 0 : 4;
}

}  // namespace
}  // namespace cutterflow::validation

int main(int argc, char* argv[]) try {
    if (argc != 2) {
        std::cerr << "usage: mesh_study DIRECTORY\n";
        return 2;
    }
    return cutterflow::validation::study(std::filesystem::absolute(argv[1]));
} catch (const cutterflow::Failure& failure) {
    std::cerr << failure.what() << '\n';
    return static_cast<int>(failure.code());
}
