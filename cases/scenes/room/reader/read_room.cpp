/// \file From the values of a room's study to its scene; every mistake is found.
#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"

namespace cutterflow::cases {

namespace fs = std::filesystem;

RoomScene room_scene(const ParameterValues& values, const fs::path& folder) {
    RoomReading room{values, folder};
    room.scene.name = values.text("name");
    read_space(room);
    read_materials(room);
    read_all_grains(room);
    read_solids(room);
    read_moves(room);
    read_boundaries(room);
    read_ramps(room);
    read_pairs(room);
    read_preparation(room);
    read_measures(room);
    read_run(room);
    read_events(room);
    require_something(room);
    if (!room.mistakes.empty()) throw UserError(in_order_of_lines(room.mistakes.take()));
    return std::move(room.scene);
}

RoomScene read_room(const fs::path& study) {
    return room_scene(read_parameters(room_table(), study), study.parent_path());
}

/// What is unknown in a study does not hide what is wrong with the rest.
ParameterValues read_placed_room(const fs::path& study) {
    ReadParameters read = parse_with_mistakes(room_table(), read_file(study), study.string());
    if (!read.mistakes.empty()) {
        Mistakes mistakes;
        mistakes.add(read.mistakes);
        if (read.complete) mistakes.gather([&] { room_scene(read.values, study.parent_path()); });
        throw UserError(in_order_of_lines(mistakes.take()));
    }
    ParameterValues values = std::move(read.values);
    const auto place = [&](ParameterValues& table, const char* key) {
        if (table.has(key)) table.set(key, fs::absolute(study.parent_path() / table.text(key)).lexically_normal().string());
    };
    for (ParameterValues& solid : values.tables_for_writing("solid")) place(solid, "solid.file");
    for (ParameterValues& grains : values.tables_for_writing("grains")) place(grains, "grains.shape");
    for (ParameterValues& measure : values.tables_for_writing("measure")) place(measure, "measure.against");
    return values;
}

}  // namespace cutterflow::cases
