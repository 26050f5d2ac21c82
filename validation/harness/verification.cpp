#include "validation/harness/verification.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "validation/harness/reference_table.hpp"

namespace cutterflow::validation {
namespace {

VerifiedQuantity quantity(Rule rule, const std::string& name, const std::string& unit, const About& about) {
    VerifiedQuantity result;
    result.name = name;
    result.unit = unit;
    result.rule = rule;
    result.aim = about.aim;
    result.source = about.source;
    result.note = about.note;
    return result;
}

Effort effort_of(const std::string& word) {
    if (word == "fast") return Effort::fast;
    if (word == "standard") return Effort::standard;
    if (word == "long") return Effort::longest;
    throw UserError(fmt::format("class {}", word), "It is fast, standard or long", "Start the case as <program> fast FOLDER");
}

}  // namespace

void Verification::add(VerifiedQuantity quantity) {
    require_source(quantity.source, quantity.name);
    quantities_.push_back(std::move(quantity));
    nlohmann::json rows = nlohmann::json::array();
    for (const VerifiedQuantity& q : quantities_) rows.push_back(quantity_json(q));
    write_file(folder_ / "quantities.json", rows.dump(2) + "\n");
    std::cout << quantity_text(quantities_.back()) << std::endl;
}

void Verification::relative(const std::string& name, const std::string& unit, double value, double reference, double tolerance,
                            const About& about) {
    VerifiedQuantity q = quantity(Rule::relative, name, unit, about);
    q.value = value;
    q.reference = reference;
    q.tolerance = tolerance;
    judge(q);
    add(std::move(q));
}

void Verification::absolute(const std::string& name, const std::string& unit, double value, double reference, double tolerance,
                            const About& about) {
    VerifiedQuantity q = quantity(Rule::absolute, name, unit, about);
    q.value = value;
    q.reference = reference;
    q.tolerance = tolerance;
    judge(q);
    add(std::move(q));
}

void Verification::at_most(const std::string& name, const std::string& unit, double value, double limit, const About& about) {
    VerifiedQuantity q = quantity(Rule::at_most, name, unit, about);
    q.value = value;
    q.tolerance = limit;
    judge(q);
    add(std::move(q));
}

void Verification::at_least(const std::string& name, const std::string& unit, double value, double limit, const About& about) {
    VerifiedQuantity q = quantity(Rule::at_least, name, unit, about);
    q.value = value;
    q.tolerance = limit;
    judge(q);
    add(std::move(q));
}

void Verification::report(const std::string& name, const std::string& unit, double value, std::optional<double> reference,
                          const About& about) {
    VerifiedQuantity q = quantity(Rule::none, name, unit, about);
    q.value = value;
    q.reference = reference;
    judge(q);
    add(std::move(q));
}

void Verification::not_converged(const std::string& name, const std::string& unit, const About& about) {
    VerifiedQuantity q = quantity(Rule::none, name, unit, about);
    q.verdict = CaseVerdict::not_converged;
    add(std::move(q));
}

void Verification::table(const ExhibitTable& table) {
    auto& tables = exhibits_.tables;
    const auto same = std::find_if(tables.begin(), tables.end(), [&](const auto& other) { return other.title == table.title; });
    if (same == tables.end())
        tables.push_back(table);
    else
        *same = table;
    write_exhibits();
}

void Verification::chart(const Chart& chart) {
    exhibits_.charts.push_back(chart);
    write_exhibits();
}

void Verification::write_exhibits() const {
    write_file(folder_ / "exhibits.json", exhibits_json(exhibits_).dump(2) + "\n");
}

bool Verification::failed() const {
    return std::any_of(quantities_.begin(), quantities_.end(),
                       [](const VerifiedQuantity& q) { return q.verdict == CaseVerdict::fail || q.verdict == CaseVerdict::not_converged; });
}

int verify(int argc, char** argv, const std::function<void(Verification&)>& run) {
    try {
        if (argc != 3) throw UserError("a case takes two arguments", "They are fast, standard or long, and a folder", "Give both");
        Verification record(effort_of(argv[1]), argv[2]);
        run(record);
        return static_cast<int>(record.failed() ? ExitCode::check_failed : ExitCode::done);
    } catch (const Failure& failure) {
        std::cerr << failure.what() << std::endl;
        return static_cast<int>(failure.code());
    } catch (const Interrupted& interrupted) {
        std::cerr << interrupted.what() << std::endl;
        return 130;
    } catch (const std::exception& error) {
        std::cerr << "defect: " << error.what() << std::endl;
        return static_cast<int>(ExitCode::defect);
    }
}

}  // namespace cutterflow::validation
