#pragma once
/// \file Heaps and hollows: their profile, and the angle of their slopes.
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/profiles/profile.hpp"
#include "postproc/analysis/measures/envelope.hpp"
#include "postproc/analysis/measures/line_fit.hpp"

namespace cutterflow::postproc {

/// Upper envelope of the grains whose centres lie above `base`, less `base`; 0 where there is none.
/// \param direction  horizontal, of length 1: the profile's axis; it is seen from the side across it
Profile profile_of(const Grains& grains, const Eigen::Vector2d& direction, const Columns& columns, double base);

/// (1/N) sum |h - h_given| / h_given over the N points whose given height is at least `least`.
struct ProfileError {
    double error = 0.0;
    std::size_t used = 0, left_out = 0;
};

/// \param given  increasing places; heights between them linear, none outside
/// \throws UserError  when no point has a given height of `least` or more
ProfileError profile_error(const Profile& profile, const Profile& given, double least);

/// Where to look for slopes.
struct SlopeSearch {
    bool around = true;                           ///< 8 directions; else one
    Eigen::Vector2d direction{1.0, 0.0};          ///< of the first view, of length 1
    Eigen::Vector2d axis{0.0, 0.0};               ///< [m]
    double base = 0.0;                            ///< level from which heights count [m]
    double inner_radius = 0.0;                    ///< the slope begins there [m]
    std::optional<double> radius;                 ///< the slope ends there [m]; absent: where the silhouette first comes down to 1 diameter
    double window_from = 0.15, window_to = 0.85;  ///< part of the slope that is fitted
};

inline constexpr int k_views = 8;                   ///< over half a turn: a silhouette has two sides
inline constexpr double k_straight = 0.95;          ///< R2 from which a slope is straight
inline constexpr double k_least_rise = 2.0;         ///< in diameters, of a slope that is straight but for its roughness
inline constexpr std::size_t k_columns_per_d = 10;  ///< of a silhouette

/// One side of a silhouette.
struct SlopeSide {
    double view_deg = 0.0;  ///< direction, from the x axis, in which the side falls or rises outwards
    double radius = 0.0;    ///< end of the slope [m]
    LineFit line;           ///< height over distance from the axis, both in m; its r2 and residual are those of means over one diameter
    bool is_straight = false;
    double angle_deg = 0.0;  ///< positive where the slope falls outwards
};

struct Slopes {
    std::vector<SlopeSide> sides;
    std::vector<Profile> silhouettes;  ///< of the views; places along the view's direction from the axis
    std::optional<double> angle_deg;   ///< mean over the sides, positive; none: no straight slope, or some fall and some rise; `reason`
    double spread_deg = 0.0;           ///< standard deviation of the sides
    double r2 = 0.0;                   ///< lower quartile of the sides: a quarter of them is no straighter
    bool rises_outwards = false;       ///< a hollow
    std::string reason;
    std::optional<double> cone_angle_deg;  ///< of the cone through the whole surface; only around, where there is an angle of silhouettes
    double cone_r2 = 0.0;
};

/// Angle of slopes by two definitions: straight lines through silhouettes (upper envelopes, both sides of each view), and the cone
/// z = a - r tan(angle) through the height map, both by least squares over the window. Grains whose centres lie below `base` do not count.
Slopes slopes_of(const Grains& grains, const SlopeSearch& search);

}  // namespace cutterflow::postproc
