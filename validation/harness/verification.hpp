#pragma once
/// \file The record of a verification case: its program adds quantities, `cutterflow verify` reads them.
/// docs/design/009-verification.md describes how to add a case.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validation/harness/suite/case_results.hpp"
#include "validation/harness/suite/effort.hpp"

namespace cutterflow::validation {

/// What a quantity has beside its number.
struct About {
    std::string source;         ///< key in docs/references.bib, or "exact" for what holds by itself (conservation, symmetry)
    std::string note;           ///< set-up in few words; of a shortfall its cause
    std::optional<double> aim;  ///< stricter than the tolerance, gates nothing
};

/// Quantities are written to disk and printed as they are added. Errors and tolerances of relative() are shares (0.01 is 1 %), of the
/// others in the quantity's unit.
class Verification {
public:
    Verification(Effort effort, std::filesystem::path folder) : effort_(effort), folder_(std::move(folder)) {}

    bool wants(Effort effort) const { return effort_ >= effort; }

    /// |value - reference| <= tolerance |reference|
    void relative(const std::string& name, const std::string& unit, double value, double reference, double tolerance, const About& about);
    /// |value - reference| <= tolerance
    void absolute(const std::string& name, const std::string& unit, double value, double reference, double tolerance, const About& about);
    void at_most(const std::string& name, const std::string& unit, double value, double limit, const About& about);
    void at_least(const std::string& name, const std::string& unit, double value, double limit, const About& about);
    /// A number without a tolerance; with a reference its distance is in the table.
    void report(const std::string& name, const std::string& unit, double value, std::optional<double> reference, const About& about);
    /// A quantity that does not converge; the note describes how it changes.
    void not_converged(const std::string& name, const std::string& unit, const About& about);

    /// Shown on the page beside the quantities. A table of the same title replaces the one before.
    void table(const ExhibitTable& table);
    void chart(const Chart& chart);

    /// A folder of this name for one of the case's runs; not yet there.
    std::filesystem::path folder(const std::string& name) const { return folder_ / name; }

    bool failed() const;

private:
    void add(VerifiedQuantity quantity);
    void write_exhibits() const;

    Effort effort_;
    std::filesystem::path folder_;
    std::vector<VerifiedQuantity> quantities_;
    Exhibits exhibits_;
};

/// The main function of a case: `<program> fast|standard|long FOLDER`, which writes FOLDER/quantities.json.
/// \return exit code: 0 done, 4 a quantity is out of its tolerance, else as everywhere
int verify(int argc, char** argv, const std::function<void(Verification&)>& run);

}  // namespace cutterflow::validation
