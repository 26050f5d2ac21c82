#include "solver/free_surface/body_list.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_largest_id = 1e9;

/// The id of a line; 0 when it is none, which is a mistake, as is one that an earlier line has.
int read_id(const CsvTable& table, std::size_t row, std::map<int, std::string>& seen, std::vector<Mistake>& mistakes) {
    const double value = table.at(row, "id");
    if (value < 1.0 || value > k_largest_id || value != std::floor(value)) {
        mistakes.push_back({table.where(row), fmt::format("id = {:g}", value), "An id is a whole number from 1 on", "Correct the field"});
        return 0;
    }
    const int id = static_cast<int>(value);
    const auto [first, fresh] = seen.emplace(id, table.where(row));
    if (fresh) return id;
    mistakes.push_back(
        {table.where(row), fmt::format("id {} is also in {}", id, first->second), "Every body has an id of its own", "Change one of them"});
    return 0;
}

}  // namespace

std::vector<ListedBody> read_body_list(const std::filesystem::path& file, std::vector<Mistake>& mistakes) {
    if (!std::filesystem::is_regular_file(file)) {
        mistakes.push_back({"", fmt::format("There is no file {}", std::filesystem::absolute(file).lexically_normal().string()),
                            "bodies.file names a CSV file with the columns x_m,z_m",
                            "Check the name; the path is relative to the study file"});
        return {};
    }
    const std::size_t before = mistakes.size();
    const CsvTable table(file, {"x_m", "z_m"}, {"y_m", "vx_m_s", "vy_m_s", "vz_m_s", "spin_rad_s", "id"}, mistakes);
    if (mistakes.size() > before) return {};
    if (table.rows() == 0)
        mistakes.push_back({file.string(), "the file has no bodies", "One line below the header is one body", "Add lines"});
    const auto number = [&](std::size_t row, const char* column) { return table.has(column) ? table.at(row, column) : 0.0; };
    std::map<int, std::string> seen;
    std::vector<ListedBody> bodies;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        ListedBody body;
        body.x = table.at(row, "x_m");
        body.z = table.at(row, "z_m");
        if (table.has("y_m")) body.y = table.at(row, "y_m");
        body.velocity = Vec3(number(row, "vx_m_s"), number(row, "vy_m_s"), number(row, "vz_m_s"));
        body.moves_across = table.has("vy_m_s");
        body.spin = number(row, "spin_rad_s");
        if (table.has("id")) body.id = read_id(table, row, seen, mistakes);
        body.where = table.where(row);
        bodies.push_back(std::move(body));
    }
    return bodies;
}

}  // namespace cutterflow::free_surface
