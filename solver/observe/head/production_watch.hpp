#pragma once
/// \file Whether the production of a head that is fed all the time is known well enough to end the run.
#include <iosfwd>

#include "geometry/base/statistics/production.hpp"
#include "solver/observe/run_recorder.hpp"

namespace cutterflow::coupling {

/// Keeps the ledger's series and asks once per revolution whether it is steady and half the interval of its production is at most a
/// target. The answer depends on simulated time alone, and is the report's.
class ProductionWatch {
public:
    /// \param revolution  of the rotor [s] \param target_half_width  of the share delivered [-]
    ProductionWatch(double revolution, double target_half_width) : revolution_(revolution), target_(target_half_width) {}

    void add(double time, const RockLedger& ledger);
    bool is_known() const { return is_known_; }

    /// The series, to the bit.
    void write(std::ostream& stream) const;
    /// \return false when the stream does not hold a series; nothing is changed then
    bool restore(std::istream& stream);

private:
    bool ends_a_turn(std::size_t i) const;
    bool tells_enough(const ProductionSeries& series) const;
    bool was_known() const;

    double revolution_, target_;
    ProductionSeries series_;
    bool is_known_ = false;
};

}  // namespace cutterflow::coupling
