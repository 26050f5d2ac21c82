#include "solver/foam/session/case_times.hpp"

#include "Time.H"

namespace cutterflow::foam {
namespace {

std::optional<double> write_interval_of(const Foam::dictionary& control) {
    const Foam::word kind(control.lookupOrDefault<Foam::word>("writeControl", "timeStep"));
    if (kind != "runTime" && kind != "adjustable" && kind != "adjustableRunTime") return std::nullopt;
    return control.get<Foam::scalar>("writeInterval");
}

}  // namespace

CaseTimes case_times(const Foam::Time& time) {
    return {time.deltaTValue(), time.value(), time.endTime().value(), write_interval_of(time.controlDict())};
}

}  // namespace cutterflow::foam
