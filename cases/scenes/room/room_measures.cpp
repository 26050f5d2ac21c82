#include "cases/scenes/room/room_measures.hpp"

#include <algorithm>

#include "cases/scenes/room/room_study.hpp"
#include "geometry/base/parameters/parameter_row.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "postproc/analysis/measures/measure_table.hpp"

namespace cutterflow::cases {

namespace {

using postproc::MeasureShape;

constexpr const char* k_array = "measure";

Parameter numbers(const std::string& key, std::size_t length, const std::string& help) {
    return ParameterRow(key, ParameterKind::numbers, "m", help).of_length(length).optional();
}
/// What the run itself records: rock at a gate, the pressure at two points.
Parameter recorded(const Parameter& row) {
    return ParameterRow(row).stage(room_stage::k_case);
}
Parameter number(const std::string& key, const std::string& help) {
    return ParameterRow(key, ParameterKind::number, "m", help).optional();
}

/// Rows of one key: a region and a gate have several.
ParameterTable rows_of(const postproc::MeasureKey& measured) {
    const Parameter& of_kind = measured.parameter;
    const std::string key = std::string(k_array) + "." + of_kind.key;
    switch (measured.shape) {
        case MeasureShape::region:
            return {numbers(key + ".box.lower_m", 3, "Lower corner of a box: where the measure looks."),
                    numbers(key + ".box.upper_m", 3, "Upper corner of the box."),
                    numbers(key + ".sphere.centre_m", 3, "Centre of a sphere: where the measure looks."),
                    number(key + ".sphere.radius_m", "Of the sphere."),
                    numbers(key + ".cylinder.from_m", 3, "One end of a cylinder's axis: where the measure looks."),
                    numbers(key + ".cylinder.to_m", 3, "The other end of its axis."),
                    number(key + ".cylinder.radius_m", "Of the cylinder."),
                    numbers(key + ".half_space.point_m", 3, "A point of the plane that bounds a half space: where the measure looks."),
                    numbers(key + ".half_space.normal", 3, "Direction into the half space.")};
        case MeasureShape::gate:
            return {ParameterRow(key, ParameterKind::text, "-", of_kind.help).optional().repeated(),
                    recorded(numbers(key + ".disc_m", 3, "Centre of a disc.")),
                    recorded(number(key + ".radius_m", "Of the disc.")),
                    recorded(numbers(key + ".lower_m", 3, "Lower corner of a rectangle.")),
                    recorded(numbers(key + ".upper_m", 3, "Upper corner of the rectangle.")),
                    recorded(numbers(key + ".normal", 3, "Direction in which passing counts."))};
        case MeasureShape::pair:
            return {ParameterRow(key, ParameterKind::numbers, of_kind.unit, of_kind.help).of_length(2).optional().repeated()};
        case MeasureShape::point: {
            const Parameter row = ParameterRow(key, ParameterKind::numbers, of_kind.unit, of_kind.help).of_length(3).optional().repeated();
            return {of_kind.key == "upstream_m" || of_kind.key == "downstream_m" ? recorded(row) : row};
        }
        case MeasureShape::single:
            break;
    }
    const ParameterKind kind = of_kind.kind == ParameterKind::choice ? ParameterKind::text : of_kind.kind;
    return {ParameterRow(key, kind, of_kind.unit, of_kind.help).optional().repeated()};
}

nlohmann::json json_of(const ParameterValue& value) {
    return std::visit([](const auto& held) { return nlohmann::json(held); }, value);
}

Vec3 vec3_in(const nlohmann::json& list) {
    return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

}  // namespace

ParameterTable measure_rows() {
    ParameterTable rows{ParameterRow("measure.name", ParameterKind::text, "-", "Name of the measure.").repeated(),
                        ParameterRow("measure.what", ParameterKind::text, "-", "What is measured.").repeated()};
    for (const postproc::MeasureKind& kind : postproc::measure_table())
        for (const postproc::MeasureKey& key : kind.keys)
            for (Parameter& row : rows_of(key)) {
                const auto same = [&](const Parameter& other) { return other.key == row.key; };
                if (std::none_of(rows.begin(), rows.end(), same)) rows.push_back(std::move(row));
            }
    return rows;
}

nlohmann::json measure_json(const ParameterValues& table) {
    nlohmann::json measure = nlohmann::json::object();
    for (const Parameter& row : measure_rows()) {
        const ParameterValue* value = table.find(row.key);
        if (value == nullptr) continue;
        nlohmann::json* place = &measure;
        std::string rest = row.key.substr(std::string(k_array).size() + 1);
        for (std::size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
            place = &(*place)[rest.substr(0, dot)];
            rest.erase(0, dot + 1);
        }
        (*place)[rest] = json_of(*value);
    }
    return measure;
}

std::vector<Mistake> measure_mistakes(const ParameterValues& table, std::size_t number) {
    return postproc::check_measures(nlohmann::json::array({measure_json(table)}), table.where("measure.name"), number);
}

std::vector<RoomGate> gates_of(const nlohmann::json& measures) {
    std::vector<RoomGate> gates;
    for (const nlohmann::json& measure : measures) {
        if (!measure.contains("gate") || !measure.at("gate").is_object()) continue;
        const nlohmann::json& place = measure.at("gate");
        RoomGate gate;
        gate.name = measure.at("name").get<std::string>();
        if (place.contains("normal")) gate.normal = vec3_in(place.at("normal")).normalized();
        if (place.contains("disc_m")) {
            gate.centre = vec3_in(place.at("disc_m"));
            gate.radius = place.at("radius_m").get<double>();
        } else {
            gate.lower = vec3_in(place.at("lower_m"));
            gate.upper = vec3_in(place.at("upper_m"));
            gate.centre = 0.5 * (gate.lower + gate.upper);
        }
        gates.push_back(gate);
    }
    return gates;
}

}  // namespace cutterflow::cases
