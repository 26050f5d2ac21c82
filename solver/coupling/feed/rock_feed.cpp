#include "solver/coupling/feed/rock_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"

namespace cutterflow::coupling {
namespace {

const std::vector<std::string> k_required{"id", "time_s", "x_m", "y_m", "z_m", "diameter_m", "density_kg_m3"};
const std::vector<std::string> k_velocity{"vx_m_s", "vy_m_s", "vz_m_s"};

void check_row(const CsvTable& table, std::size_t row, std::map<double, std::string>& seen, std::vector<Mistake>& mistakes) {
    const std::string where = table.where(row);
    const double id = table.at(row, "id");
    if (!(id > 0.0) || id != std::floor(id) || id > std::numeric_limits<int>::max())
        mistakes.push_back({where, fmt::format("id = {}", id), "Ids are whole numbers above 0", "Number the rocks from 1"});
    else if (const auto [first, fresh] = seen.emplace(id, where); !fresh)
        mistakes.push_back(
            {where, fmt::format("id = {} stands in {} too", id, first->second), "Ids are unique", "Give the rock another id"});
    for (const char* column : {"diameter_m", "density_kg_m3"})
        if (!(table.at(row, column) > 0.0))
            mistakes.push_back({where, fmt::format("{} = {}", column, table.at(row, column)), "It must be above 0", "Correct the field"});
    if (table.at(row, "time_s") < 0.0)
        mistakes.push_back({where, fmt::format("time_s = {}", table.at(row, "time_s")), "It must not be negative", "Correct the field"});
}

Vec3 place_of(const CsvTable& table, std::size_t row) {
    return {table.at(row, "x_m"), table.at(row, "y_m"), table.at(row, "z_m")};
}

void check_place(const CsvTable& table, std::size_t row, const std::function<bool(const Vec3&)>& in_domain,
                 std::vector<Mistake>& mistakes) {
    const Vec3 place = place_of(table, row);
    if (in_domain(place)) return;
    mistakes.push_back(
        {table.where(row),
         fmt::format("rock {} at ({:.6g} {:.6g} {:.6g}) m lies outside rock.domain", table.at(row, "id"), place[0], place[1], place[2]),
         "Rock leaves the run outside its domain", "Correct the place, or enlarge rock.domain within the mesh"});
}

FeedRock rock_of(const CsvTable& table, std::size_t row, bool with_velocity) {
    FeedRock rock;
    rock.id = static_cast<int>(table.at(row, "id"));
    rock.time = table.at(row, "time_s");
    rock.position = place_of(table, row);
    rock.diameter = table.at(row, "diameter_m");
    rock.density = table.at(row, "density_kg_m3");
    if (with_velocity) rock.velocity = Vec3(table.at(row, "vx_m_s"), table.at(row, "vy_m_s"), table.at(row, "vz_m_s"));
    return rock;
}

}  // namespace

std::vector<FeedRock> read_rock_feed(const std::filesystem::path& file, const std::function<bool(const Vec3&)>& in_domain) {
    std::vector<Mistake> mistakes;
    const CsvTable table(file, k_required, k_velocity, mistakes);
    const auto velocities = std::count_if(k_velocity.begin(), k_velocity.end(), [&](const std::string& name) { return table.has(name); });
    if (velocities != 0 && velocities != 3)
        mistakes.push_back({file.string() + ":1", fmt::format("{} of the 3 velocity columns are there", velocities),
                            "Velocity is vx_m_s, vy_m_s and vz_m_s, or none of them (the local fluid velocity)", "Add or remove columns"});
    const bool complete = std::all_of(k_required.begin(), k_required.end(), [&](const std::string& name) { return table.has(name); });
    if (!complete) throw UserError(mistakes);

    std::map<double, std::string> seen;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        check_row(table, row, seen, mistakes);
        if (in_domain) check_place(table, row, in_domain, mistakes);
    }
    if (!mistakes.empty()) throw UserError(mistakes);

    std::vector<FeedRock> rocks;
    for (std::size_t row = 0; row < table.rows(); ++row) rocks.push_back(rock_of(table, row, velocities == 3));
    std::sort(rocks.begin(), rocks.end(),
              [](const FeedRock& a, const FeedRock& b) { return a.time != b.time ? a.time < b.time : a.id < b.id; });
    return rocks;
}

}  // namespace cutterflow::coupling
