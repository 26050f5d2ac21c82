#pragma once
/// \file The cut face of a bank: where a swinging head turns soil into rock.
#include <vector>

namespace cutterflow::geometry {

/// A piece of the cut face. Places are those of the run's frame, the head at rest in it.
struct CutFacePatch {
    double depth_m = 0.0;       ///< below the ring plane, along the axis (-z)
    double azimuth_rad = 0.0;   ///< in [0, 2 pi), right-handed about the axis, 0 is lowest
    double radius_m = 0.0;      ///< distance of the face from the axis: the contour with picks and clearance
    double flux_area_m2 = 0.0;  ///< dS (n . e_s)+: area seen along the swing; the volume flux through the patch is v_h times it
};

/// The cut face as patches; their flux areas add up to the cut section A_cut, so that the in-situ volume flux is Q_c = v_h A_cut.
struct CutFace {
    std::vector<CutFacePatch> patches;
};

}  // namespace cutterflow::geometry
