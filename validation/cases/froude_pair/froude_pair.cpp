/// \file Two studies of one head at lengths 1 and 4, similar after Froude, through the program as a user runs it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr int k_rocks = 1200;
constexpr double k_length_ratio = 4.0;

/// The head with lengths `scale` times those of a ring of 0.1 m.
std::string crown(double scale) {
    return fmt::format(
        "[ring]\nradius_m = {}\ninner_radius_m = {}\nheight_m = {}\n[hub]\nradius_m = {}\ndepth_m = {}\nheight_m = {}\ncap_height_m = {}\n"
        "[blades]\ncount = 4\nwrap_deg = 50\nrake_deg = 15\nthickness_m = {}\ndepth_at_ring_m = {}\ndepth_at_hub_m = {}\ncontour_exponent "
        "= 2\n"
        "[surface]\nedge_length_m = {}\n",
        scale * 0.1, scale * 0.0825, scale * 0.0125, scale * 0.03, scale * 0.06, scale * 0.02, scale * 0.011, scale * 0.0075, scale * 0.015,
        scale * 0.025, scale * 0.0075);
}

/// Speeds grow with the root of the lengths. What has a default is left to it: it is to scale by itself.
std::string study(double scale) {
    return fmt::format(
        "name = \"Froude pair, length {0:g}\"\n[cutter]\nfile = \"cutter.stl\"\nunit = \"m\"\n[rotor]\nspeed_rpm = {1}\n"
        "[suction]\ndischarge_m3_s = {2}\nmouth_radius_m = {3}\ngap_m = {4}\n"
        "[tank]\nradius_m = {5}\nbed_clearance_m = {6}\nheight_m = {7}\n"
        "[run]\nflow_revolutions = 0.15\nmax_revolutions = 1.2\nmax_courant = 1.8\nstop_undecided = 0\n"
        "[rock]\npreset = \"paper\"\n"
        "[[feed]]\ncount = {8}\nazimuth_centre_deg = 0\nazimuth_width_deg = 180\ndepth_to_m = {9}\n[[feed.class]]\ndiameter_m = {10}\n"
        "[[feed]]\ncount = {8}\nazimuth_centre_deg = 180\nazimuth_width_deg = 180\ndepth_to_m = {9}\n[[feed.class]]\ndiameter_m = {10}\n",
        scale, 80.0 / std::sqrt(scale), 0.00375 * std::pow(scale, 2.5), scale * 0.03, scale * 0.01, scale * 0.2, scale * 0.05,
        scale * 0.2125, k_rocks / 2, scale * 0.06, scale * 0.004);
}

nlohmann::json run_at(const Verification& verification, double scale) {
    const auto folder = verification.folder(fmt::format("length_{:g}", scale));
    if (!std::filesystem::exists(folder / "cutter.stl")) {
        write_file(folder / "crown.toml", crown(scale));
        write_file(folder / "study.toml", study(scale));
        run_cutterflow(folder, {"generate-cutter", "crown.toml", "-o", "cutter.stl"});
    }
    return run_study(folder);
}

/// Mean radial outflow of each axial bin over the root of the length.
std::vector<double> outflow(const nlohmann::json& results, double scale) {
    std::vector<double> values;
    for (const nlohmann::json& bin : results.at("outflow").at("bins"))
        if (!bin.at("radial_velocity_mean_m_s").is_null())
            values.push_back(bin.at("radial_velocity_mean_m_s").get<double>() / std::sqrt(scale));
    return values;
}

std::string count(const nlohmann::json& results, const char* fate) {
    return std::to_string(results.at("rock").at("fates").at(fate).at("count").get<int>());
}

