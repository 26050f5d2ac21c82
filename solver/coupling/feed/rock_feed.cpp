#include "solver/coupling/feed/rock_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/csv_table.hpp"

namespace cutterflow::coupling {
namespace {

const std::vector<std::string> k_required{"id", "time_s", "x_m", "y_m", "z_m", "diameter_m", "density_kg_m3"};
const std::vector<std::string> k_velocity{"vx_m_s", "vy_m_s", "vz_m_s"};
constexpr const char* k_place = "place";
constexpr const char* k_shape = "shape";
const std::vector<std::string> k_orientation{"qw", "qx", "qy", "qz"};
const std::vector<std::string> k_optional{"vx_m_s", "vy_m_s", "vz_m_s", k_place, "qw", "qx", "qy", "qz"};
constexpr double k_unit_length = 1e-6;  // deviation of a quaternion's length from 1 that is rounding

/// Number of the shape of that name.
std::optional<int> index_of(const std::vector<ClumpShape>& shapes, const std::string& name) {
    const auto found = std::find_if(shapes.begin(), shapes.end(), [&](const ClumpShape& shape) { return shape.name == name; });
    if (found == shapes.end()) return std::nullopt;
    return static_cast<int>(found - shapes.begin());
}

bool has_orientation(const CsvTable& table) {
    return std::all_of(k_orientation.begin(), k_orientation.end(), [&](const std::string& name) { return table.has(name); });
}

Eigen::Quaterniond quaternion_of(const CsvTable& table, std::size_t row) {
    return {table.at(row, k_orientation[0]), table.at(row, k_orientation[1]), table.at(row, k_orientation[2]),
            table.at(row, k_orientation[3])};
}

/// Whether a row is a further place of the rock in the row before it.
bool is_further_place(const CsvTable& table, std::size_t row) {
    return table.has(k_place) && row > 0 && table.at(row, k_place) != 0.0 && table.at(row, "id") == table.at(row - 1, "id");
}

void check_further_place(const CsvTable& table, std::size_t row, std::vector<Mistake>& mistakes) {
    if (const double place = table.at(row, k_place), before = table.at(row - 1, k_place); place != before + 1.0)
        mistakes.push_back({table.where(row), fmt::format("place = {} follows {} of rock {}", place, before, table.at(row, "id")),
                            "The places of a rock are numbered from 0", "Correct the field"});
    if (table.has(k_shape) && table.word(row, k_shape) != table.word(row - 1, k_shape))
        mistakes.push_back({table.where(row),
                            fmt::format("shape = {} after {} in the row before", table.word(row, k_shape), table.word(row - 1, k_shape)),
                            "Rows of one rock differ only in place and velocity", "Correct the field, or give the rock another id"});
    for (const char* column : {"time_s", "diameter_m", "density_kg_m3"})
        if (const double value = table.at(row, column), first = table.at(row - 1, column); value != first)
            mistakes.push_back({table.where(row), fmt::format("{} = {} after {} in the row before", column, value, first),
                                "Rows of one rock differ only in place and velocity", "Correct the field, or give the rock another id"});
}

void check_row(const CsvTable& table, std::size_t row, std::map<double, std::string>& seen, std::vector<Mistake>& mistakes) {
    if (is_further_place(table, row)) return check_further_place(table, row, mistakes);
    const std::string where = table.where(row);
    const double id = table.at(row, "id");
    if (!(id > 0.0) || id != std::floor(id) || id > std::numeric_limits<int>::max())
        mistakes.push_back({where, fmt::format("id = {}", id), "Ids are whole numbers above 0", "Number the rocks from 1"});
    else if (const auto [first, fresh] = seen.emplace(id, where); !fresh)
        mistakes.push_back(
            {where, fmt::format("id = {} stands in {} too", id, first->second), "Ids are unique", "Give the rock another id"});
    if (table.has(k_place) && table.at(row, k_place) != 0.0)
        mistakes.push_back({where, fmt::format("place = {} is the first row of rock {}", table.at(row, k_place), id),
                            "The places of a rock are numbered from 0", "Correct the field"});
    for (const char* column : {"diameter_m", "density_kg_m3"})
        if (!(table.at(row, column) > 0.0))
            mistakes.push_back({where, fmt::format("{} = {}", column, table.at(row, column)), "It must be above 0", "Correct the field"});
    if (table.at(row, "time_s") < 0.0)
        mistakes.push_back({where, fmt::format("time_s = {}", table.at(row, "time_s")), "It must not be negative", "Correct the field"});
}

/// Adds a mistake when the row's shape or orientation cannot be.
void check_shape(const CsvTable& table, std::size_t row, const std::vector<ClumpShape>& shapes, std::vector<Mistake>& mistakes) {
    if (table.has(k_shape) && !table.word(row, k_shape).empty() && !index_of(shapes, table.word(row, k_shape))) {
        std::vector<std::string> names;
        for (const ClumpShape& shape : shapes) names.push_back(shape.name);
        mistakes.push_back({table.where(row), fmt::format("shape = {} is not known", table.word(row, k_shape)),
                            names.empty() ? "rock.shapes of constant/couplingProperties names the shapes; there is none"
                                          : fmt::format("Shapes of rock.shapes are {}", fmt::join(names, ", ")),
                            "Correct the field, or add the shape; an empty field is a sphere"});
    }
    if (!has_orientation(table)) return;
    const double length = quaternion_of(table, row).norm();
    if (std::abs(length - 1.0) > k_unit_length)
        mistakes.push_back({table.where(row), fmt::format("qw, qx, qy, qz have the length {:.9g}", length),
                            "An orientation is a quaternion of length 1", "Divide by its length"});
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

std::optional<Vec3> velocity_of(const CsvTable& table, std::size_t row) {
    if (!table.has(k_velocity.front())) return std::nullopt;
    return Vec3(table.at(row, k_velocity[0]), table.at(row, k_velocity[1]), table.at(row, k_velocity[2]));
}

FeedRock rock_of(const CsvTable& table, std::size_t row, const std::vector<ClumpShape>& shapes) {
    FeedRock rock;
    rock.id = static_cast<int>(table.at(row, "id"));
    rock.time = table.at(row, "time_s");
    rock.position = place_of(table, row);
    rock.diameter = table.at(row, "diameter_m");
    rock.density = table.at(row, "density_kg_m3");
    rock.velocity = velocity_of(table, row);
    if (!table.has(k_shape) || table.word(row, k_shape).empty()) return rock;
    rock.shape = *index_of(shapes, table.word(row, k_shape));
    rock.orientation = has_orientation(table) ? quaternion_of(table, row).normalized() : orientation_of_id(rock.id);
    return rock;
}

/// All columns of `group` or none may be there.
void require_whole_group(const CsvTable& table, const std::string& file, const std::vector<std::string>& group, const std::string& what,
                         const std::string& rule, std::vector<Mistake>& mistakes) {
    const auto count =
        static_cast<std::size_t>(std::count_if(group.begin(), group.end(), [&](const std::string& name) { return table.has(name); }));
    if (count != 0 && count != group.size())
        mistakes.push_back(
            {file + ":1", fmt::format("{} of the {} {} columns are there", count, group.size(), what), rule, "Add or remove columns"});
}

}  // namespace

std::vector<FeedRock> read_rock_feed(const std::filesystem::path& file, const std::function<bool(const Vec3&)>& in_domain,
                                     const std::vector<ClumpShape>& shapes) {
    std::vector<Mistake> mistakes;
    const CsvTable table(file, k_required, k_optional, mistakes, {k_shape});
    require_whole_group(table, file.string(), k_velocity, "velocity",
                        "Velocity is vx_m_s, vy_m_s and vz_m_s, or none of them (the local fluid velocity)", mistakes);
    require_whole_group(table, file.string(), k_orientation, "orientation",
                        "Orientation is qw, qx, qy and qz, or none of them (drawn from the id)", mistakes);
    const bool complete = std::all_of(k_required.begin(), k_required.end(), [&](const std::string& name) { return table.has(name); });
    if (!complete) throw UserError(mistakes);

    std::map<double, std::string> seen;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        check_row(table, row, seen, mistakes);
        check_shape(table, row, shapes, mistakes);
        if (in_domain) check_place(table, row, in_domain, mistakes);
    }
    if (!mistakes.empty()) throw UserError(mistakes);

