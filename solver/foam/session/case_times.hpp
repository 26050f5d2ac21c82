#pragma once
/// \file Begin, end and output times of a case's system/controlDict.
#include <optional>

namespace Foam {
class Time;
}

namespace cutterflow::foam {

struct CaseTimes {
    double step = 0.0;                     ///< deltaT [s]
    double start = 0.0, end = 0.0;         ///< [s]
    std::optional<double> write_interval;  ///< of simulated time [s]; none when the case counts otherwise
};

CaseTimes case_times(const Foam::Time& time);

}  // namespace cutterflow::foam
