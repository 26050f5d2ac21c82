#pragma once
/// \file The bank of a study: whether it can stand there, what a swing cuts from it, and its surface.
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cases/scenes/cutter/contact_surfaces.hpp"
#include "cases/study/study.hpp"
#include "geometry/head/head.hpp"
#include "geometry/soil/bank.hpp"

namespace cutterflow::cases {

/// \pre the study has a bank
geometry::Bank bank_of(const Study& study, const geometry::Contour& contour);

/// Soil in the run's frame: as far from the axis as rock matters, or the user's own. \pre the study has a bank that can stand
/// \throws UserError  when the user's file is no closed surface
geometry::TriangleSurface bank_surface(const Study& study, const HeadSize& size, const geometry::Contour& contour);

/// What rock touches of that soil, with its error. \throws CheckFailure  when it lies farther from the soil than it may
MadeWall bank_contact_wall(const Study& study, const HeadSize& size, const geometry::Contour& contour,
                           const geometry::TriangleSurface& soil);

/// What rock touches of the picks that the cutter's file does not have. \pre the study has a bank that adds picks
/// \throws UserError  when the cutter has no blades
MadeWall pick_contact_wall(const Study& study, const geometry::Contour& contour, const geometry::TriangleSurface& cutter);

/// Rules that a bank breaks beside this head, its steel and its water: higher than head or water, steps longer than the head, overhanging,
/// steel in the soil, a file that is open. None for a study without a bank. \param resolved  from which the study was made; its lines are
/// named \param profile  of the head, with its error
std::vector<Mistake> bank_mistakes(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                                   const geometry::RevolutionContour& profile);

/// What a swing cuts.
struct CutFigures {
    double section = 0.0;  ///< A_cut [m2]
    double depth = 0.0;    ///< of the cut face below the ring plane, mean by what is cut [m]: the way that rock has to climb to the mouth
    double in_situ = 0.0;  ///< volume flux of standing soil v_h A_cut [m3/s]
    double dry = 0.0;      ///< mass flux of its grains [kg/s]
    double swing_speed = 0.0;  ///< [m/s]
};
/// \pre the study has a bank
CutFigures cut_figures(const Study& study, const geometry::Contour& contour);

/// By Froude's law, for a prototype longer by `length_ratio`; the soil is the same.
CutFigures scaled(const CutFigures& figures, double length_ratio);

/// What a bank may be cut with in spite of: a swing faster than the blades' tips, more grains than the mixture can hold.
std::vector<Mistake> swing_warnings(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                                    const geometry::Contour& contour);

/// What of a head at work lies outside of usual practice (geometry/base/at_work): one warning with all of it, none without a bank.
std::vector<Mistake> practice_warnings(const Study& study, const HeadSize& size);

/// Lines for the user, and the same for `check --json`; empty and null without a bank.
std::string bank_text(const Study& study, const geometry::Contour& contour);
nlohmann::json bank_json(const Study& study, const geometry::Contour& contour);

}  // namespace cutterflow::cases
