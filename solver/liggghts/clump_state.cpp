#include "solver/liggghts/clump_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr std::size_t k_numbers_of_body = 18;

nlohmann::json of_shapes(const std::vector<coupling::ClumpShape>& shapes) {
    nlohmann::json list = nlohmann::json::array();
    for (const coupling::ClumpShape& shape : shapes) {
        std::vector<double> spheres;
        for (const geometry::Ball& ball : shape.clump.balls)
            spheres.insert(spheres.end(), {ball.centre.x(), ball.centre.y(), ball.centre.z(), ball.radius});
        list.push_back({{"name", shape.name}, {"spheres", spheres}});
    }
    return list;
}

std::vector<double> numbers_of(const RigidBody& body) {
    const coupling::Rock& rock = body.state;
    std::vector<double> numbers{static_cast<double>(rock.id), static_cast<double>(rock.shape), rock.diameter, rock.density};
    for (const Vec3& vector : {rock.position, rock.velocity, body.angular_momentum})
        numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
    const Eigen::Quaterniond& q = rock.orientation;
    numbers.insert(numbers.end(), {q.w(), q.x(), q.y(), q.z(), body.frozen ? 1.0 : 0.0});
    return numbers;
}

}  // namespace

nlohmann::json clump_state(const std::vector<coupling::ClumpShape>& shapes, const RigidBodies& bodies) {
    nlohmann::json list = nlohmann::json::array();
    for (const RigidBody& body : bodies.all()) list.push_back(numbers_of(body));
    return {{"shapes", of_shapes(shapes)}, {"bodies", list}};
}

void require_same_clumps(const std::vector<coupling::ClumpShape>& shapes, const nlohmann::json& written, const std::string& file) {
    const nlohmann::json had = written.contains("shapes") ? written.at("shapes") : nlohmann::json::array();
    if (had == of_shapes(shapes)) return;
    throw UserError({{file, fmt::format("the checkpoint was written with {} other shapes of rock", had.size()),
                      fmt::format("This run has {} shapes; the spheres of rock in the checkpoint are those of its shapes", shapes.size()),
                      "Resume with the shapes of the checkpoint, or start anew"}});
}

void restore_bodies(const nlohmann::json& written, std::size_t shapes, RigidBodies& bodies) {
    const char* const remedy = "Remove this checkpoint folder; the run then resumes from the one before";
    if (!written.contains("bodies") || !written.at("bodies").is_array())
        throw UserError("the checkpoint has no list of clumps", "A run with shapes of rock keeps one", remedy);
    std::vector<coupling::Rock> rocks;
    std::vector<Vec3> angular_momenta;
    std::vector<int> frozen;
    for (const nlohmann::json& entry : written.at("bodies")) {
        const bool is_whole = entry.is_array() && entry.size() == k_numbers_of_body &&
                              std::all_of(entry.begin(), entry.end(), [](const nlohmann::json& value) { return value.is_number(); });
        const auto counts = [&](std::size_t number, double from, double below) {
            const double value = entry[number].get<double>();
            return value >= from && value < below && value == std::floor(value);
        };
        const bool fits = is_whole && counts(0, 1.0, std::numeric_limits<int>::max()) && counts(1, 0.0, static_cast<double>(shapes));
        if (!fits)
            throw UserError(fmt::format("a clump of the checkpoint is {}", entry.dump()),
                            fmt::format("It is {} numbers, the first one of the rock, the second one of its shape", k_numbers_of_body),
                            remedy);
        const auto numbers = entry.get<std::vector<double>>();
        const double* at = numbers.data();
        coupling::Rock rock;
        rock.id = static_cast<int>(at[0]);
        rock.shape = static_cast<int>(at[1]);
        rock.diameter = at[2];
        rock.density = at[3];
        rock.position = Vec3(at + 4);
        rock.velocity = Vec3(at + 7);
        rock.orientation = Eigen::Quaterniond(at[13], at[14], at[15], at[16]);
        rocks.push_back(rock);
        angular_momenta.emplace_back(at + 10);
        if (at[17] != 0.0) frozen.push_back(rock.id);
    }
    bodies.add(rocks, angular_momenta);
    std::sort(frozen.begin(), frozen.end());
    bodies.set_frozen(frozen, true);
}

}  // namespace cutterflow::liggghts
