#include "cases/study/feed_keys.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace cutterflow::cases {
namespace {

/// Keys that a feed does not use, and why.
struct Unused {
    std::vector<const char*> keys;
    std::string rule, remedy;
};

bool is_default(const ParameterTable& table, const std::string& key, const ParameterValue& value) {
    return std::any_of(table.begin(), table.end(), [&](const Parameter& row) { return row.key == key && row.default_value == value; });
}

std::vector<Unused> unused_by_law(const std::string& law) {
    if (law == k_classes)
        return {{{"feed.size_d63_m", "feed.size_d50_m", "feed.size_spread", "feed.size_max_m", "feed.size_classes"},
                 "It belongs to a law of sizes, and feed.size_law = \"classes\"",
                 "Remove it, or set feed.size_law"}};
    const bool rosin = law == k_rosin_rammler;
    const char* other = rosin ? k_log_normal : k_rosin_rammler;
    return {{{rosin ? "feed.size_d50_m" : "feed.size_d63_m"},
             fmt::format("It belongs to {}, and feed.size_law = \"{}\"", other, law),
             fmt::format("Remove it, or set feed.size_law = \"{}\"", other)}};
}

std::vector<Unused> unused_by(const ParameterValues& feed) {
    if (feed.text("feed.kind") == k_batch)
        return {{{"feed.velocity_share", "feed.disintegration", "feed.size_d63_m", "feed.size_d50_m", "feed.size_spread", "feed.size_min_m",
                  "feed.size_max_m", "feed.size_classes"},
                 "It belongs to rock from a cut face, and feed.kind = \"batch\"",
                 "Remove it, or set feed.kind = \"cut_face\""}};
    std::vector<Unused> unused = unused_by_law(feed.text("feed.size_law"));
    unused.push_back({{"feed.spacing_diameters", "feed.azimuth_centre_deg", "feed.azimuth_width_deg", "feed.radius_from_m",
                       "feed.radius_to_m", "feed.depth_from_m", "feed.depth_to_m"},
                      "It places a batch; rock from a cut face comes in where the blades cut",
                      "Remove it, or set feed.kind = \"batch\""});
    return unused;
}

}  // namespace

std::vector<std::pair<std::string, Mistake>> keys_in_vain(const ParameterValues& feed, const ParameterTable& table) {
    std::vector<std::pair<std::string, Mistake>> keys;
    for (const Unused& unused : unused_by(feed))
        for (const char* key : unused.keys)
            if (const ParameterValue* value = feed.find(key); value != nullptr && !is_default(table, key, *value))
                keys.push_back({key, {feed.where(key), fmt::format("{} = {}", key, toml_text(*value)), unused.rule, unused.remedy}});
    return keys;
}

}  // namespace cutterflow::cases
