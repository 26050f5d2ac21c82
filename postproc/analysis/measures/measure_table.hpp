#pragma once
/// \file What can be measured in a finished run, and with which keys: one table. Reading, checking, `cutterflow measure` and the manual
/// follow from it.
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/vec3.hpp"
#include "postproc/analysis/measures/measure_kinds.hpp"

namespace cutterflow::postproc {

/// How the value of a key is written.
enum class MeasureShape {
    single,  ///< a value of the parameter's kind
    pair,    ///< two numbers
    point,   ///< three numbers
    region,  ///< {box = {lower_m, upper_m}}, {sphere = {centre_m, radius_m}}, {cylinder = {from_m, to_m, radius_m}} or
             ///< {half_space = {point_m, normal}}
    gate,    ///< the name of a gate, or {disc_m, radius_m} or {lower_m, upper_m}, with a normal
};

/// A key of a measure. Bounds hold for every number of a pair or a point.
struct MeasureKey {
    Parameter parameter;
    MeasureShape shape = MeasureShape::single;
};

/// A kind of measure: `what` of a [[measure]].
struct MeasureKind {
    const char* what;
    MeasureOutcome (*measure)(const MeasureSource& source, const MeasureValues& values);
    const char* unit;  ///< of its value; of the first choice of `quantity` where it has that key
    const char* help;
    std::vector<MeasureKey> keys;
    /// Rules between keys whose values are right by themselves; null: none. \return mistakes
    std::vector<Mistake> (*rules)(const nlohmann::json& measure) = nullptr;
    bool has_profile = false;  ///< its series has place_m and height_m
};

const std::vector<MeasureKind>& measure_table();

/// The row of a kind; null when there is none.
const MeasureKind* find_measure_kind(const std::string& what);

/// Every mistake of the measures of a run.
/// \param measures  an array of objects, as measures.json has it and [[measure]] of a study
/// \param where     in front of every mistake
/// \param first     number of the first one: a measure without a right name is told by its number
/// \return empty: run and postproc take all of them
std::vector<Mistake> check_measures(const nlohmann::json& measures, const std::string& where = "", std::size_t first = 1);

/// Values of a measure that was checked; a key that is absent has its default.
class MeasureValues {
public:
    explicit MeasureValues(const nlohmann::json& measure);
    const MeasureKind& kind() const { return *kind_; }
    std::string name() const { return measure_.at("name").get<std::string>(); }
    bool has(const std::string& key) const { return measure_.contains(key); }  ///< as written; defaults do not count
    double number(const std::string& key) const;
    std::optional<double> optional_number(const std::string& key) const;
    int integer(const std::string& key) const;
    std::string text(const std::string& key) const;
    Eigen::Vector2d pair(const std::string& key) const;
    Vec3 point(const std::string& key) const;
    const nlohmann::json& raw(const std::string& key) const { return measure_.at(key); }

private:
    const Parameter& parameter(const std::string& key) const;
    nlohmann::json measure_;
    const MeasureKind* kind_;
};

}  // namespace cutterflow::postproc
