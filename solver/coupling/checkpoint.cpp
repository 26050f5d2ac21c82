#include "solver/coupling/checkpoint.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::coupling {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* k_state_file = "state.json";
constexpr const char* k_velocity_file = "velocity.sums";
constexpr const char* k_production_file = "production.series";
constexpr const char* k_schema = "cutterflow.state/3";
constexpr const char* k_remedy = "Remove this checkpoint folder; the run then resumes from the one before";

const std::vector<JsonField> k_state_fields{{"schema", JsonKind::text, true},
                                            {"time_s", JsonKind::number, true},
                                            {"rotor_angle_rad", JsonKind::number, true},
                                            {"ranks", JsonKind::whole, true},
                                            {"feed/placed/*", JsonKind::whole, true},
                                            {"feed/waiting/*/id", JsonKind::whole, true},
                                            {"feed/waiting/*/due_s", JsonKind::number_or_null, true},
                                            {"feed/waiting/*/tried", JsonKind::truth, true},
                                            {"feed/last_packet_s", JsonKind::number_or_null, true},
                                            {"feed/fed_kg", JsonKind::number, true},
                                            {"booked/volume_m3", JsonKind::number, true},
                                            {"booked/momentum_n_s/*", JsonKind::number, true},
                                            {"account/id/*", JsonKind::whole, false},
                                            {"account/mass_kg/*", JsonKind::number, false},
                                            {"account/order/*", JsonKind::whole, false},
                                            {"account/where/*", JsonKind::whole, false},
                                            {"events/done/*", JsonKind::truth, false},
                                            {"events/extracted_kg/*", JsonKind::number, false},
                                            {"stop/at_rest_since_s", JsonKind::number_or_null, false},
                                            {"stop/last_crossing_s", JsonKind::number_or_null, false},
                                            {"stop/counted_since_s", JsonKind::number_or_null, false},
                                            {"stop/passed/*/time_s", JsonKind::number, false},
                                            {"stop/passed/*/mass_kg", JsonKind::number, false},
                                            {"rocks/*/id", JsonKind::whole, true},
                                            {"rocks/*/diameter_m", JsonKind::number, true},
                                            {"rocks/*/density_kg_m3", JsonKind::number, true},
                                            {"rocks/*/position_m/*", JsonKind::number, true},
                                            {"rocks/*/in_run", JsonKind::truth, true},
                                            {"rocks/*/inside", JsonKind::truth, true},
                                            {"rocks/*/was_inside", JsonKind::truth, true},
                                            {"rocks/*/sucked_up", JsonKind::truth, true},
                                            {"rocks/*/mixed", JsonKind::truth, true},
                                            {"rocks/*/left_behind", JsonKind::truth, true},
                                            {"rocks/*/start_distance_m", JsonKind::number, true},
                                            {"rocks/*/last_exit_bin", JsonKind::whole_or_null, true},
                                            {"rocks/*/first_exit_time_s", JsonKind::number_or_null, true},
                                            {"rocks/*/first_exit_azimuth_rad", JsonKind::number_or_null, true}};

json to_json(const Vec3& v) {
    return {v[0], v[1], v[2]};
}
/// \throws json::exception  when it has fewer than three components
Vec3 vector_of(const json& j) {
    return Vec3(j.at(0), j.at(1), j.at(2));
}

template <class T>
json to_json(const std::optional<T>& value) {
    return value ? json(*value) : json(nullptr);
}

template <class T>
std::optional<T> optional_of(const json& j) {
    if (j.is_null()) return std::nullopt;
    return j.get<T>();
}

json to_json(const TrackedRock& rock) {
    return {{"id", rock.id},
            {"diameter_m", rock.diameter},
            {"density_kg_m3", rock.density},
            {"position_m", to_json(rock.position)},
            {"in_run", rock.in_run},
            {"inside", rock.inside},
            {"was_inside", rock.was_inside},
            {"sucked_up", rock.sucked_up},
            {"mixed", rock.mixed},
            {"left_behind", rock.left_behind},
            {"start_distance_m", rock.start_distance},
            {"last_exit_bin", to_json(rock.last_exit_bin)},
            {"first_exit_time_s", to_json(rock.first_exit_time)},
            {"first_exit_azimuth_rad", to_json(rock.first_exit_azimuth)}};
}

TrackedRock rock_of(const json& j) {
    TrackedRock rock;
    rock.id = j.at("id");
    rock.diameter = j.at("diameter_m");
    rock.density = j.at("density_kg_m3");
    rock.position = vector_of(j.at("position_m"));
    rock.in_run = j.at("in_run");
    rock.inside = j.at("inside");
    rock.was_inside = j.at("was_inside");
    rock.sucked_up = j.at("sucked_up");
    rock.mixed = j.at("mixed");
    rock.left_behind = j.at("left_behind");
    rock.start_distance = j.at("start_distance_m");
    rock.last_exit_bin = optional_of<std::size_t>(j.at("last_exit_bin"));
    rock.first_exit_time = optional_of<double>(j.at("first_exit_time_s"));
    rock.first_exit_azimuth = optional_of<double>(j.at("first_exit_azimuth_rad"));
    return rock;
}

