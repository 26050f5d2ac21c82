#include "solver/liggghts/settings_check.hpp"

#include <fmt/format.h>

#include "geometry/base/mistakes.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr const char* k_where = "constant/couplingProperties";
constexpr std::size_t k_longest_path = 250;  // LIGGGHTS copies paths into buffers of 256 characters

}  // namespace

std::vector<Mistake> check_settings(const coupling::DemSettings& settings) {
    Mistakes mistakes(k_where);
    mistakes.add(coupling::check_settings(settings, k_where));
    for (const coupling::WallSettings& wall : settings.walls) {
        const std::string path = std::filesystem::absolute(wall.file).string();
        mistakes.require(path.size() <= k_longest_path && path.find('"') == std::string::npos,
                         fmt::format("wall {}: path {}", wall.name, path),
                         fmt::format("LIGGGHTS reads paths of at most {} characters without quotation marks", k_longest_path),
                         "Move the run to a shorter path");
    }
    return mistakes.take();
}

}  // namespace cutterflow::liggghts
