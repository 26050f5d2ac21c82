#pragma once
/// \file Bodies of a scene as a file lists them, one a line.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/vec3.hpp"

namespace cutterflow::free_surface {

struct ListedBody {
    double x = 0.0, z = 0.0;       ///< of its centre [m]
    std::optional<double> y;       ///< none: in the middle of the tank
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    bool moves_across = false;     ///< the file has its velocity across
    double spin = 0.0;             ///< about y [rad/s]
    int id = 0;                    ///< 0: none is given
    std::string where;             ///< file:line
};

/// Reads a CSV file with the columns x_m,z_m and, where it has them, y_m,vx_m_s,vy_m_s,vz_m_s,spin_rad_s,id. Appends what is wrong to
/// `mistakes`: no such file, columns missing or unknown, fields that are no numbers, ids that are not whole or equal, no body.
std::vector<ListedBody> read_body_list(const std::filesystem::path& file, std::vector<Mistake>& mistakes);

}  // namespace cutterflow::free_surface
