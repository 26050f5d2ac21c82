#pragma once
/// \file Vectors of three doubles; contiguous in arrays, so that adapters can view them without a copy.
#include <Eigen/Core>

namespace cutterflow {

using Vec3 = Eigen::Vector3d;
static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of Vec3 must be arrays of doubles");

}  // namespace cutterflow
