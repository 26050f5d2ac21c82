#include "solver/observe/velocity/velocity_tables.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::coupling {
namespace {

using Text = std::back_insert_iterator<std::string>;

/// ",a,b,c", or three empty fields.
void put(Text out, const Vec3* v) {
    if (v != nullptr)
        fmt::format_to(out, ",{:.7g},{:.7g},{:.7g}", (*v)[0], (*v)[1], (*v)[2]);
    else
        fmt::format_to(out, ",,,");
}

void put(Text out, const WeightedVelocity& bin, double angle) {
    const Vec3 mean = bin.weight > 0.0 ? bin.mean() : Vec3::Zero();
    put(out, bin.weight > 0.0 ? &mean : nullptr);
    fmt::format_to(out, ",{:.4g}\n", bin.weight / angle);
}

std::string mean_table(const VelocitySet& set, double from, double to) {
    std::string text =
        "point,x_m,y_m,z_m,rotating,u_radial_m_s,u_tangential_m_s,u_axial_m_s,se_radial_m_s,se_tangential_m_s,se_axial_m_s,samples,"
        "dry_samples,revolutions,from_s,to_s\n";
    const Text out(text);
    const VelocityStatistics& statistics = set.statistics;
    for (std::size_t i = 0; i < set.points.size(); ++i) {
        const SamplePoint& point = set.points[i];
        const WeightedVelocity average = statistics.average(i);
        const Vec3 mean = average.weight > 0.0 ? average.mean() : Vec3::Zero();
        const std::optional<Vec3> error = statistics.standard_error(i);
        fmt::format_to(out, "{},{:.9g},{:.9g},{:.9g},{}", i + 1, point.place[0], point.place[1], point.place[2], point.rotating ? 1 : 0);
        put(out, average.weight > 0.0 ? &mean : nullptr);
        put(out, error ? &*error : nullptr);
        fmt::format_to(out, ",{},{},{},{:.9g},{:.9g}\n", statistics.samples(), statistics.dry_samples(i), statistics.whole_revolutions(),
                       from, to);
    }
    return text;
}

std::string revolution_table(const VelocitySet& set) {
    std::string text = "revolution,point,u_radial_m_s,u_tangential_m_s,u_axial_m_s,wet_share\n";
    const auto whole = static_cast<std::size_t>(set.statistics.whole_revolutions());
    for (std::size_t n = 0; n < whole; ++n)
        for (std::size_t i = 0; i < set.points.size(); ++i) {
            fmt::format_to(Text(text), "{},{}", n + 1, i + 1);
            put(Text(text), set.statistics.revolution(n, i), 2.0 * k_pi);
        }
    return text;
}

std::string phase_table(const VelocitySet& set, double sense) {
    std::string text = "phase_deg,point,u_radial_m_s,u_tangential_m_s,u_axial_m_s,weight_rev\n";
    const VelocityStatistics& statistics = set.statistics;
    for (int bin = 0; bin < statistics.phases(); ++bin)
        for (std::size_t i = 0; i < set.points.size(); ++i) {
            const double middle = sense * statistics.period(i) * 180.0 / k_pi * (bin + 0.5) / statistics.phases();
            fmt::format_to(Text(text), "{:.6g},{}", middle, i + 1);
            put(Text(text), statistics.phase(bin, i), 2.0 * k_pi);
        }
    return text;
}

}  // namespace

void write_velocity_tables(const std::filesystem::path& folder, const VelocitySets& sets, double time) {
    const double to = std::max(time, sets.start_time());
    for (const VelocitySet& set : sets.sets()) {
        write_file(folder / (set.name + ".csv"), mean_table(set, sets.start_time(), to));
        if (set.statistics.phases() == 0) continue;
        write_file(folder / (set.name + "_revolutions.csv"), revolution_table(set));
        write_file(folder / (set.name + "_phases.csv"), phase_table(set, sets.angular_speed() < 0.0 ? -1.0 : 1.0));
    }
}

}  // namespace cutterflow::coupling