json to_json(const FeedState& feed) {
    json waiting = json::array();
    for (const FeedState::Waiting& rock : feed.waiting)
        waiting.push_back({{"id", rock.id}, {"due_s", to_json(rock.due)}, {"tried", rock.tried}});
    return {{"placed", feed.placed}, {"waiting", waiting}, {"last_packet_s", to_json(feed.last_packet)}, {"fed_kg", feed.fed}};
}

FeedState feed_of(const json& j) {
    FeedState feed{j.at("placed").get<std::vector<int>>(), {}, optional_of<double>(j.at("last_packet_s")), j.at("fed_kg")};
    for (const json& rock : j.at("waiting"))
        feed.waiting.push_back({rock.at("id"), optional_of<double>(rock.at("due_s")), rock.at("tried")});
    return feed;
}

/// By columns: one rock has few numbers.
json to_json(const std::vector<AccountEntry>& account) {
    json id = json::array(), mass = json::array(), order = json::array(), where = json::array();
    for (const AccountEntry& entry : account) {
        id.push_back(entry.id);
        mass.push_back(entry.mass);
        order.push_back(entry.order);
        where.push_back(static_cast<int>(entry.where));
    }
    return {{"id", id}, {"mass_kg", mass}, {"order", order}, {"where", where}};
}

[[noreturn]] void refuse(const fs::path& file, const std::string& what, const std::string& rule) {
    throw UserError({{file.string(), what, rule, k_remedy}});
}

std::vector<AccountEntry> account_of(const json& j, const fs::path& file) {
    std::vector<AccountEntry> account;
    for (std::size_t k = 0; k < j.at("id").size(); ++k) {
        const std::size_t where = j.at("where").at(k);
        if (where >= k_whereabouts.size())
            refuse(file, fmt::format("rock {} is at place {}", j.at("id").at(k).get<int>(), where),
                   fmt::format("Places are counted from 0 to {}", k_whereabouts.size() - 1));
        account.push_back({j.at("id").at(k), j.at("mass_kg").at(k), j.at("order").at(k), static_cast<Whereabouts>(where)});
    }
    return account;
}

std::string carry_file(int rank) {
    return fmt::format("carry.{}", rank);
}

json to_json(const StopState& stops) {
    json passed = json::array();
    for (const Passage& one : stops.passed) passed.push_back({{"time_s", one.time}, {"mass_kg", one.mass}});
    return {{"at_rest_since_s", to_json(stops.at_rest_since)},
            {"last_crossing_s", to_json(stops.last_crossing)},
            {"counted_since_s", to_json(stops.counted_since)},
            {"passed", passed}};
}

/// Earlier versions have no masses.
StopState stops_of(const json& j) {
    StopState stops{optional_of<double>(j.at("at_rest_since_s")), optional_of<double>(j.at("last_crossing_s")), {}};
    if (j.contains("counted_since_s")) stops.counted_since = optional_of<double>(j.at("counted_since_s"));
    for (const json& one : j.value("passed", json::array())) stops.passed.push_back({one.at("time_s"), one.at("mass_kg")});
    return stops;
}

}  // namespace

void write_state(const fs::path& folder, const RunState& state) {
    json j{{"schema", k_schema}, {"time_s", state.time}, {"rotor_angle_rad", state.rotor_angle}, {"ranks", state.ranks}};
    j["feed"] = to_json(state.feed);
    j["booked"] = {{"volume_m3", state.booked.volume}, {"momentum_n_s", to_json(state.booked.momentum)}};
    if (state.account) j["account"] = to_json(*state.account);
    j["events"] = {{"done", state.operations.done}, {"extracted_kg", state.operations.extracted}};
    j["stop"] = to_json(state.stops);
    j["rocks"] = json::array();
    for (const auto& [id, rock] : state.rocks) j["rocks"].push_back(to_json(rock));
    write_file(folder / k_state_file, j.dump(1) + "\n");
}

