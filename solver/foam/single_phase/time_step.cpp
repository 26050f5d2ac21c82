#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <algorithm>
#include <cmath>

#include "fvc.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// Times are sums of steps: this share of a step or of an interval is rounding.
constexpr double k_time_tolerance = 1e-6;

}  // namespace

bool CutterFluid::running() {
    take_in_the_rest();
    return time_.run();
}

/// OpenFOAM's run ends within half a step of its end time. A step that was cut at a write time or a release may leave less than that.
void CutterFluid::take_in_the_rest() {
    const scalar left = time_.endTime().value() - time_.value();
    const bool is_less = left > k_time_tolerance * time_.deltaTValue() && left < time_.deltaTValue();
    if (is_less && time_.controlDict().lookupOrDefault("adjustTimeStep", false)) time_.setDeltaT(left, false);
}

void CutterFluid::update_courant_number() {
    const scalarField gross_flux(fvc::surfaceSum(mag(phi_))().primitiveField());
    const scalar half_step = 0.5 * time_.deltaTValue();
    courant_max_ = half_step * gMax(gross_flux / mesh_.V().field());
    const scalar mean = half_step * gSum(gross_flux) / gSum(mesh_.V().field());
    Info << "Courant Number mean: " << mean << " max: " << courant_max_ << endl;
}

void CutterFluid::choose_time_step(double travel_limit, double stop_time) {
    update_courant_number();
    const dictionary& control = time_.controlDict();
    if (!control.lookupOrDefault("adjustTimeStep", false)) {
        warn_of_long_step(travel_limit);
        return;
    }
    const bool develops = time_.value() < control.lookupOrDefault<scalar>("developmentEnd", 0.0);
    const scalar ratio = develops ? control.lookupOrDefault<scalar>("developmentStepRatio", 1.0) : 1.0;
    const scalar headroom = ratio * control.lookupOrDefault<scalar>("maxCo", 1.0) / (courant_max_ + SMALL);
    const bool first = time_.timeIndex() == 0;
    const scalar growth = first ? 1.0 : std::min(1.0 + 0.1 * headroom, 1.2);
    const scalar limit = std::min<scalar>(ratio * control.lookupOrDefault<scalar>("maxDeltaT", GREAT), travel_limit);
    const scalar step = std::min(std::min(headroom, growth) * time_.deltaTValue(), limit);
    // OpenFOAM's own way of meeting write times counts from the run's start, which a restart moves.
    const scalar ahead = std::min(next_write_time(), stop_time) - time_.value();
    time_.setDeltaT(ahead / std::max<scalar>(1.0, std::ceil(ahead / step - k_time_tolerance)), false);
    Info << "deltaT = " << time_.deltaTValue() << endl;
}

/// The next multiple of the write interval, or the end of the run when that is earlier.
double CutterFluid::next_write_time() const {
    const double end = time_.endTime().value();
    if (!write_interval_) return end;
    const double next = *write_interval_ * (std::floor(time_.value() / *write_interval_ + k_time_tolerance) + 1.0);
    return end - time_.value() > k_time_tolerance * time_.deltaTValue() ? std::min(next, end) : next;
}

/// A fixed time step is the user's choice; a step too long for the rock is reported once.
void CutterFluid::warn_of_long_step(double travel_limit) {
    if (long_step_warned_ || time_.deltaTValue() <= travel_limit) return;
    long_step_warned_ = true;
    Info << "Warning: deltaT = " << time_.deltaTValue() << " s is above " << travel_limit
         << " s. Rock must travel less than a quarter of its kernel in a step. Set adjustTimeStep yes, or a shorter deltaT." << endl;
}

}  // namespace cutterflow::foam
