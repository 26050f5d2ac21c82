#include "solver/free_surface/output/surface_checkpoint.hpp"

#include <fstream>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr const char* k_state = "water.bin";
constexpr std::uint64_t k_mark = 0x6375747465723032;    // format 2
constexpr std::uint64_t k_mark_1 = 0x6375747465723031;  // format 1: without the failed solves

/// Visits every part of a state in a fixed order: one list for writing and reading.
template <typename State, typename Scalar, typename Array>
void for_each_part(State& state, const Scalar& scalar, const Array& array) {
    scalar(state.time);
    scalar(state.steps);
    scalar(state.initial_volume);
    scalar(state.mixing_time);
    scalar(state.fastest_allowed);
    scalar(state.particles.volume);
    for (int d = 0; d < 3; ++d) {
        array(state.particles.position[d]);
        array(state.particles.velocity[d]);
    }
    array(state.particles.dye);
    array(state.pressure);
    array(state.spreading);
    array(state.contact_force);
}

template <typename T>
void put(std::ostream& stream, const T& value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void get(std::istream& stream, T& value) {
    stream.read(reinterpret_cast<char*>(&value), sizeof value);
}

}  // namespace

void write_checkpoint(const std::filesystem::path& folder, const SurfaceState& state, coupling::DemEngine* bodies) {
    const std::filesystem::path target = folder / names::checkpoints / fmt::format("{:.9f}", state.time), part = target.string() + ".part";
    std::filesystem::remove_all(part);
    std::filesystem::create_directories(part);
    std::ofstream stream(part / k_state, std::ios::binary);
    put(stream, k_mark);
    for_each_part(
        state, [&](const auto& value) { put(stream, value); },
        [&](const auto& values) {
            put(stream, static_cast<std::uint64_t>(values.size()));
            stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(values[0])));
        });
    put(stream, state.failed_solves);
    close_written(stream, part / k_state);
    if (bodies) bodies->write_checkpoint(part);
    std::filesystem::remove_all(target);
    std::filesystem::rename(part, target);
}

SurfaceState read_checkpoint(const std::filesystem::path& checkpoint, const StaggeredGrid& grid, coupling::DemEngine* bodies) {
    std::ifstream stream(checkpoint / k_state, std::ios::binary);
    const auto refuse = [&](const std::string& why) {
        throw UserError(fmt::format("{}: {}", (checkpoint / k_state).string(), why), "A checkpoint is whole and of the same scene",
                        "Remove the folder; an older checkpoint is taken then");
    };
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(checkpoint / k_state, missing);
    std::uint64_t mark = 0;
    get(stream, mark);
    if (!stream || (mark != k_mark && mark != k_mark_1)) refuse("no checkpoint of this program");
    SurfaceState state;
    for_each_part(
        state, [&](auto& value) { get(stream, value); },
        [&](auto& values) {
            std::uint64_t size = 0;
            get(stream, size);
            if (!stream || size > bytes / sizeof(values[0])) refuse("cut off");
            values.resize(size);
            stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(size * sizeof(values[0])));
        });
    if (mark == k_mark) get(stream, state.failed_solves);
    if (!stream) refuse("cut off");
    if (state.pressure.size() != grid.size() || state.spreading.size() != grid.size()) refuse("of another grid");
    const WaterParticles& water = state.particles;
    for (int d = 0; d < 3; ++d)
        if (water.position[d].size() != water.dye.size() || water.velocity[d].size() != water.dye.size())
            refuse("its particles have not all a place, a velocity and a dye");
    if (bodies) bodies->read_checkpoint(checkpoint);
    if (state.contact_force.size() != (bodies ? bodies->rocks().size() : 0)) refuse("of other bodies");
    return state;
}

}  // namespace cutterflow::free_surface