void compare_outflow(Verification& verification, const nlohmann::json& small, const nlohmann::json& large) {
    const std::vector<double> a = outflow(small, 1.0), b = outflow(large, k_length_ratio);
    verification.absolute("bins with an outflow at length 4", "-", static_cast<double>(b.size()), static_cast<double>(a.size()), 0.0,
                          {"exact", "as many as at length 1: bin widths follow the ring radius", {}});
    if (a.size() != b.size()) return;
    double largest = 0.0, distance = 0.0;
    ExhibitTable table{
        "Radial outflow, at length 4 over the root of 4", {"bin", "length 1, m/s", "length 4, m/s", "difference over the largest, %"}, {}};
    for (const double value : b) largest = larger(largest, std::abs(value));
    for (std::size_t i = 0; i < a.size(); ++i) {
        distance = larger(distance, std::abs(b[i] - a[i]));
        table.rows.push_back({large.at("outflow").at("bins").at(i).at("name"), fmt::format("{:.4f}", a[i]), fmt::format("{:.4f}", b[i]),
                              fmt::format("{:.2f}", 100.0 * (b[i] - a[i]) / largest)});
    }
    verification.table(table);
    verification.at_most("largest difference of a bin's outflow over the largest outflow", "-", distance / largest, 0.03,
                         {"exact", "mean from 0.15 to 1.2 revolutions; only Reynolds numbers differ, by a factor of 8", {}});
}

void compare_spillage(Verification& verification, const nlohmann::json& small, const nlohmann::json& large) {
    const auto spillage = [](const nlohmann::json& results, const char* key) { return results.at("spillage").at(key).get<double>(); };
    verification.at_most("gap between the bounds of the two spillage ratios", "-",
                         std::max(spillage(small, "ratio_min"), spillage(large, "ratio_min")) -
                             std::min(spillage(small, "ratio_max"), spillage(large, "ratio_max")),
                         0.0, {"exact", "below 0 they overlap; each interval holds what undecided rock may still do", {}});
    ExhibitTable table{
        "Rock at 1.2 revolutions", {"length", "placed", "spilled", "sucked up", "in the cutter", "never entered", "spillage ratio"}, {}};
    for (const auto& [results, scale] : {std::pair(&small, 1.0), std::pair(&large, k_length_ratio)})
        table.rows.push_back({fmt::format("{:g}", scale), std::to_string(results->at("rock").at("placed").get<int>()),
                              count(*results, "spilled"), count(*results, "sucked_up"), count(*results, "in_cutter"),
                              count(*results, "never_entered"),
                              fmt::format("{:.3f} to {:.3f}", spillage(*results, "ratio_min"), spillage(*results, "ratio_max"))});
    verification.table(table);
    const auto share = [](const nlohmann::json& results) {
        const double placed = results.at("rock").at("placed").get<double>();
        return results.at("rock").at("fates").at("spilled").at("count").get<double>() / placed;
    };
    verification.at_least(
        "spilled over placed at length 1", "-", share(small), 0.1,
        {"exact", "where no rock is spilled, both ratios are 0 and so is the gap between their bounds: nothing is compared", {}});
    const double p = 0.5 * (spillage(small, "ratio") + spillage(large, "ratio"));
    verification.absolute(
        "spilled over decided at length 4", "-", spillage(large, "ratio"), spillage(small, "ratio"), 0.02,
        {"exact",
         fmt::format("the reference is length 1; two batches of {} rocks differ by {:.3f} (standard deviation) by chance alone", k_rocks,
                     std::sqrt(2.0 * p * (1.0 - p) / k_rocks)),
         {}});
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    const nlohmann::json small = run_at(verification, 1.0), large = run_at(verification, k_length_ratio);
    compare_spillage(verification, small, large);
    compare_outflow(verification, small, large);
    const auto cells = [](const nlohmann::json& results) { return results.at("cost").at("cells").get<double>(); };
    const auto steps = [](const nlohmann::json& results) { return results.at("cost").at("steps").get<double>(); };
    verification.absolute("cells at length 4", "-", cells(large), cells(small), 0.005 * cells(small),
                          {"exact", "the reference is length 1; the same mesh but for rounding in snappyHexMesh", {}});
    verification.relative("steps at length 4", "-", steps(large), steps(small), 0.05, {"exact", "the reference is length 1", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
