#include "cases/runner/manifest.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"
#include "postproc/run/solver_starts.hpp"

namespace cutterflow::cases {
namespace {

constexpr const char* k_schema = "cutterflow.manifest/1";

using nlohmann::json;

StageRecord record_from(const json& object) {
    StageRecord record;
    record.state = object.at("state") == "done" ? StageState::done : StageState::started;
    record.inputs = object.at("inputs").get<std::map<std::string, std::string>>();
    record.outputs = object.at("outputs").get<std::map<std::string, std::string>>();
    record.wall_s = object.at("wall_s").get<double>();
    record.core_s = object.at("core_s").get<double>();
    record.finished = object.at("finished").get<std::string>();
    return record;
}

json to_json(const StageRecord& record) {
    return {{"state", record.state == StageState::done ? "done" : "started"},
            {"inputs", record.inputs},
            {"outputs", record.outputs},
            {"wall_s", record.wall_s},
            {"core_s", record.core_s},
            {"finished", record.finished}};
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw UserError(fmt::format("{} cannot be read: {}", file.string(), why),
                    fmt::format("It must be a manifest ({}) as cutterflow writes it", k_schema),
                    "Use another run directory; the state of this one is unknown");
}

}  // namespace

Manifest::Manifest(std::filesystem::path file) : file_(std::move(file)) {
    if (!std::filesystem::exists(file_)) return;
    try {
        const json document = json::parse(read_file(file_));
        if (document.at("schema") != k_schema) refuse(file_, "its schema is " + document.at("schema").dump());
        for (const auto& [stage, record] : document.at("stages").items()) records_[stage] = record_from(record);
        kind_ = document.value("kind", "");
        versions_ = document.at("versions").get<std::map<std::string, std::string>>();
    } catch (const json::parse_error&) {
        refuse(file_, "it is cut off or damaged");
    } catch (const json::exception&) {
        refuse(file_, "a value is missing or of another kind");
    }
}

double Manifest::core_s() const {
    double sum = 0.0;
    for (const auto& [stage, record] : records_) sum += record.core_s;
    return sum;
}

const StageRecord* Manifest::find(const std::string& stage) const {
    const auto found = records_.find(stage);
    return found == records_.end() ? nullptr : &found->second;
}

void Manifest::start(const std::string& stage, std::map<std::string, std::string> inputs, const std::vector<std::string>& dropped) {
    for (const std::string& later : dropped) records_.erase(later);
    StageRecord record;
    record.inputs = std::move(inputs);
    records_[stage] = std::move(record);
    write();
}

void Manifest::note_cost(const std::string& stage, double wall_s, double core_s) {
    StageRecord& record = records_.at(stage);
    record.wall_s = wall_s;
    record.core_s = core_s;
    write();
}

void Manifest::finish(const std::string& stage, std::map<std::string, std::string> outputs, double wall_s, double core_s) {
    StageRecord& record = records_.at(stage);
    record.state = StageState::done;
    record.outputs = std::move(outputs);
    record.wall_s = wall_s;
    record.core_s = core_s;
    record.finished = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    write();
}

void Manifest::set_kind(const std::string& kind) {
    if (!kind_.empty() && kind_ != kind)
        throw UserError(fmt::format("{} contains work of a study of kind {}, not {}", file_.parent_path().string(), kind_, kind),
                        "A run directory belongs to one study", "Choose another with -o");
    kind_ = kind;
}

void Manifest::set_versions(std::map<std::string, std::string> versions) {
    versions_ = std::move(versions);
}

void Manifest::write() const {
    json stages = json::object();
    for (const auto& [name, record] : records_) stages[name] = to_json(record);
    write_file(file_, json{{"schema", k_schema}, {"kind", kind_}, {"stages", stages}, {"versions", versions_}}.dump(2) + "\n");
}

double run_core_s(const std::filesystem::path& run) {
    const Manifest manifest(run / names::manifest);
    const StageRecord* solver = manifest.find("run");
    const double noted = solver == nullptr ? 0.0 : solver->core_s;  // of the last attempt
    const auto of_all_starts = postproc::solver_core_seconds(run);
    return manifest.core_s() + (of_all_starts ? *of_all_starts - noted : replaced_core_seconds(run));
}

}  // namespace cutterflow::cases
