#pragma once
/// \file A place or a direction in a study.
#include <string>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/vec3.hpp"

namespace cutterflow::cases {

/// Three numbers of a key.
inline Vec3 vec3_of(const ParameterValues& values, const std::string& key) {
    const std::vector<double>& numbers = values.numbers(key);
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

}  // namespace cutterflow::cases
