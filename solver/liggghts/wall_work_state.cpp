#include "solver/liggghts/wall_work_state.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr const char* k_file = "wall_work.json";
constexpr const char* k_remedy = "Remove this checkpoint folder; the run then resumes from the one before";

/// Whether it is of the wall as it is now.
bool is_of(const nlohmann::json& kept, const coupling::WallWork& work) {
    return kept.at("name") == work.wall && kept.at("impact_j").size() == work.triangles.size() &&
           kept.at("sliding_j").size() == work.triangles.size();
}

}  // namespace

void write_wall_work(const std::filesystem::path& folder, const std::vector<coupling::WallWork>& works) {
    nlohmann::json walls = nlohmann::json::array();
    for (const coupling::WallWork& work : works)
        walls.push_back({{"name", work.wall}, {"since_s", work.since}, {"impact_j", work.impact}, {"sliding_j", work.sliding}});
    write_file(folder / k_file, nlohmann::json{{"walls", walls}}.dump() + "\n");
}

void read_wall_work(const std::filesystem::path& folder, double time, std::vector<coupling::WallWork>& works) {
    nlohmann::json walls = nlohmann::json::array();
    if (std::filesystem::exists(folder / k_file))
        walls = read_json_document(folder / k_file,
                                   {{"walls/*/name", JsonKind::text, true},
                                    {"walls/*/since_s", JsonKind::number, true},
                                    {"walls/*/impact_j/*", JsonKind::number, true},
                                    {"walls/*/sliding_j/*", JsonKind::number, true}},
                                   k_remedy)
                    .at("walls");
    for (coupling::WallWork& work : works) {
        const auto kept = std::find_if(walls.begin(), walls.end(), [&](const nlohmann::json& wall) { return is_of(wall, work); });
        work.since = kept == walls.end() ? time : kept->at("since_s").get<double>();
        work.impact.assign(work.triangles.size(), 0.0);
        work.sliding.assign(work.triangles.size(), 0.0);
        if (kept == walls.end()) continue;
        work.impact = kept->at("impact_j").get<std::vector<double>>();
        work.sliding = kept->at("sliding_j").get<std::vector<double>>();
    }
}

}  // namespace cutterflow::liggghts
