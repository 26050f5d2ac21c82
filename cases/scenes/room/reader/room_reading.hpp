#pragma once
/// \file What the readers of a room share: the study's values, the scene as far as it is read, and the mistakes.
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// (x, y, z) of a message.
std::string text_of(const Vec3& v);

/// The key's place, or that of another one when it is absent.
std::string place_of(const ParameterValues& table, const std::string& key, const std::string& otherwise);

double number_or(const ParameterValues& table, const char* key, double otherwise);

Region above(double z);
Region below(double z);

/// From when to when an event lasts [s].
struct EventSpan {
    double from = 0.0, to = 0.0;
};

/// A reading in progress. Its functions add a mistake when their rule is broken, with its place in the study as `where`.
struct RoomReading {
    const ParameterValues& values;
    std::filesystem::path folder;  ///< files of the study are named relative to it
    RoomScene scene{};
    Mistakes mistakes{};
    std::set<std::string> solid_names{};     ///< also of solids with mistakes
    std::set<std::string> wrong_measures{};  ///< names of those whose tables have mistakes

    void refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy);

    /// Names of solids, materials and gates are words of dictionaries and of tables.
    void require_name(const std::string& name, const std::string& key, const std::string& where);

    /// Of solids and sides.
    void require_material(const std::string& name, const std::string& key, const std::string& where);

    /// Keys that go with another setting only.
    void refuse_keys(const ParameterValues& table, std::initializer_list<const char*> keys, const std::string& rule);

    /// A key names a table that the study has not. One of `names` was read with mistakes, which are told.
    void refuse_unknown(const ParameterValues& table, const std::string& key, const std::vector<std::string>& names,
                        const std::string& tables);

    /// A solid that the medium feels stands still. \param what  it does
    void refuse_in_medium(const RoomSolid& solid, const std::string& where, const char* what);

    /// The number of a key; none with a mistake. \param of  what needs it \param at  key whose place is told
    std::optional<double> required(const ParameterValues& table, const std::string& key, const std::string& of, const std::string& at);

    /// A stop rule may end the run earlier, none later.
    void require_in_run(double at, const char* key, const ParameterValues& table);

    /// from_s and to_s of an event.
    std::optional<EventSpan> event_span(const ParameterValues& event);

    /// All that `shape` needs, or none with a mistake.
    bool has_all(const ParameterValues& table, const std::string& shape, std::initializer_list<const char*> keys, const std::string& where);

    /// The part of space that a table gives; none when it gives none, or a wrong one.
    std::optional<Region> read_region(const ParameterValues& table, const std::string& key, const std::string& where);

    /// Whether a region and the room have a part in common (by the boxes around them).
    bool meets_room(const Region& region) const;
    void require_in_room(const Region& region, const std::string& what, const std::string& where);

    /// Where the room is, as the rule of a message.
    std::string room_rule() const;
};

}  // namespace cutterflow::cases
