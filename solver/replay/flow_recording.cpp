#include "solver/replay/flow_recording.hpp"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "solver/ports/recording_summary.hpp"

namespace cutterflow::coupling {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_steel_file = "steel";

const std::vector<JsonField> k_head_fields{{"schema", JsonKind::text, true},
                                           {"ranks", JsonKind::whole, true},
                                           {"phases", JsonKind::whole, true},
                                           {"blades", JsonKind::whole, true},
                                           {"start_s", JsonKind::number, true},
                                           {"end_s", JsonKind::number, true},
                                           {"zone", JsonKind::text, true},
                                           {"speed_rad_s", JsonKind::number, true},
                                           {"axis_origin_m/*", JsonKind::number, true},
                                           {"axis_direction/*", JsonKind::number, true},
                                           {"steel_triangles/*", JsonKind::whole, true},
                                           {"soil_triangles", JsonKind::whole, true},
                                           {"still_weight_s/*", JsonKind::number, true},
                                           {"turning_weight_s/*", JsonKind::number, true}};

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
    throw UserError({{file.string(), what, "A recording is read as it was written", k_recording_remedy}});
}

template <class T>
void put(std::ofstream& stream, const std::vector<T>& values) {
    stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

/// Appends `count` values.
template <class T>
void get(std::ifstream& stream, std::size_t count, std::vector<T>& values) {
    values.resize(values.size() + count);
    stream.read(reinterpret_cast<char*>(values.data() + (values.size() - count)), static_cast<std::streamsize>(count * sizeof(T)));
}

std::string cells_file(int rank) {
    return fmt::format("cells.{}", rank);
}

/// Bytes of a rank's file.
std::uintmax_t bytes_of(std::size_t cells, std::size_t phases) {
    return cells * (sizeof(std::int64_t) + sizeof(Vec3) + 2 * sizeof(double) + sizeof(std::uint8_t) + phases * 6 * sizeof(float));
}

void require_size(const fs::path& file, std::uintmax_t bytes) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) refuse(file, "the file is missing");
    if (size != bytes) refuse(file, fmt::format("it has {} bytes instead of {}", size, bytes));
}

std::vector<double> to_vector(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

Vec3 to_vec3(const nlohmann::json& values, const fs::path& file) {
    if (values.size() != 3) refuse(file, "a vector has not three components");
    return Vec3(values[0], values[1], values[2]);
}

void write_cells(const fs::path& file, const FlowRecording& recording) {
    std::ofstream stream(file, std::ios::binary);
    put(stream, recording.cells.ids);
    put(stream, recording.cells.centres);
    put(stream, recording.cells.volumes);
    put(stream, recording.cells.sizes);
    put(stream, recording.cells.zone);
    put(stream, recording.velocity);
    put(stream, recording.acceleration);
    close_written(stream, file);
}

void write_steel(const fs::path& file, const FlowRecording& recording) {
    std::ofstream stream(file, std::ios::binary);
    for (const std::vector<SteelTriangle>& triangles : recording.steel) put(stream, triangles);
    put(stream, recording.soil);
    close_written(stream, file);
}

/// What recording.json holds.
nlohmann::json head_of(const FlowRecording& recording, int ranks) {
    const ZoneMotion& zone = recording.moving.front();
    nlohmann::json steel = nlohmann::json::array();
    for (const std::vector<SteelTriangle>& triangles : recording.steel) steel.push_back(triangles.size());
    return {{"schema", k_recording_schema},
            {"ranks", ranks},
            {"phases", recording.phases},
            {"blades", recording.blades},
            {"start_s", recording.start},
            {"end_s", recording.end},
            {"change", recording.change ? nlohmann::json(*recording.change) : nlohmann::json()},
            {"zone", zone.name},
            {"speed_rad_s", zone.speed},
            {"axis_origin_m", to_vector(zone.axis.origin)},
            {"axis_direction", to_vector(zone.axis.direction)},
            {"steel_triangles", steel},
            {"soil_triangles", recording.soil.size()},
            {"still_weight_s", recording.weight[0]},
            {"turning_weight_s", recording.weight[1]}};
}

/// Fields of all ranks are joined phase by phase.
class CellReader {
public:
    CellReader(FlowRecording& recording, const fs::path& folder, int ranks) : recording_(recording) {
        const auto phases = static_cast<std::size_t>(recording.phases);
        const std::uintmax_t of_one = bytes_of(1, phases);
        for (int rank = 0; rank < ranks; ++rank) {
            files_.push_back(folder / cells_file(rank));
            std::error_code error;
            const std::uintmax_t size = fs::file_size(files_.back(), error);
            if (error) refuse(files_.back(), "the file is missing");
            if (size % of_one != 0) refuse(files_.back(), "it is truncated or of another number of phases");
            counts_.push_back(size / of_one);
        }
    }

    void read() {
        std::vector<std::vector<float>> velocity(files_.size()), acceleration(files_.size());
        for (std::size_t rank = 0; rank < files_.size(); ++rank) {
            std::ifstream stream(files_[rank], std::ios::binary);
            const std::size_t n = counts_[rank], values = 3 * n * static_cast<std::size_t>(recording_.phases);
            get(stream, n, recording_.cells.ids);
            get(stream, n, recording_.cells.centres);
            get(stream, n, recording_.cells.volumes);
            get(stream, n, recording_.cells.sizes);
            get(stream, n, recording_.cells.zone);
            get(stream, values, velocity[rank]);
            get(stream, values, acceleration[rank]);
            if (!stream) refuse(files_[rank], "it cannot be read");
        }
        recording_.velocity = joined(velocity);
        recording_.acceleration = joined(acceleration);
    }

private:
    std::vector<float> joined(const std::vector<std::vector<float>>& of_ranks) const {
        std::vector<float> all;
        for (std::size_t phase = 0; phase < static_cast<std::size_t>(recording_.phases); ++phase)
            for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
                const auto begin = of_ranks[rank].begin() + static_cast<std::ptrdiff_t>(3 * counts_[rank] * phase);
                all.insert(all.end(), begin, begin + static_cast<std::ptrdiff_t>(3 * counts_[rank]));
            }
        return all;
    }

    FlowRecording& recording_;
    std::vector<fs::path> files_;
    std::vector<std::size_t> counts_;
};

