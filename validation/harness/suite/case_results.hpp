#pragma once
/// \file What a verification case found: quantities held against a reference, as JSON and on pages.
/// docs/design/009-verification.md describes the files.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/harness/suite/exhibits.hpp"

namespace cutterflow::validation {

enum class CaseVerdict {
    pass,
    fail,
    not_converged,  ///< meshes, steps or runs do not settle on a value that could be judged
    skipped,        ///< could not be run here
    reported,       ///< without a tolerance: a distance to an experiment, a cost
};

/// What is held against the tolerance.
enum class Rule {
    relative,  ///< |value - reference| / |reference|
    absolute,  ///< |value - reference| [unit]
    at_most,   ///< value <= tolerance
    at_least,  ///< value >= tolerance
    none,      ///< nothing: the quantity is reported
};

struct VerifiedQuantity {
    std::string name;
    std::string unit;  ///< "-" for a bare number
    std::optional<double> reference;
    std::optional<double> value;
    std::optional<double> error;  ///< as defined by the rule
    std::optional<double> tolerance;
    std::optional<double> aim;  ///< stricter than the tolerance; gates nothing
    Rule rule = Rule::none;
    CaseVerdict verdict = CaseVerdict::reported;
    std::string source;  ///< key in docs/references.bib, or "exact" for what holds by itself (conservation, symmetry)
    std::string note;    ///< set-up in few words; of a shortfall its cause
};

/// Error and verdict of a quantity that has rule, value, reference and tolerance. A value that is no number fails.
void judge(VerifiedQuantity& quantity);

/// One case as it was run.
struct VerifiedCase {
    std::string name, title;
    std::string effort;  ///< fast, standard or long: how much of the case was run
    std::vector<VerifiedQuantity> quantities;
    Exhibits exhibits;
    std::string reason;  ///< why the case as a whole was skipped or failed; empty otherwise
    bool failed_as_a_whole = false;
    bool stopped = false;  ///< failed as a whole because somebody ended its program; what it would have found is not known
    double core_s = 0.0;   ///< of all starts whose work the last one went on with
    double wall_s = 0.0;   ///< of the last start
    std::string date;      ///< UTC, as 2026-01-31 12:34
    std::string machine;   ///< processor and cores
    std::string programs;  ///< SHA-256 over the programs and files that made it
    CaseVerdict verdict() const;
};

/// "pass", "fail", "not converged", "skipped", "reported".
std::string verdict_text(CaseVerdict verdict);

nlohmann::json quantity_json(const VerifiedQuantity& quantity);
nlohmann::json case_json(const VerifiedCase& result);

/// \throws UserError  when the text is not what quantity_json or case_json writes; `where` names the file
VerifiedQuantity quantity_from_json(const nlohmann::json& json, const std::string& where);
VerifiedCase case_from_json(const std::string& text, const std::string& where);

/// One line for a terminal; a case has one line a quantity.
std::string quantity_text(const VerifiedQuantity& quantity);
std::string verification_text(const VerifiedCase& result);

/// The same content as Markdown (docs/validation.md) and as an HTML page. `link` goes in front of a case's name to make the path of its
/// README. Charts are drawn with the help of files in `scratch`; without gnuplot they are tables.
std::string verification_markdown(const std::vector<VerifiedCase>& results, const std::string& link);
std::string verification_page(const std::vector<VerifiedCase>& results, const std::string& link, const std::filesystem::path& scratch);

}  // namespace cutterflow::validation
