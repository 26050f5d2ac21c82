#pragma once

namespace cutterflow {

/// Cylinder about the z axis of the run's frame: the water of a tank.
struct AxialCylinder {
    double radius = 0.0;  ///< [m]
    double z_min = 0.0;   ///< [m]
    double z_max = 0.0;   ///< [m]
};

}  // namespace cutterflow
