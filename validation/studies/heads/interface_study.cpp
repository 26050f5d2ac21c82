/// Weights of the sliding interface of a run's mesh at every 5 degrees of a whole turn, and exit code 4 when one is outside 0.98 to 1.02.
/// Usage: interface_study RUN_DIRECTORY
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "meshing/cutter/build_mesh.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int k_step_deg = 5;
constexpr double k_weight_min = 0.98, k_weight_max = 1.02;

/// cutterMeshProbe on a case of its own that refers to the run's mesh.
json probe(const fs::path& run, const std::vector<double>& angles) {
    const fs::path scratch = fs::temp_directory_path() / fmt::format("interface_study_{}", ::getpid());
    fs::create_directories(scratch / "constant");
    fs::create_directory_symlink(run / "constant" / "polyMesh", scratch / "constant" / "polyMesh");
    fs::copy(run / meshing::k_mesh_case / "system", scratch / "system", fs::copy_options::recursive);
    require_child(meshing::foam_command(scratch, (installation().programs / "cutterMeshProbe").string(),
                                        {"-angles", fmt::format("({})", fmt::join(angles, " ")), "-output", "probe.json"}));
    json result = json::parse(read_file(scratch / "probe.json"));
    fs::remove_all(scratch);
    return result;
}

int study(const fs::path& run) {
    std::vector<double> angles;
    for (int degrees = 0; degrees < 360; degrees += k_step_deg) angles.push_back(degrees * k_pi / 180.0);
    const json result = probe(run, angles);
    std::cout << fmt::format("{} cells\n{:>6} {:>10} {:>10} {:>10} {:>10}\n", result.at("cells").get<std::size_t>(), "deg", "rotor min",
                             "rotor max", "stator min", "stator max");
    double low = 1.0, high = 1.0;
    for (const json& position : result.at("interface")) {
        std::cout << fmt::format("{:>6.0f}", position.at("angle_rad").get<double>() * 180.0 / k_pi);
        for (const char* side : {"rotor", "stator"}) {
            const double least = position.at(side).at("min").get<double>();
            const double most = position.at(side).at("max").get<double>();
            std::cout << fmt::format(" {:>10.5f} {:>10.5f}", least, most);
            low = std::min(low, least);
            high = std::max(high, most);
        }
        std::cout << '\n';
    }
    std::cout << fmt::format("weights {:.5f} to {:.5f} at {} angles\n", low, high, angles.size());
    return low >= k_weight_min && high <= k_weight_max ? 0 : 4;
}

}  // namespace
}  // namespace cutterflow::validation

int main(int argc, char* argv[]) try {
    if (argc != 2) {
        std::cerr << "usage: interface_study RUN_DIRECTORY\n";
        return 2;
    }
    return cutterflow::validation::study(std::filesystem::absolute(argv[1]));
} catch (const cutterflow::Failure& failure) {
    std::cerr << failure.what() << '\n';
    return static_cast<int>(failure.code());
}