RunState read_state(const fs::path& folder) {
    const fs::path file = folder / k_state_file;
    const json schema = read_json_document(file, {{"schema", JsonKind::text, true}}, k_remedy).at("schema");
    if (schema != k_schema) refuse(file, fmt::format("schema {} is not {}", schema.dump(), k_schema), "Versions must match");
    const json j = read_json_document(file, k_state_fields, k_remedy);
    try {
        RunState state;
        state.time = j.at("time_s");
        state.rotor_angle = j.at("rotor_angle_rad");
        state.ranks = j.at("ranks");
        state.feed = feed_of(j.at("feed"));
        state.booked = {j.at("booked").at("volume_m3"), vector_of(j.at("booked").at("momentum_n_s"))};
        if (j.contains("account")) state.account = account_of(j.at("account"), file);
        if (j.contains("events")) state.operations = {j.at("events").at("done"), j.at("events").at("extracted_kg")};
        if (j.contains("stop")) state.stops = stops_of(j.at("stop"));
        for (const json& rock : j.at("rocks")) state.rocks[rock.at("id")] = rock_of(rock);
        return state;
    } catch (const json::exception& error) {
        refuse(file, error.what(), "The file is one that cutterFoam wrote");
    }
}

void write_carry(const fs::path& folder, int rank, gsl::span<const std::int64_t> cell_ids, gsl::span<const Vec3> carry) {
    std::ofstream stream(folder / carry_file(rank), std::ios::binary);
    const auto count = static_cast<std::uint64_t>(carry.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof count);
    stream.write(reinterpret_cast<const char*>(cell_ids.data()), static_cast<std::streamsize>(count * sizeof(std::int64_t)));
    stream.write(reinterpret_cast<const char*>(carry.data()), static_cast<std::streamsize>(count * sizeof(Vec3)));
    close_written(stream, folder / carry_file(rank));
}

std::vector<Vec3> read_carry(const fs::path& folder, int written_by, gsl::span<const std::int64_t> cell_ids) {
    std::unordered_map<std::int64_t, std::size_t> place;
    for (std::size_t c = 0; c < static_cast<std::size_t>(cell_ids.size()); ++c) place[cell_ids[c]] = c;
    std::vector<Vec3> carry(static_cast<std::size_t>(cell_ids.size()));
    std::size_t found = 0;
    for (int rank = 0; rank < written_by; ++rank) {
        const fs::path file = folder / carry_file(rank);
        std::ifstream stream(file, std::ios::binary);
        std::uint64_t count = 0;
        stream.read(reinterpret_cast<char*>(&count), sizeof count);
        std::error_code missing;
        constexpr std::uint64_t entry = sizeof(std::int64_t) + sizeof(Vec3);
        const std::uintmax_t size = fs::file_size(file, missing);
        if (!stream || (size - sizeof count) % entry != 0 || (size - sizeof count) / entry != count)
            refuse(file, "the file is missing or cut short", "The file is one that cutterFoam wrote");
        std::vector<std::int64_t> ids(count);
        std::vector<Vec3> values(count);
        stream.read(reinterpret_cast<char*>(ids.data()), static_cast<std::streamsize>(count * sizeof(std::int64_t)));
        stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(Vec3)));
        for (std::size_t i = 0; i < count; ++i) {
            const auto cell = place.find(ids[i]);
            if (cell == place.end()) continue;
            if (!values[i].allFinite())
                refuse(file, fmt::format("the momentum of cell {} is ({}, {}, {})", ids[i], values[i][0], values[i][1], values[i][2]),
                       "Momentum is finite");
            carry[cell->second] = values[i];
            ++found;
        }
    }
    if (found != carry.size())
        refuse(folder, fmt::format("the carried momentum of {} cells is needed, that of {} is there", carry.size(), found),
               "A run resumes on the mesh that it had");
    return carry;
}

void write_velocity(const fs::path& folder, const VelocitySets& sets) {
    std::ofstream stream(folder / k_velocity_file, std::ios::binary);
    sets.write(stream);
    close_written(stream, folder / k_velocity_file);
}

void read_velocity(const fs::path& folder, VelocitySets& sets) {
    const fs::path file = folder / k_velocity_file;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || !sets.restore(stream))
        refuse(file, "it does not hold the sums of this run's velocity sets", "A run resumes with the points that it began with");
}

void write_production(const fs::path& folder, const ProductionWatch& production) {
    std::ofstream stream(folder / k_production_file, std::ios::binary);
    production.write(stream);
    close_written(stream, folder / k_production_file);
}

void read_production(const fs::path& folder, ProductionWatch& production) {
    const fs::path file = folder / k_production_file;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || !production.restore(stream))
        refuse(file, "it does not hold the ledger of the run so far", "A run that ends by the interval of its production resumes with it");
}

void prune_checkpoints(const fs::path& case_folder, int keep) {
    const std::vector<fs::path> found = checkpoint_folders(case_folder);
    for (int i = 0; i + keep < static_cast<int>(found.size()); ++i) fs::remove_all(found[static_cast<std::size_t>(i)]);
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(case_folder / names::checkpoints))
        if (entry.path().extension() == ".part") parts.push_back(entry.path());
    for (const fs::path& part : parts) fs::remove_all(part);
}

}  // namespace cutterflow::coupling