    std::vector<FeedRock> rocks;
    for (std::size_t row = 0; row < table.rows(); ++row)
        if (is_further_place(table, row))
            rocks.back().elsewhere.push_back({place_of(table, row), velocity_of(table, row)});
        else
            rocks.push_back(rock_of(table, row, shapes));
    std::sort(rocks.begin(), rocks.end(),
              [](const FeedRock& a, const FeedRock& b) { return a.time != b.time ? a.time < b.time : a.id < b.id; });
    return rocks;
}

/// Three numbers from 0 to 1 give the quaternion [Shoemake1992].
Eigen::Quaterniond orientation_of_id(int id) {
    std::mt19937 random(static_cast<std::mt19937::result_type>(id));
    const auto draw = [&] { return (static_cast<double>(random()) + 0.5) / (static_cast<double>(std::mt19937::max()) + 1.0); };
    const double share = draw(), a = 2.0 * k_pi * draw(), b = 2.0 * k_pi * draw();
    const double u = std::sqrt(1.0 - share), v = std::sqrt(share);
    return {v * std::cos(b), u * std::sin(a), u * std::cos(a), v * std::sin(b)};
}

Rocks as_listed(const std::vector<FeedRock>& feed) {
    Rocks rocks;
    for (const FeedRock& rock : feed)
        rocks.append({rock.id, rock.position, rock.velocity.value_or(Vec3::Zero()), Vec3::Zero(), rock.diameter, rock.density, rock.shape,
                      rock.orientation});
    return rocks;
}

Rocks rocks_of(const std::vector<FeedRock>& feed) {
    std::vector<FeedRock> sorted = feed;
    std::sort(sorted.begin(), sorted.end(), [](const FeedRock& a, const FeedRock& b) { return a.id < b.id; });
    return as_listed(sorted);
}

}  // namespace cutterflow::coupling
