#pragma once
/// \file What the readers of a scene's tables share: the file's values, the scene as far as it is read, and the mistakes.
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::free_surface {

inline constexpr double k_far = 1e3;         // [m]: solids reach across the tank
inline constexpr double k_tolerance = 1e-9;  // [m]

/// A reading in progress.
struct SceneFileReading {
    const ParameterValues& values;
    std::filesystem::path folder;  ///< files of the scene are named relative to it
    Scene scene{};
    std::vector<Mistake> mistakes{};

    void refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy);

    double cell() const;    ///< [m]
    double width() const;   ///< of the tank [m]
    double height() const;  ///< [m]
    double depth() const;   ///< [m]
    std::string text_of_domain() const;
    bool plane() const;

    /// Keys that a plane scene has no use for.
    void refuse_in_plane(const ParameterValues& table, std::initializer_list<const char*> keys);

    /// From where to where across; the whole tank without the keys.
    Interval across(const ParameterValues& table, const std::string& from, const std::string& to);

    /// A place in the words of the scene: x and z in a plane one.
    std::string text_of(const Vec3& place) const;
};

/// Tables [[solid]].
void read_solids(SceneFileReading& reading);
/// Tables [[bodies]], by id. \pre the solids are read
void read_all_bodies(SceneFileReading& reading);

/// A word of `solid.kind` and the keys of [[solid]] that it has.
struct SolidKind {
    const char* name;
    std::vector<std::string> keys;
};
const std::vector<SolidKind>& solid_kinds();

}  // namespace cutterflow::free_surface
