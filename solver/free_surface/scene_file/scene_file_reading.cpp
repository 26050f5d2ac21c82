#include "solver/free_surface/scene_file/scene_file_reading.hpp"

#include <fmt/format.h>

namespace cutterflow::free_surface {

void SceneFileReading::refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy) {
    mistakes.push_back({where, what, rule, remedy});
}

double SceneFileReading::cell() const {
    return scene.settings.tank.cell;
}

double SceneFileReading::width() const {
    return scene.settings.tank.cells[0] * cell();
}

double SceneFileReading::height() const {
    return scene.settings.tank.cells[2] * cell();
}

double SceneFileReading::depth() const {
    return scene.settings.tank.depth;
}

std::string SceneFileReading::text_of_domain() const {
    if (plane()) return fmt::format("{:g} m x {:g} m", width(), height());
    return fmt::format("{:g} m x {:g} m x {:g} m", width(), depth(), height());
}

bool SceneFileReading::plane() const {
    return scene.settings.tank.plane;
}

void SceneFileReading::refuse_in_plane(const ParameterValues& table, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
        if (plane() && table.has(key))
            refuse(table.where(key), fmt::format("{} in a plane scene", key), "A plane scene is the same all the way across",
                   "Remove it, or set domain.dimensions = \"space\"");
    }
}

Interval SceneFileReading::across(const ParameterValues& table, const std::string& from, const std::string& to) {
    refuse_in_plane(table, {from.c_str(), to.c_str()});
    const Interval part{table.has(from) ? table.number(from) : -k_far, table.has(to) ? table.number(to) : k_far};
    if (part.length() <= 0.0)
        refuse(table.where(from), fmt::format("{} = {:g} m is not below {} = {:g} m", from, part.from, to, part.to),
               "The lower end comes first", "Exchange them");
    return part;
}

std::string SceneFileReading::text_of(const Vec3& place) const {
    if (plane()) return fmt::format("({:g}, {:g}) m", place.x(), place.z());
    return fmt::format("({:g}, {:g}, {:g}) m", place.x(), place.y(), place.z());
}

}  // namespace cutterflow::free_surface