void read_steel(const fs::path& file, const nlohmann::json& counts, std::size_t of_soil, FlowRecording& recording) {
    std::uintmax_t triangles = of_soil;
    for (const auto& count : counts) triangles += count.get<std::size_t>();
    require_size(file, triangles * sizeof(SteelTriangle));
    std::ifstream stream(file, std::ios::binary);
    for (const auto& count : counts) get(stream, count.get<std::size_t>(), recording.steel.emplace_back());
    get(stream, of_soil, recording.soil);
    if (!stream) refuse(file, "it cannot be read");
}

void require_consistent(const FlowRecording& recording, const fs::path& head) {
    const auto phases = static_cast<std::size_t>(recording.phases);
    if (recording.phases < 2 || recording.blades < 1) refuse(head, "it has fewer than two phases, or no blade");
    if (recording.weight[0].size() != phases || recording.weight[1].size() != phases)
        refuse(head, "its weights are not those of its phases");
    if (recording.moving.front().speed == 0.0) refuse(head, "its rotor stands still");
    if (std::abs(recording.moving.front().axis.direction.norm() - 1.0) > 1e-9) refuse(head, "its axis is no unit vector");
    if (recording.steel.size() != 2) refuse(head, "its steel is not that of a still and a turning zone");
}

}  // namespace

PhasePlace phase_place(const FlowRecording& recording, std::size_t period, double angle) {
    const double turn = period == 0 ? 2.0 * k_pi / recording.blades : 2.0 * k_pi;
    const double within = angle / turn - std::floor(angle / turn);
    const auto phases = static_cast<std::size_t>(recording.phases);
    const double place = within * recording.phases;
    const auto before = static_cast<std::size_t>(place) % phases;
    return {before, (before + 1) % phases, place - std::floor(place)};
}

void write_recording(const fs::path& folder, const FlowRecording& recording, int rank, int ranks) {
    write_cells(folder / cells_file(rank), recording);
    if (rank != 0) return;
    write_steel(folder / k_steel_file, recording);
    write_file(folder / k_recording_summary, head_of(recording, ranks).dump(2) + "\n");
}

FlowRecording read_recording(const fs::path& folder) {
    const fs::path file = folder / k_recording_summary;
    const RecordingSummary own = read_recording_summary(folder);
    const nlohmann::json head = read_json_document(file, k_head_fields, k_recording_remedy);
    FlowRecording recording;
    recording.phases = head.at("phases");
    recording.blades = head.at("blades");
    recording.start = head.at("start_s");
    recording.end = head.at("end_s");
    recording.change = own.change;
    const RotationAxis axis{to_vec3(head.at("axis_origin_m"), file), to_vec3(head.at("axis_direction"), file)};
    recording.moving = {{axis, head.at("speed_rad_s"), head.at("zone")}};
    recording.weight = {head.at("still_weight_s").get<std::vector<double>>(), head.at("turning_weight_s").get<std::vector<double>>()};
    read_steel(folder / k_steel_file, head.at("steel_triangles"), head.at("soil_triangles"), recording);
    require_consistent(recording, file);
    CellReader(recording, folder, head.at("ranks")).read();
    for (const std::uint8_t zone : recording.cells.zone)
        if (zone > recording.moving.size()) refuse(folder, "a cell belongs to no zone");
    return recording;
}

}  // namespace cutterflow::coupling
